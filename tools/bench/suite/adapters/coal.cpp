// Coal 3: its GJK with the guess of the last query, its closed forms, its EPA.
#include <coal/internal/shape_shape_func.h>
#include <coal/narrowphase/narrowphase.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <variant>

#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

using Hull = coal::Convex<coal::Triangle>;
using Shape =
    std::variant<std::shared_ptr<Hull>, std::shared_ptr<coal::Box>, std::shared_ptr<coal::Sphere>,
                 std::shared_ptr<coal::Capsule>, std::shared_ptr<coal::Cylinder>,
                 std::shared_ptr<coal::Cone>, std::shared_ptr<coal::Ellipsoid>>;

std::shared_ptr<Hull> hull(const PlainBody& body) {
  auto points = std::make_shared<std::vector<coal::Vec3s>>();
  for (const Numbers3& p : body.points) points->emplace_back(p[0], p[1], p[2]);
  auto triangles = std::make_shared<std::vector<coal::Triangle>>();
  for (const std::vector<int>& face : body.faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      triangles->emplace_back(static_cast<std::size_t>(face[0]),
                              static_cast<std::size_t>(face[i - 1]),
                              static_cast<std::size_t>(face[i]));
    }
  }
  const auto count = [](const auto& list) { return static_cast<unsigned>(list->size()); };
  return std::make_shared<Hull>(points, count(points), triangles, count(triangles));
}

Shape shape_of(const PlainBody& body) {
  using enum PlainBody::Kind;
  const auto& h = body.half;
  switch (body.kind) {
    case kBox:
      return std::make_shared<coal::Box>(2 * h[0], 2 * h[1], 2 * h[2]);
    case kSphere:
      return std::make_shared<coal::Sphere>(body.radius);
    case kCapsule:
      return std::make_shared<coal::Capsule>(body.radius, 2 * body.half_length);
    case kCylinder:
      return std::make_shared<coal::Cylinder>(body.radius, 2 * body.half_length);
    case kCone:
      return std::make_shared<coal::Cone>(body.radius, 2 * body.half_length);
    case kEllipsoid:
      return std::make_shared<coal::Ellipsoid>(h[0], h[1], h[2]);
    case kHull:
      break;
  }
  return hull(body);
}

coal::Transform3s transform_of(const PlainPose& pose) {
  const auto& [w, x, y, z] = pose.quaternion;
  return {coal::Quatf(w, x, y, z),
          coal::Vec3s(pose.position[0], pose.position[1], pose.position[2])};
}

class CoalPair final : public RivalPair {
 public:
  CoalPair(Shape a, Shape b, double tolerance) : a_(std::move(a)), b_(std::move(b)) {
    for (const Shape* shape : {&a_, &b_}) {
      std::visit([](const auto& s) { s->computeLocalAABB(); }, *shape);
    }
    solver_.gjk_tolerance = solver_.epa_tolerance = tolerance;
    solver_.gjk_max_iterations = 1000;
    solver_.gjk.reset(1000, tolerance);
    forget();
  }
  // A cold query starts from the line of centres.
  void forget() override {
    solver_.gjk_initial_guess = coal::GJKInitialGuess::BoundingVolumeGuess;
    solver_.support_func_cached_guess.setZero();
  }
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override try {
    const coal::Transform3s at_a = transform_of(world_from_a), at_b = transform_of(world_from_b);
    coal::Vec3s on_a, on_b, normal;
    const double apart = std::visit(
        [&](const auto& a, const auto& b) -> double {
          using A = std::decay_t<decltype(*a)>;
          using B = std::decay_t<decltype(*b)>;
          return coal::internal::ShapeShapeDistance<ShapeOf<A>, ShapeOf<B>>(
              a.get(), at_a, b.get(), at_b, &solver_, true, on_a, on_b, normal);
        },
        a_, b_);
    solver_.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
    // The largest double is its word for a GJK that has failed.
    return std::abs(apart) < 1e300 ? apart : std::numeric_limits<double>::quiet_NaN();
  } catch (const std::exception&) {
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  // Coal's functions are those of the hull's base class.
  template <class S>
  using ShapeOf = std::conditional_t<std::is_same_v<S, Hull>, coal::ConvexBase, S>;
  Shape a_, b_;
  coal::GJKSolver solver_;
};

Rival rival(const std::string& name, const std::string& setting, double tolerance) {
  return {name, setting, true,
          [tolerance](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
            return std::make_unique<CoalPair>(shape_of(a), shape_of(b), tolerance);
          }};
}

}  // namespace

std::vector<Rival> coal_rivals() {
  return {
      rival("Coal, 1e-10", "doubles, 1e-10, cached guess and supports, closed forms, EPA", 1e-10),
      rival("Coal, default", "the same at its default tolerance, 1e-6", 1e-6)};
}

}  // namespace clearance::bench
