#include "core/construction/orientation_predicate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clearance::exact {
namespace {

// To first order a determinant of four rounded rows is off by at most 17 * 2^-53 of its permanent.
// The inputs give 8, products 3, sums 6. 32 covers the permanent's own rounding as well.
constexpr double kDeterminantError = 0x1p-48;
// Products of four components stay far from underflow when none is smaller than this beside the
// largest.
constexpr long kSmallestExponent = -200;

std::array<double, 4> rounded_copy(const Integer4& point) {
  std::array<double, 4> significand{};
  std::array<long, 4> exponent{};
  long largest = std::numeric_limits<long>::min();
  for (std::size_t i = 0; i < 4; ++i) {
    if (sgn(point[i]) == 0) continue;
    significand[i] = mpz_get_d_2exp(&exponent[i], point[i].get_mpz_t());
    largest = std::max(largest, exponent[i]);
  }
  std::array<double, 4> copy{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (significand[i] == 0.0) continue;
    const long relative = exponent[i] - largest;
    if (relative < kSmallestExponent) {
      copy.fill(std::numeric_limits<double>::quiet_NaN());
      return copy;
    }
    copy[i] = std::ldexp(significand[i], static_cast<int>(relative));
  }
  return copy;
}

}  // namespace

PointSet::PointSet(std::span<const Integer4> points) : exact_(points) {
  rounded_.reserve(points.size());
  for (const Integer4& point : points) rounded_.push_back(rounded_copy(point));
}

FilteredPlane::FilteredPlane(const PointSet& points, const std::array<int, 3>& vertices)
    : vertices_(vertices) {
  const std::array<double, 4>& a = points.rounded(vertices[0]);
  const std::array<double, 4>& b = points.rounded(vertices[1]);
  const std::array<double, 4>& c = points.rounded(vertices[2]);
  plane_[3] = 0.0;
  spread_[3] = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const double bc = b[j] * c[k] - b[k] * c[j];
    const double ca = c[j] * a[k] - c[k] * a[j];
    const double ab = a[j] * b[k] - a[k] * b[j];
    const double bc_spread = std::abs(b[j] * c[k]) + std::abs(b[k] * c[j]);
    const double ca_spread = std::abs(c[j] * a[k]) + std::abs(c[k] * a[j]);
    const double ab_spread = std::abs(a[j] * b[k]) + std::abs(a[k] * b[j]);
    plane_[i] = a[3] * bc + b[3] * ca + c[3] * ab;
    spread_[i] = kDeterminantError * (a[3] * bc_spread + b[3] * ca_spread + c[3] * ab_spread);
    plane_[3] -= a[i] * bc;
    spread_[3] += kDeterminantError * (std::abs(a[i]) * bc_spread);
  }
}

int FilteredPlane::side(const PointSet& points, int point) {
  const std::array<double, 4>& p = points.rounded(point);
  const double value = plane_[0] * p[0] + plane_[1] * p[1] + plane_[2] * p[2] + plane_[3] * p[3];
  const double error = spread_[0] * std::abs(p[0]) + spread_[1] * std::abs(p[1]) +
                       spread_[2] * std::abs(p[2]) + spread_[3] * p[3];
  if (value > error) return 1;
  if (value < -error) return -1;
  if (!exact_) {
    exact_ = std::make_unique<Integer4>(plane_through(
        points.exact(vertices_[0]), points.exact(vertices_[1]), points.exact(vertices_[2])));
  }
  return sgn(dot(*exact_, points.exact(point)));
}

}  // namespace clearance::exact
