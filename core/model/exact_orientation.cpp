#include "core/model/exact_orientation.hpp"

#include <cmath>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

bool equal_up_to_sign(const Quat& a, const Quat& b) noexcept {
  return a.coeffs() == b.coeffs() || a.coeffs() == -b.coeffs();
}

}  // namespace

bool permutes_axes(const Quat& q) noexcept {
  int halves = 0, ones = 0, zeros = 0;
  for (int i = 0; i < 4; ++i) {
    const double c = std::abs(q.coeffs()[i]);
    halves += c == 0.5;
    ones += c == 1.0;
    zeros += c == 0.0;
  }
  return halves == 4 || (ones == 1 && zeros == 3);
}

ExactOrientations exact_orientations(const Quat& a, const Quat& b) noexcept {
  const bool equal = equal_up_to_sign(a, b), a_permutes = permutes_axes(a);
  return {equal, equal || (a_permutes && permutes_axes(b)), a_permutes};
}

}  // namespace clearance
