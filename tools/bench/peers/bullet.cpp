#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <array>
#include <cmath>

#include "tools/bench/peers/peers.hpp"
#include "tools/bench/peers/welded.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/bench/suite/solver_rival.hpp"

namespace clearance::bench {
namespace {

static_assert(sizeof(btScalar) == sizeof(double));

btVector3 vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

btTransform transform_of(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector(pose.position));
}

// Bullet has neither ellipsoids nor truncated cones: these are what its other shapes are, support
// functions.
struct EllipsoidSupport {
  btVector3 semi_axes;
  btVector3 operator()(const btVector3& along) const {
    const btVector3 scaled = semi_axes * along;
    return semi_axes * scaled / scaled.length();
  }
};
struct TruncatedConeSupport {
  std::array<Disc, 2> discs;
  btVector3 operator()(const btVector3& along) const {
    const double across = std::hypot(along.x(), along.y());
    const auto height = [&](const Disc& d) { return d.height * along.z() + d.radius * across; };
    const Disc& disc = height(discs[0]) > height(discs[1]) ? discs[0] : discs[1];
    const double scale = across > 0.0 ? disc.radius / across : 0.0;
    return {scale * along.x(), scale * along.y(), disc.height};
  }
};

template <class Support>
class BySupport : public btConvexInternalShape {
 public:
  explicit BySupport(const Support& support) : support_(support) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& along) const override {
    return support_(along);
  }
  btVector3 localGetSupportingVertex(const btVector3& along) const override {
    return support_(along);
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* along, btVector3* found,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) found[i] = support_(along[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "BySupport"; }

 private:
  Support support_;
};

class Bullet {
 public:
  using Shape = std::shared_ptr<btConvexShape>;
  static Shape curved(const CurvedShape& shape) {
    if (shape.kind == CurvedShape::Kind::kEllipsoid) {
      return std::make_shared<BySupport<EllipsoidSupport>>(
          EllipsoidSupport{vector(shape.semi_axes)});
    }
    const auto& [low, high] = shape.discs;
    const double length = high.height - low.height;
    if (high.radius == 0.0) return std::make_shared<btConeShapeZ>(low.radius, length);
    if (high.radius != low.radius) {
      return std::make_shared<BySupport<TruncatedConeSupport>>(TruncatedConeSupport{shape.discs});
    }
    return std::make_shared<btCylinderShapeZ>(btVector3(low.radius, low.radius, 0.5 * length));
  }
  static Shape shape(const ConvexBody& body) {
    if (body.is_curved()) {
      Shape made = curved(body.curved);
      made->setMargin(0.0);
      return made;
    }
    // The radius is the margin of these shapes, which GJK leaves out and query() takes off.
    if (body.vertices.size() == 1) return std::make_shared<btSphereShape>(body.radius);
    if (body.vertices.size() == 2) {
      return std::make_shared<btCapsuleShapeZ>(body.radius, body.edges.front().end);
    }
    if (const auto half = box_half_extents(body)) {
      const auto box = std::make_shared<btBoxShape>(vector(*half));
      box->setMargin(0.0);  // its constructor has taken the default margin off the half extents
      return box;
    }
    const auto hull = std::make_shared<btConvexHullShape>();
    for (const Vec3& p : welded(body).points) hull->addPoint(vector(p), false);
    hull->recalcLocalAabb();
    hull->setMargin(body.radius);
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
    return {.distance = result.distance - a_->getMargin() - b_->getMargin()};
  }

 protected:
  static btVector3 in_frame(const btTransform& frame, const btVector3& v) {
    return v * frame.getBasis();  // the transpose times v
  }
  Shape a_, b_;
  btVector3 guess_{0, 0, 0};  // from B to A, in A's frame
};

// Answers with the depth, by Bullet's EPA, where the bodies overlap.
class WithDepth : public Bullet {
 public:
  using Bullet::Bullet;
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    Answer answer = Bullet::query(world_from_a, world_from_b);
    if (answer.distance != 0.0 || !answer.ok) return answer;
    const btTransform a = transform_of(world_from_a), b = transform_of(world_from_b);
    btGjkEpaSolver2::sResults result;
    answer.ok = btGjkEpaSolver2::Penetration(a_.get(), a, b_.get(), b,
                                             b.getOrigin() - a.getOrigin(), result);
    answer.distance = result.distance;
    return answer;
  }
};

}  // namespace

std::vector<Rival> bullet_rivals() {
  return {solver_rival<WithDepth>("Bullet", "3, doubles, no margin, last separation; EPA", true)};
}

void register_bullet(RowSet set) { register_peer<Bullet>(set, "bullet"); }

}  // namespace clearance::bench
