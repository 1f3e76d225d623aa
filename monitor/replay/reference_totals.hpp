// The outcome of holding a replay against reference distances (monitor/replay/reference_check.hpp).
#pragma once

#include <cstdint>

namespace clearance {

// Counts of reference values.
struct ReferenceTotals {
  std::uint64_t compared = 0;
  std::uint64_t off = 0;  // farther from our distance than the tolerance, or ours is not known
  std::uint64_t outside =
      0;  // not within our bounds, its rounding and a stated tolerance allowed for
  std::uint64_t other_pairs = 0;  // not compared: the cell does not watch them
  std::uint64_t other_times = 0;  // not compared: no tick was then
  double largest = 0.0;           // difference, m
};

}  // namespace clearance
