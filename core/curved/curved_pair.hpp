// Two bodies and B's pose in A's frame: support points of B - A, and the best bounds so far.
#pragma once

#include "core/curved/bounds.hpp"
#include "core/pose.hpp"

namespace clearance {

// A point of each body; B's in its own frame, too.
struct PointPair {
  Vec3 a = Vec3::Zero(), b_B = Vec3::Zero(), b = Vec3::Zero();
  [[nodiscard]] Vec3 gap() const noexcept { return b - a; }
  [[nodiscard]] bool operator==(const PointPair&) const noexcept = default;
};

struct SupportPair {
  PartPair parts;
  PointPair points;
  double value = 0.0;  // n.(b - a), the signed distance of the parts along n, m
};

// The bounds of the bodies without their radii, before rounding_error() widens them.
struct CurvedBounds {
  double lower = -kInfinity, upper = kInfinity;
  Vec3 normal = Vec3::Zero();  // for `lower`, in frame A, from A to B
  PointPair points{};          // for `upper`
  PointPair deepest{};         // of bodies that overlap: these meet when B is moved by the depth
  bool has_deepest = false;    // a search has found them
};

// The bodies and the pose outlive it.
class CurvedPair {
 public:
  CurvedPair(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b) noexcept;

  BodyView a, b;
  CurvedBounds bounds;
  double size;  // m: bounding radii and translation length

  // The pose of B in A's frame.
  [[nodiscard]] const Mat3& rotation() const noexcept { return pose_.rotation; }
  [[nodiscard]] const Vec3& translation() const noexcept { return pose_.translation; }

  [[nodiscard]] Vec3 direction_to_b(const Vec3& v) const noexcept {
    return pose_.rotation.transpose() * v;
  }
  [[nodiscard]] Vec3 direction_to_a(const Vec3& v) const noexcept { return pose_.rotation * v; }
  [[nodiscard]] Vec3 point_to_a(const Vec3& p) const noexcept {
    return pose_.rotation * p + pose_.translation;
  }
  [[nodiscard]] Vec3 point_to_b(const Vec3& p) const noexcept {
    return pose_.rotation.transpose() * (p - pose_.translation);
  }

  // The parts that are nearest to each other along n (unit, frame A). They bound the distance from
  // below, and `bounds` keeps the best.
  SupportPair support(const Vec3& n) noexcept;
  [[nodiscard]] SupportPair support_along(const Vec3& n) const noexcept;  // leaves `bounds` alone
  [[nodiscard]] SupportPair support_of(const PartPair& parts, const Vec3& n) const noexcept;

  // Makes n the direction of the lower bound, unless that would cost more than rounding.
  void prefer(const Vec3& n) noexcept;

  // Two points, pulled inside their bodies, bound the distance from above. Returns the points
  // inside.
  PointPair add_points(const Vec3& a, const Vec3& b_B) noexcept;

  // Doubles cannot bring the bounds closer together.
  [[nodiscard]] bool is_converged() const noexcept {
    return bounds.upper - bounds.lower <= gap_tolerance();
  }
  [[nodiscard]] double gap_tolerance() const noexcept { return 0x1p-50 * size; }
  [[nodiscard]] double error() const noexcept;

 private:
  const RelativePose& pose_;
};

}  // namespace clearance
