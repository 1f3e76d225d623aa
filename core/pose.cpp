#include "core/pose.hpp"

#include <cmath>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

// Half an ulp of 1: the relative error of one rounding.
constexpr double kUlp = 0x1p-53;

// Error of rotation_matrix() in the 2-norm, for an exact quaternion. The common factor s = 2/|q|^2
// is off by 4 roundings, which scales R - I (norm at most 2): 8. What multiplies it is off by 3 in
// each entry, and the nine |entries| have a Frobenius norm of at most 3: 9. The subtraction from 1
// on the diagonal: 2.
constexpr double kMatrixError = 20 * kUlp;

// Error of a Hamilton product: a component is four products in three roundings each, at most two
// ulps of the sum of their magnitudes (at most 1) and one of itself, so the vector is off by at
// most 5 ulps, and the rotation, which turns by twice the angle, by 10.
constexpr double kProductError = 10 * kUlp;

// R(q/|q|) of any non-zero q without a square root: N(q) / |q|^2.
inline Mat3 rotation_matrix(const Quat& q) noexcept {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double s = 2.0 / ((w * w + x * x) + (y * y + z * z));
  Mat3 r;
  r << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return r;
}

// conj(a) * b: the orientation of B as seen from A.
Quat relative(const Quat& a, const Quat& b) noexcept {
  return {(a.w() * b.w() + a.x() * b.x()) + (a.y() * b.y() + a.z() * b.z()),
          (a.w() * b.x() - a.x() * b.w()) + (a.z() * b.y() - a.y() * b.z()),
          (a.w() * b.y() - a.y() * b.w()) + (a.x() * b.z() - a.z() * b.x()),
          (a.w() * b.z() - a.z() * b.w()) + (a.y() * b.x() - a.x() * b.y())};
}

// R(q/|q|)^T v by two cross products. With |q| = 1 and exact inputs: each cross product is off by
// at most 2.5 ulps of |q||v|, their weighted sum by 6.5, twice that by 13; the factor 2/|q|^2 by 4,
// which moves the result by 8; the last two operations by 3.
constexpr double kTurnError = 24 * kUlp;

Vec3 turn_back(const Quat& q, const Vec3& v) noexcept {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double s = 2.0 / ((w * w + x * x) + (y * y + z * z));
  const Vec3 u(x, y, z);
  const Vec3 c = u.cross(v);
  return v + s * (u.cross(c) - w * c);
}

bool equal_up_to_sign(const Quat& a, const Quat& b) noexcept {
  return a.coeffs() == b.coeffs() || a.coeffs() == -b.coeffs();
}

// One of the 24 unit quaternions with components 0, +-1/2, +-1: rotations that permute the axes.
// Products of two of them, and their matrices, come out exact in doubles.
bool is_axis_permutation(const Quat& q) noexcept {
  int halves = 0, ones = 0, zeros = 0;
  for (int i = 0; i < 4; ++i) {
    const double c = std::abs(q.coeffs()[i]);
    halves += c == 0.5;
    ones += c == 1.0;
    zeros += c == 0.0;
  }
  return halves == 4 || (ones == 1 && zeros == 3);
}

// The same, after a look at one component that nearly always decides.
inline bool permutes_axes(const Quat& q) noexcept {
  const double w = std::abs(q.w());
  return (w == 0.0 || w == 0.5 || w == 1.0) && is_axis_permutation(q);
}

// A quick look that the orientations of a moving pair do not pass: the exact ones have zeros or
// equals.
bool may_be_exact(const Quat& q) noexcept {
  return q.x() * q.y() * q.z() == 0.0 || std::abs(q.x()) == std::abs(q.y());
}

void settle_exactness(const Quat& a, const Quat& b, RelativePose& result) noexcept {
  if (equal_up_to_sign(a, b)) {
    result.rotation = Mat3::Identity();
    result.rotation_error = 0.0;
  } else if (permutes_axes(a) && permutes_axes(b)) {
    result.rotation_error = 0.0;
  }
}

}  // namespace

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return rotation_matrix(pose.orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  const Quat& a = outer.orientation;
  const Quat& b = inner.orientation;
  return {transform(outer, inner.position), Quat(a * b).normalized()};
}

RelativePose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept {
  const Quat& a = world_from_a.orientation;
  const Quat& b = world_from_b.orientation;
  const Quat q = relative(a, b);
  const Vec3 between = world_from_b.position - world_from_a.position;
  RelativePose result{rotation_matrix(q), turn_back(a, between), kMatrixError + kProductError,
                      (kTurnError + kUlp) * between.norm()};
  if (may_be_exact(q)) settle_exactness(a, b, result);
  if (permutes_axes(a)) result.translation_error = 4 * kUlp * between.norm();
  return result;
}

}  // namespace clearance
