// Exact rational arithmetic for checking answers: every double is a fraction.
#pragma once

#include <gmpxx.h>

#include <array>
#include <optional>
#include <string>

#include "core/pose.hpp"

namespace clearance {

using Rational = mpq_class;
using RationalPoint = std::array<Rational, 3>;

struct ExactNumber {
  Rational value;
  std::string text;  // as it was written
};

// "0.125", "-3e-7"; nothing when the text is not such a number.
[[nodiscard]] std::optional<Rational> rational_from(const std::string& decimal);

// The square root, within a few ulps. `square` >= 0.
[[nodiscard]] double root_of(const Rational& square);

// Transforms a point of the world into a body's frame; the orientation is normalised exactly.
[[nodiscard]] RationalPoint in_body(const Pose& world_from_body, const RationalPoint& in_world);

[[nodiscard]] Rational squared_distance(const RationalPoint& a, const RationalPoint& b);

}  // namespace clearance
