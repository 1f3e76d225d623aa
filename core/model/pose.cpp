#include "core/pose.hpp"

#include <cmath>

#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

bool squares_fit(const Quat& q) noexcept { return is_in_range(q.squaredNorm()); }

}  // namespace

Pose rescaled(const Pose& pose) noexcept {
  const double largest = pose.orientation.coeffs().cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !std::isfinite(largest)) return pose;
  Pose out = pose;
  for (double& x : out.orientation.coeffs()) x = std::ldexp(x, -std::ilogb(largest));
  return out;
}

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  const Quat& q = pose.orientation;
  return rotation_matrix(squares_fit(q) ? q : rescaled(pose).orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  Quat both = outer.orientation * inner.orientation;
  if (!squares_fit(both)) both = rescaled(outer).orientation * rescaled(inner).orientation;
  return {transform(outer, inner.position), both.normalized()};
}

}  // namespace clearance
