// Which relative orientations come out of doubles without any error.
#pragma once

#include <bit>
#include <cstdint>

#include "core/vec.hpp"

namespace clearance {

// One of the 24 unit quaternions with components 0, +-1/2, +-1: rotations that permute the axes.
// Products of two of them, and their matrices, come out exact in doubles.
[[nodiscard]] bool permutes_axes(const Eigen::Quaterniond& q) noexcept;

struct ExactOrientations {
  bool equal;        // up to the sign: the relative rotation is the identity
  bool rotation;     // the rotation's matrix is exact
  bool translation;  // turning back by a permutes axes
};

[[nodiscard]] ExactOrientations exact_orientations(const Eigen::Quaterniond& a,
                                                   const Eigen::Quaterniond& b) noexcept;

// A quick look that moving orientations do not pass: at the w of a and the z of conj(a) b. Where
// one of them permutes axes or they are equal, one of the two is 0, 1/2 or 1: without digits.
[[nodiscard]] inline bool may_be_exact(double w_of_a, double z_of_both) noexcept {
  const auto has_digits = [](double x) { return std::bit_cast<std::uint64_t>(x) << 12 != 0; };
  return !has_digits(w_of_a) || !has_digits(z_of_both);
}

}  // namespace clearance
