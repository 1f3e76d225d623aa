#include "core/pose.hpp"

#include <cmath>

#include "core/rounding.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

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

// R(q/|q|)^T v.
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
  RelativePose result{rotation_matrix(q), turn_back(a, between), kRotationError,
                      kTranslationError * between.norm()};
  if (may_be_exact(q)) settle_exactness(a, b, result);
  if (permutes_axes(a)) result.translation_error = kPermutedTranslationError * between.norm();
  return result;
}

}  // namespace clearance
