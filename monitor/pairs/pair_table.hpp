// What is known about every pair: bounds for the poses in use, and the last evaluation.
//
// An object pair owns consecutive part pairs, one for every part of the first with every part of
// the second. A part pair's bounds are true for the poses at which the pair was last brought up to
// date; how far both objects have moved since makes them true for those in use. So a pair
// that is not looked at costs nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "config/scene/scene.hpp"
#include "core/distance.hpp"
#include "monitor/geometry/posed_part.hpp"

namespace clearance {

// Of what is not known.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Where two parts were found to be closest, in the world. NaN until evaluated.
struct ClosestPoints {
  double distance;  // m
  double lower;     // along the normal, for the exact poses of then, m; -infinity: nothing
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

// Of an object pair, all that ticks ask of it whether it is evaluated or not: one cache line.
struct alignas(64) PairEntry {
  std::uint32_t object_a = 0, object_b = 0;
  std::uint32_t first_part_pair = 0, end_part_pair = 0;  // its part pairs, the latter excluded
  AccumulatedDisplacement carried_at;                    // when they were last brought up to date
  std::uint64_t carried_cycle = 0;                       // the tick in which that was; 0: never
  double least_lower = -kInfinity;                       // over its part pairs then, m
  double lower_before = -kInfinity;                      // for the poses of the tick before that, m
  std::uint64_t evaluated_cycle = 0;  // when all part pairs that matter last were; 0: never
};

struct PairTable {
  std::vector<PairEntry> entries;  // as in Scene::pairs

  // By pair: at least as far apart, m, from the tick before its last evaluation up to that, as the
  // directions of two evaluations tell; -infinity: they do not.
  std::vector<double> lower_between;

  // By part pair.
  std::vector<std::uint32_t> part_a, part_b;             // indices into parts_of(scene)
  std::vector<double> lower, upper;                      // true at carried_at, m
  std::vector<std::uint64_t> part_pair_evaluated_cycle;  // 0: never
  std::vector<DistanceStatus> status;
  std::vector<TrackingState> tracking;
  std::vector<ClosestPoints> closest;
  std::vector<double> gap;  // kept_gap() of the last evaluation along closest.normal, m

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

// The pair is no farther apart than this, m: the smallest upper bound of its part pairs, as they
// were last brought up to date.
[[nodiscard]] inline double upper_of(std::uint32_t pair, const PairTable& table) noexcept {
  const PairEntry& entry = table.entries[pair];
  double upper = table.upper[entry.first_part_pair];
  for (std::uint32_t i = entry.first_part_pair + 1; i < entry.end_part_pair; ++i) {
    upper = upper < table.upper[i] ? upper : table.upper[i];
  }
  return upper;
}

// No point of the two objects has come farther, both together, since the pair was brought up to
// date, m.
[[nodiscard]] double displacement_since(std::uint32_t pair,
                                        const std::vector<TrackedObject>& objects,
                                        const PairTable& table) noexcept;

// Something has moved since the last tick, and the pair's bounds are of this one (raise()).
[[nodiscard]] bool raised_this_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                                    const PairTable& table) noexcept;

// The pair's distance at the tick before `cycle` was at least this, m, if its objects were known
// then.
[[nodiscard]] double lower_last_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                                     std::uint64_t cycle, const PairTable& table) noexcept;

// A part pair's bounds for the poses in use, both objects having been seen: looser by what they
// have moved by, but never looser than the parts' spheres tell.
[[nodiscard]] DistanceBounds bounds_now(std::uint32_t part_pair, double displacement,
                                        const std::vector<PosedPart>& parts,
                                        const PairTable& table) noexcept;

// Brings a pair's part pairs up to date. Both objects have been seen.
void carry(std::uint32_t pair, const std::vector<TrackedObject>& objects,
           const std::vector<PosedPart>& parts, std::uint64_t cycle, PairTable& table) noexcept;

// Takes note that a pair's part pairs are up to date, before least_lower is: that is still known of
// the pair as it was.
void note_carried(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                  std::uint64_t cycle, PairTable& table) noexcept;

// Takes note of a lower bound of the pair's distance for the poses in use, m. Its part pairs are
// carried by displacement alone, which costs a fraction of carry(): their spheres are looked at by
// who asks for them.
void raise(std::uint32_t pair, double to, const std::vector<TrackedObject>& objects,
           PairTable& table) noexcept;

// Forgets a pair's bounds: how far its objects have come is not known.
void forget(std::uint32_t pair, PairTable& table) noexcept;

}  // namespace clearance
