// One object pair in this tick: the bounds of its part pairs brought together, and widened by the
// unobserved motion of late objects.
#pragma once

#include <cstdint>

#include "monitor/interface/report.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

struct PairBounds {
  PairStatus status = PairStatus::kUnknown;
  double lower = -kInfinity, upper = kInfinity;  // for where the objects may be now, m
  // Since the last tick (PairReport::swept_lower): the distance was never less than this, m.
  double swept_lower = -kInfinity;
  double swept_upper = kInfinity;     // at some instant it was not more than this, m
  std::uint32_t part_pair = 0;        // with the smallest upper bound: mostly the closest one
  std::uint64_t evaluated_cycle = 0;  // of that part pair; 0: no part pair was ever evaluated
};

// The motion by which the time since the last tick is bounded.
enum class SweptPrecision : std::uint8_t {
  kByDisplacement,          // by the displacement of each object
  kByRelativeDisplacement,  // and by that of one object relative to the other
};

// The status of a pair in the tick that evaluated it.
[[nodiscard]] PairStatus status_of(DistanceStatus status) noexcept;

// The bounds of any pair, whether it was brought up to date in this tick or not.
[[nodiscard]] PairBounds bounds_of(std::uint32_t pair, const TickView& view,
                                   SweptPrecision precision) noexcept;

// The part of upper - lower that stated errors make, m, in a scene that states some.
[[nodiscard]] double stated_width(std::uint32_t pair, const PairBounds& bounds,
                                  const TickView& view) noexcept;

// A lower bound of a known pair's distance since the last tick, m, for the poses in use; `lower` is
// the bound for the poses of this tick.
[[nodiscard]] double lower_since_last_tick(std::uint32_t pair, double lower, const TickView& view,
                                           SweptPrecision precision) noexcept;

// Writes all of a pair's report.
void write_pair(std::uint32_t pair, const PairBounds& bounds, const TickView& view,
                PairReport& report) noexcept;

// The report of a pair of which nothing is known: figures NaN, bounds infinite.
[[nodiscard]] PairReport unknown_report() noexcept;

[[nodiscard]] inline bool is_known(PairStatus status) noexcept {
  return status < PairStatus::kUnknown;
}
[[nodiscard]] inline bool is_evaluated(PairStatus status) noexcept {
  return status <= PairStatus::kIterationLimit;
}

}  // namespace clearance
