// The state of every pair from tick to tick: bounds, the last evaluation, the last refresh.
//
// An object pair owns consecutive part pairs, one for every part of the first object with every
// part of the second. A part pair's bounds are true for the poses at which the pair was last
// brought up to date. The displacement of both objects since then carries them to the poses in use
// (carried_bounds.hpp). So a pair that a tick does not touch costs nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "config/scene/scene.hpp"
#include "core/distance.hpp"
#include "monitor/geometry/posed_part.hpp"
#include "monitor/inputs/checksum.hpp"
#include "monitor/pairs/pair_column.hpp"

namespace clearance {

// A figure that is not known.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The witness points of two parts, in the world. NaN until evaluated.
struct ClosestPoints {
  double distance;  // m
  // The distance along the normal at the exact poses of that tick is at least this, m. -infinity:
  // the normal did not separate the parts.
  double lower;
  Vec3 witness_a, witness_b;
  Vec3 normal;
  ClosestPoints() noexcept;
};

// TrackedObject::accumulated of both objects of a pair, m.
struct AccumulatedDisplacement {
  double a = 0.0, b = 0.0;
};

struct DistanceBounds {
  double lower = -kInfinity, upper = kInfinity;  // m
};

// All that ticks ask of an object pair whether it is evaluated or not, in one cache line.
struct alignas(64) PairEntry {
  std::uint32_t object_a = 0, object_b = 0;
  std::uint32_t first_part_pair = 0, end_part_pair = 0;  // its part pairs, the latter excluded
  AccumulatedDisplacement carried_at;                    // when they were last brought up to date
  std::uint64_t carried_cycle = 0;                       // the tick in which that was; 0: never
  double least_lower = -kInfinity;                       // over its part pairs in that tick, m
  double lower_before = -kInfinity;                      // for the poses of the tick before that, m
  // The tick in which all part pairs that matter were last evaluated; 0: never.
  std::uint64_t evaluated_cycle = 0;
};

struct PairTable {
  PairColumn<PairEntry> entries;  // as in Scene::pairs

  // By pair, m: a lower bound of its distance from the tick before its last evaluation up to that
  // evaluation. The directions of two evaluations prove it. -infinity: they prove none.
  PairColumn<double> lower_between;
  // By pair. The tick in which its bound was last found afresh from poses, or 0 if never. An
  // evaluation does so, and so do models of its objects that prove it far.
  PairColumn<std::uint64_t> refreshed_cycle;

  // By part pair.
  PairColumn<std::uint32_t> part_a, part_b;             // indices into parts_of(scene)
  PairColumn<double> lower, upper;                      // true at carried_at, m
  PairColumn<std::uint64_t> part_pair_evaluated_cycle;  // 0: never
  PairColumn<DistanceStatus> status;
  PairColumn<TrackingState> tracking;
  PairColumn<ClosestPoints> closest;
  PairColumn<double> gap;  // kept_gap() of the last evaluation along closest.normal, m

  PairTable(const Scene& scene, const std::vector<PosedPart>& parts);
  [[nodiscard]] std::uint32_t pairs() const noexcept {
    return static_cast<std::uint32_t>(entries.size());
  }
  [[nodiscard]] std::uint32_t part_pairs_of(std::uint32_t pair) const noexcept {
    return entries[pair].end_part_pair - entries[pair].first_part_pair;
  }
  [[nodiscard]] std::uint32_t part_pairs() const noexcept {
    return static_cast<std::uint32_t>(part_a.size());
  }
};

// The pair's distance was at most this, m, when it was last brought up to date: the smallest upper
// bound of its part pairs.
[[nodiscard]] inline double upper_of(std::uint32_t pair, const PairTable& table) noexcept {
  const PairEntry& entry = table.entries[pair];
  double upper = table.upper[entry.first_part_pair];
  for (std::uint32_t i = entry.first_part_pair + 1; i < entry.end_part_pair; ++i) {
    upper = upper < table.upper[i] ? upper : table.upper[i];
  }
  return upper;
}

// Adds what the table holds of a pair, but the hints from which queries start.
void add_pair(std::uint32_t pair, const PairTable& table, Checksum& sum) noexcept;

// Forgets a pair's bounds, because the displacement of its objects is not known.
void forget_bounds(std::uint32_t pair, PairTable& table) noexcept;

// Forgets bounds and evaluations, because one of the objects has become absent.
void forget_pair(std::uint32_t pair, PairTable& table) noexcept;

}  // namespace clearance
