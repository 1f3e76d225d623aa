// The first twelve numbers of a DistanceResult. Vector registers store several of them at once,
// across the borders of its members.
#pragma once

#include <cstddef>

#include "core/distance_result.hpp"

namespace clearance {

static_assert(offsetof(DistanceResult, distance) == 0);
static_assert(offsetof(DistanceResult, normal) == 3 * sizeof(double));
static_assert(offsetof(DistanceResult, point_on_b) == 9 * sizeof(double));
static_assert(offsetof(DistanceResult, status) == 12 * sizeof(double));
// Four numbers are stored at point_on_b, which has three. The fourth must still lie in the result;
// the status is written after it.
static_assert(sizeof(DistanceResult) >= 13 * sizeof(double));

// The address of number i in the storage of the whole result. A pointer to a member is valid only
// within that member. This one is made from the bytes of the result, and is valid up to their end.
[[nodiscard]] inline double* number_at(DistanceResult& result, std::size_t i) noexcept {
  std::byte* const bytes = reinterpret_cast<std::byte*>(&result);
  return static_cast<double*>(static_cast<void*>(bytes + i * sizeof(double)));
}

}  // namespace clearance
