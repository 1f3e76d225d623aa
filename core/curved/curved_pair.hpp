// Two bodies and where B is as seen from A: support points of B - A, and the bounds that are known.
#pragma once

#include <algorithm>

#include "core/curved/active_pieces.hpp"
#include "core/curved/piece.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/pose.hpp"

namespace clearance {

// A point of each body, in its own frame, and B's also in A's.
struct PointPair {
  Vec3 a = Vec3::Zero(), own_b = Vec3::Zero(), b = Vec3::Zero();
  [[nodiscard]] Vec3 difference() const noexcept { return b - a; }
};

struct SupportPair {
  PiecePair pieces;
  PointPair points;
  double apart = 0.0;  // how far the pieces are apart along n; n from A to B
};

// In ulps of A's reach, of B's and of the offset between their origins. A support point: the
// products with the semi-axes 2, a norm 2.5, a quotient 1; pulled inside, as much again. B's: the
// direction turned to B's frame 4, the point turned back 4. Placing it and the difference 2, its
// product with n 3, n's length 2.5. tests/core/curved compares with exact answers.
inline constexpr double kUlpsOfA = 18, kUlpsOfB = 26, kUlpsOfOffset = 12;

// No bound is off by more, either way, m. `at`: how well B's place is known. `upper`: the upper
// bound, where it is one.
struct CurvedPlace {
  double rotation_error, translation_error, apart;  // as in RelativePose4
};
[[nodiscard]] inline double rounding_error(const PieceSource& a, const PieceSource& b,
                                           const CurvedPlace& at, double upper,
                                           double size) noexcept {
  const double farthest = std::max(0.0, std::min(upper, size));
  const double turned = std::min(b.reach, a.reach + at.apart + kStretched * farthest) * kRoundedUp;
  const double ulps = kUlpsOfA * a.reach + kUlpsOfB * b.reach + kUlpsOfOffset * at.apart;
  return kUlp * ulps + a.body->position_error + b.body->position_error + at.translation_error +
         at.rotation_error * turned + kUnderflow;
}

// The best of what has been found, for the bodies without their radii and before what rounding may
// have done to it (`error`).
struct CurvedBounds {
  double lower = -kInfinity, upper = kInfinity;
  Vec3 normal = Vec3::Zero();  // of `lower`, in frame A, from A to B
  PointPair points{};          // of `upper`
  PointPair deepest{};         // where the bodies overlap: that meet when B is moved by its depth
};

// The bodies and the pose outlive it.
class CurvedPair {
 public:
  CurvedPair(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b) noexcept;

  PieceSource a, b;
  CurvedBounds bounds;
  double size;  // m: what ulps are counted in

  // B as seen from A.
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

  // The pieces that are nearest to each other along n (unit, frame A) bound the distance from
  // below; `bounds` takes note of it.
  SupportPair support(const Vec3& n) noexcept;
  [[nodiscard]] SupportPair support_of(const PiecePair& pieces, const Vec3& n) const noexcept;

  // Makes n the direction of the lower bound, unless that would cost more than rounding.
  void prefer(const Vec3& n) noexcept;

  // Points of the bodies bound the distance from above; they are pulled inside first. Returns what
  // they have become.
  PointPair add_points(const Vec3& a, const Vec3& own_b) noexcept;

  // Nothing better is to be had from doubles.
  [[nodiscard]] bool is_tight() const noexcept {
    return bounds.upper - bounds.lower <= gap_tolerance();
  }
  [[nodiscard]] double gap_tolerance() const noexcept { return 0x1p-50 * size; }
  // No bound is off by more, either way, m.
  [[nodiscard]] double error() const noexcept;

 private:
  const RelativePose& pose_;
};

}  // namespace clearance
