// Exact numbers to doubles, rounded once.
#pragma once

#include "core/construction/integer_vector.hpp"
#include "core/convex_body.hpp"
#include "core/vec.hpp"

namespace clearance::exact {

// A double, and whether it equals the exact number.
struct Rounded {
  double value;
  bool exact;
};

// The double nearest to numerator / denominator. denominator > 0.
[[nodiscard]] Rounded nearest_quotient(const Integer& numerator, const Integer& denominator);

// The double nearest to numerator / sqrt(square). square > 0.
[[nodiscard]] Rounded nearest_over_root(const Integer& numerator, const Integer& square);

// direction / |direction|, every component within 0.51 ulp. direction is not zero.
[[nodiscard]] Vec3 unit(const Integer3& direction);

// A positive multiple of `direction` that is exactly three doubles, if there is one (`exact`).
// Otherwise the vector is unit(direction). Largest component in [1, 2) when exact.
struct RoundedDirection {
  Vec3 vector;
  bool exact;
};
[[nodiscard]] RoundedDirection nearest_direction(const Integer3& direction);

}  // namespace clearance::exact
