#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "tools/bench/intervals.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/peers/welded.hpp"

namespace clearance::bench {
namespace {

static_assert(sizeof(btScalar) == sizeof(double));

btVector3 vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

btTransform transform_of(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector(pose.position));
}

class Bullet {
 public:
  using Shape = std::shared_ptr<btConvexHullShape>;
  static Shape shape(const ConvexPolyhedron& body) {
    const auto hull = std::make_shared<btConvexHullShape>();
    for (const Vec3& p : welded(body).points) hull->addPoint(vector(p), false);
    hull->recalcLocalAabb();
    hull->setMargin(0.0);
    return hull;
  }

  Bullet(Shape a, Shape b) : a_(std::move(a)), b_(std::move(b)) {}
  void forget() { guess_ = btVector3(0, 0, 0); }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const btTransform a = transform_of(world_from_a), b = transform_of(world_from_b);
    if (guess_.fuzzyZero()) guess_ = in_frame(a, a.getOrigin() - b.getOrigin());
    btGjkEpaSolver2::sResults result;
    const bool apart = btGjkEpaSolver2::Distance(a_.get(), a, b_.get(), b, guess_, result);
    if (!apart) {
      guess_ = btVector3(0, 0, 0);
      return {.distance = 0.0, .ok = result.status == btGjkEpaSolver2::sResults::Penetrating};
    }
    guess_ = in_frame(a, result.witnesses[0] - result.witnesses[1]);
    return {.distance = result.distance};
  }

 private:
  static btVector3 in_frame(const btTransform& frame, const btVector3& v) {
    return v * frame.getBasis();  // the transpose times v
  }
  Shape a_, b_;
  btVector3 guess_{0, 0, 0};  // from B to A, in A's frame
};

}  // namespace

void register_bullet() {
  register_rows<Bullet>("peer/bullet/");
  register_intervals<Bullet>("peer/bullet/");
}

}  // namespace clearance::bench
