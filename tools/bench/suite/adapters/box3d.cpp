// Box3D: b3ShapeDistance on points with a radius, in floats, with its simplex cache. It takes at
// most 255 points a body.
#include <box3d/collision.h>
#include <box3d/math_functions.h>

#include <memory>

#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

constexpr std::size_t kMostPoints = 255;  // its cache has indices of 8 bits

bool fits(const PlainBody& body) {
  using enum PlainBody::Kind;
  return body.kind == kSphere || body.kind == kCapsule ||
         (!body.points.empty() && body.points.size() <= kMostPoints);
}

b3Vec3 vector(const Numbers3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::vector<b3Vec3> points_of(const PlainBody& body) {
  if (body.kind == PlainBody::Kind::kSphere) return {vector({})};
  if (body.kind == PlainBody::Kind::kCapsule) {
    return {vector({0.0, 0.0, -body.half_length}), vector({0.0, 0.0, body.half_length})};
  }
  std::vector<b3Vec3> points;
  for (const Numbers3& p : body.points) points.push_back(vector(p));
  return points;
}

b3Transform transform_of(const PlainPose& pose) {
  const auto& [w, x, y, z] = pose.quaternion;
  b3Transform transform;
  transform.p = vector(pose.position);
  transform.q.v = vector({x, y, z});
  transform.q.s = static_cast<float>(w);
  return transform;
}

class Box3dPair final : public RivalPair {
 public:
  Box3dPair(const PlainBody& a, const PlainBody& b) : a_(points_of(a)), b_(points_of(b)) {
    const auto proxy = [](const std::vector<b3Vec3>& points, double radius) {
      return b3ShapeProxy{points.data(), static_cast<int>(points.size()),
                          static_cast<float>(radius)};
    };
    input_.proxyA = proxy(a_, a.radius);
    input_.proxyB = proxy(b_, b.radius);
    input_.useRadii = true;
  }
  void forget() override { cache_ = {}; }
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override {
    input_.transform = b3InvMulTransforms(transform_of(world_from_a), transform_of(world_from_b));
    return static_cast<double>(b3ShapeDistance(&input_, &cache_, nullptr, 0).distance);
  }

 private:
  std::vector<b3Vec3> a_, b_;
  b3DistanceInput input_{};
  b3SimplexCache cache_{};
};

}  // namespace

std::vector<Rival> box3d_rivals() {
  return {{"Box3D", "floats, simplex cache; no depth", false,
           [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
             if (!fits(a) || !fits(b)) return nullptr;
             return std::make_unique<Box3dPair>(a, b);
           }}};
}

}  // namespace clearance::bench
