// One object pair in this tick: its part pairs in the pair table brought together, lateness counted
// in.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/pairs/pair_table.hpp"
#include "monitor/report.hpp"

namespace clearance {

struct PairBounds {
  PairStatus status = PairStatus::kUnknown;
  double lower = -kInfinity, upper = kInfinity;  // for where the objects may be now, m
  // Since the last tick (PairReport::swept_lower): never nearer than this, m.
  double swept_lower = -kInfinity;
  double swept_upper = kInfinity;  // at some instant no farther apart than this, m
  std::uint32_t part_pair = 0;  // the closest part pair, as far as is known: smallest upper bound
  std::uint64_t evaluated_cycle = 0;  // of that part pair; 0: no part pair ever was
};

// How closely the time since the last tick is looked at.
enum class SweptPrecision : std::uint8_t {
  kByDisplacement,          // by how far each object has come
  kByRelativeDisplacement,  // and by how far as seen from the other
};

// Of any pair, brought up to date this tick or not.
[[nodiscard]] PairBounds bounds_of(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                                   const std::vector<PosedPart>& parts, std::uint64_t cycle,
                                   const PairTable& table, SweptPrecision precision) noexcept;

// A known pair's distance since the last tick, from its bounds at both ends of the way; for the
// poses in use, those of this tick telling `lower`, m.
[[nodiscard]] double lower_since_last_tick(std::uint32_t pair, double lower,
                                           const std::vector<TrackedObject>& objects,
                                           std::uint64_t cycle, const PairTable& table,
                                           SweptPrecision precision) noexcept;

// What is published of it, into a report of that pair; everything but its refresh.
void report_on(std::uint32_t pair, const PairBounds& bounds,
               const std::vector<TrackedObject>& objects, const std::vector<PosedPart>& parts,
               const PairTable& table, PairReport& report) noexcept;

// Nothing is known: figures NaN, bounds infinite.
[[nodiscard]] PairReport unknown_report() noexcept;

[[nodiscard]] inline bool is_evaluated(PairStatus status) noexcept {
  return status <= PairStatus::kIterationLimit;
}

}  // namespace clearance
