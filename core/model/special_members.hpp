// Assignments that the compiler writes, used here first. GCC 16 compiles such a function for the
// processor of the code that uses it first. First used in code of AVX2, it would be called on
// processors without it.
#pragma once

#include <utility>

#include "core/distance_result.hpp"

namespace clearance {

inline void assign_once(TrackingState::Side& side, const TrackingState::Side& other,
                        DistanceResult& result, DistanceResult& moved) noexcept {
  side = other;
  result = std::move(moved);
}

}  // namespace clearance
