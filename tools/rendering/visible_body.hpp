// A convex body as it is seen from one point.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance::rendering {

// A pixel's direction is (x, y, 1) in the camera's frame: z forward, x right, y down.
struct ViewRange {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  // of x and of y

  [[nodiscard]] bool is_empty() const noexcept { return left > right || top > bottom; }
};

// Places any ConvexBody in the camera's frame, and answers rays from the camera. Polyhedra,
// spheres, capsules, cylinders, cones and ellipsoids are answered by closed forms, rounded
// polyhedra by those of their facets and edges. A curved or unbounded body with a radius around it
// is answered by Newton's iteration on core's distance, which is convex along a ray.
class VisibleBody {
 public:
  // The shape must outlive this.
  VisibleBody(const ConvexBody& shape, const Pose& camera_from_body);

  // The least t >= 0 at which t * direction is in the body; infinity: none. A point or segment
  // without a radius is never met.
  [[nodiscard]] double first_hit(const Vec3& direction) const noexcept;

  // No direction (x, y, 1) outside of it meets the body. Infinite sides: not known.
  [[nodiscard]] ViewRange range() const noexcept;

  // A facet's plane as w = normal . direction: the inverse of t where the ray crosses it. A body
  // without a radius is where w is at most that of all planes in front of the camera, and at least
  // that of all behind it.
  [[nodiscard]] bool is_polyhedron() const noexcept { return kind_ == Kind::kPolyhedron; }
  [[nodiscard]] const std::vector<Vec3>& front_planes() const noexcept { return front_; }
  [[nodiscard]] const std::vector<Vec3>& back_planes() const noexcept { return back_; }

 private:
  enum class Kind : std::uint8_t {
    kNone,
    kSphere,
    kCapsule,
    kPolyhedron,
    kRoundedPolyhedron,
    kTruncatedCone,
    kEllipsoid,
    kAnyShape,
  };
  struct Ball {
    Vec3 centre;  // camera's frame
    double radius;
  };

  [[nodiscard]] static Kind kind_of(const ConvexBody& shape) noexcept;
  void place_planes();
  void place_balls();
  [[nodiscard]] double hit_planes(const Vec3& direction) const noexcept;
  [[nodiscard]] double hit_rounded(const Vec3& direction) const noexcept;
  [[nodiscard]] double hit_by_distance(const Vec3& direction) const noexcept;
  [[nodiscard]] bool is_over_facet(const Facet& facet, const Vec3& point_in_body) const noexcept;

  const ConvexBody& shape_;
  Kind kind_;
  Mat3 body_from_camera_;  // a rotation
  Vec3 camera_in_body_;
  std::vector<Ball> balls_;  // their hull contains the body; none: it is unbounded
  std::vector<Vec3> front_, back_;
  std::vector<std::array<Vec3, 2>> edges_;  // of a rounded polyhedron
};

}  // namespace clearance::rendering
