// Jolt: its GJK and EPA on its own shapes, in floats, from the last separating axis.
#include <Jolt/Jolt.h>
// Jolt.h comes first.
#include <Jolt/Core/Memory.h>
#include <Jolt/Geometry/ConvexSupport.h>
#include <Jolt/Geometry/EPAPenetrationDepth.h>
#include <Jolt/Geometry/GJKClosestPoint.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/CylinderShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSettings.h>

#include <cfloat>
#include <cmath>
#include <memory>

#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

float narrow(double value) { return static_cast<float>(value); }

JPH::Vec3 vector(const Numbers3& v) { return {narrow(v[0]), narrow(v[1]), narrow(v[2])}; }

// A shape, and where its own frame is: around its centre of mass, capsules and cylinders along y.
struct Shape {
  JPH::RefConst<JPH::ConvexShape> shape;
  bool along_y = false;

  [[nodiscard]] JPH::Mat44 world_from_shape(const PlainPose& pose) const {
    const auto& [w, x, y, z] = pose.quaternion;
    const JPH::Mat44 world = JPH::Mat44::sRotationTranslation(
        JPH::Quat(narrow(x), narrow(y), narrow(z), narrow(w)), vector(pose.position));
    if (along_y) {
      return {world.GetColumn4(0), world.GetColumn4(2), -world.GetColumn4(1), world.GetColumn4(3)};
    }
    return world.PreTranslated(shape->GetCenterOfMass());
  }
};

// Empty where Jolt has no such shape.
Shape shape_of(const PlainBody& body) {
  using enum PlainBody::Kind;
  const float radius = narrow(body.radius), half = narrow(body.half_length);
  switch (body.kind) {
    case kBox:
      return {new JPH::BoxShape(vector(body.half), 0.0f)};
    case kSphere:
      return {new JPH::SphereShape(radius)};
    case kCapsule:
      return {new JPH::CapsuleShape(half, radius), true};
    case kCylinder:
      return {new JPH::CylinderShape(half, radius, 0.0f), true};
    case kHull:
      break;
    default:
      return {};
  }
  if (body.points.size() > JPH::ConvexHullShape::cMaxPointsInHull) return {};
  JPH::Array<JPH::Vec3> points;
  for (const Numbers3& p : body.points) points.push_back(vector(p));
  JPH::ConvexHullShapeSettings settings(points, 0.0f);
  settings.mHullTolerance = 1e-5f;  // no vertex is left out
  const auto made = settings.Create();
  if (made.HasError()) return {};
  return {static_cast<const JPH::ConvexShape*>(made.Get().GetPtr())};
}

// The shape without its radius, and with it.
class Support {
 public:
  explicit Support(const Shape& shape) {
    using Mode = JPH::ConvexShape::ESupportMode;
    const JPH::Vec3 scale = JPH::Vec3::sReplicate(1.0f);
    core = shape.shape->GetSupportFunction(Mode::ExcludeConvexRadius, buffers_[0], scale);
    whole = shape.shape->GetSupportFunction(Mode::IncludeConvexRadius, buffers_[1], scale);
  }
  const JPH::ConvexShape::Support *core, *whole;

 private:
  JPH::ConvexShape::SupportBuffer buffers_[2];
};

class JoltPair final : public RivalPair {
 public:
  JoltPair(Shape a, Shape b) : a_(std::move(a)), b_(std::move(b)), support_a_(a_), support_b_(b_) {}
  void forget() override { known_ = false; }
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override {
    const JPH::Mat44 a_from_b = a_.world_from_shape(world_from_a).InversedRotationTranslation() *
                                b_.world_from_shape(world_from_b);
    // A cold query starts from the line of centres.
    if (!known_) axis_ = a_from_b.GetTranslation();
    if (axis_.IsNearZero()) axis_ = JPH::Vec3::sAxisX();
    JPH::Vec3 on_a, on_b;
    const JPH::TransformedConvexObject core_b(a_from_b, *support_b_.core);
    const float squared = JPH::GJKClosestPoint().GetClosestPoints(
        *support_a_.core, core_b, JPH::cDefaultCollisionTolerance, FLT_MAX, axis_, on_a, on_b);
    known_ = squared > 0.0f;
    if (known_) {
      return static_cast<double>(std::sqrt(squared) - support_a_.core->GetConvexRadius() -
                                 support_b_.core->GetConvexRadius());
    }
    const JPH::TransformedConvexObject whole_b(a_from_b, *support_b_.whole);
    JPH::Vec3 out = a_from_b.GetTranslation();
    if (out.IsNearZero()) out = JPH::Vec3::sAxisX();
    const bool deep = JPH::EPAPenetrationDepth().GetPenetrationDepth(
        *support_a_.core, *support_a_.whole, support_a_.core->GetConvexRadius(), core_b, whole_b,
        support_b_.core->GetConvexRadius(), JPH::cDefaultCollisionTolerance,
        JPH::cDefaultPenetrationTolerance, out, on_a, on_b);
    return deep ? -static_cast<double>((on_b - on_a).Length()) : 0.0;
  }

 private:
  Shape a_, b_;
  Support support_a_, support_b_;
  JPH::Vec3 axis_ = JPH::Vec3::sAxisX();
  bool known_ = false;
};

}  // namespace

std::vector<Rival> jolt_rivals() {
  JPH::RegisterDefaultAllocator();
  return {{"Jolt", "floats, its default tolerances (1e-4), last axis, EPA", true,
           [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
             Shape shape_a = shape_of(a), shape_b = shape_of(b);
             if (shape_a.shape == nullptr || shape_b.shape == nullptr) return nullptr;
             return std::make_unique<JoltPair>(std::move(shape_a), std::move(shape_b));
           }}};
}

}  // namespace clearance::bench
