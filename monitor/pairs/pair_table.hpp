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
#include "config/scene/stated_errors.hpp"
#include "core/distance.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/large_column.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/inputs/checksum.hpp"
#include "monitor/pairs/evaluations.hpp"

namespace clearance {

// TrackedObject::accumulated of both objects of a pair, m.
struct AccumulatedDisplacement {
  double a = 0.0, b = 0.0;
};

struct DistanceBounds {
  double lower = -kInfinity, upper = kInfinity;  // m
};

// Bounds of a distance that may be larger or smaller by this, m.
[[nodiscard]] inline DistanceBounds widened(const DistanceBounds& bounds, double by) noexcept {
  if (by == 0.0) return bounds;
  return {rounded_down(bounds.lower - by), rounded_up(bounds.upper + by)};
}

// All that ticks ask of an object pair whether it is evaluated or not, in one cache line.
struct alignas(64) PairEntry {
  std::uint32_t object_a = 0, object_b = 0;
  AccumulatedDisplacement carried_at;  // when its part pairs were last brought up to date
  std::uint64_t carried_cycle = 0;     // the tick in which that was; 0: never
  double least_lower = -kInfinity;     // over its part pairs in that tick, m
  double lower_before = -kInfinity;    // for the poses of the tick before that, m
  // The tick in which all part pairs that matter were last evaluated; 0: never.
  std::uint64_t evaluated_cycle = 0;
  // The tick in which its bound was last found afresh from poses; 0: never. An evaluation does so,
  // and so do models of its objects that prove it far.
  std::uint64_t refreshed_cycle = 0;
};

// What the stated errors of the model do to a part pair. The table's bounds hold for every posture
// within those errors, since they are widened by `between.largest`. The others are of the last
// evaluation, whose direction leaves less open.
struct ErrorBounds {
  ErrorsBetween between;      // of the two objects
  double loss = 0.0;          // m: by which `lower` is below the bound for the model as stated
  double lower = -kInfinity;  // m
  double lower_before = -kInfinity;  // that of the tick before, if it was evaluated then, too
  double upper = kInfinity;          // m
  double drift = 0.0;                // ErrorAlong::drift, m
};

struct PairTable {
  LargeColumn<PairEntry> entries;  // as in Scene::pairs

  // By part pair.
  LargeColumn<double> lower, upper;  // true at carried_at, m
  Evaluations evaluations;
  LargeColumn<ErrorBounds> errors;  // empty: the scene states none

  // The stated errors change the distance of a part pair by no more than this, m.
  [[nodiscard]] double largest_error(std::uint32_t part_pair) const noexcept {
    return errors.empty() ? 0.0 : errors[part_pair].between.largest;
  }
  // The largest of them, m.
  [[nodiscard]] double most_error() const noexcept { return most_error_; }

  PairTable(const Scene& scene, const std::vector<PosedPart>& parts);
  [[nodiscard]] std::uint32_t pairs() const noexcept {
    return static_cast<std::uint32_t>(entries.size());
  }
  [[nodiscard]] std::uint32_t part_pairs() const noexcept {
    return static_cast<std::uint32_t>(lower.size());
  }
  // The part pairs of a pair are first_part_pair .. end_part_pair, the latter excluded.
  [[nodiscard]] std::uint32_t first_part_pair(std::uint32_t pair) const noexcept {
    return all_single_ ? pair : first_part_pair_[pair];
  }
  [[nodiscard]] std::uint32_t end_part_pair(std::uint32_t pair) const noexcept {
    return all_single_ ? pair + 1 : first_part_pair_[pair + 1];
  }
  [[nodiscard]] std::uint32_t part_pairs_of(std::uint32_t pair) const noexcept {
    return end_part_pair(pair) - first_part_pair(pair);
  }
  // Indices into parts_of(scene).
  [[nodiscard]] std::uint32_t part_a(std::uint32_t part_pair) const noexcept {
    return all_single_ ? entries[part_pair].object_a : part_a_[part_pair];
  }
  [[nodiscard]] std::uint32_t part_b(std::uint32_t part_pair) const noexcept {
    return all_single_ ? entries[part_pair].object_b : part_b_[part_pair];
  }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("first part pairs", first_part_pair_);
    visit("first parts of part pairs", part_a_);
    visit("second parts of part pairs", part_b_);
  }

 private:
  void number_part_pairs(const Scene& scene, const std::vector<PosedPart>& parts);
  void state_errors(const Scene& scene);

  double most_error_ = 0.0;
  // Every object has one part: a pair is its part pair, and an object is its part. The columns are
  // empty then.
  bool all_single_ = false;
  LargeColumn<std::uint32_t> first_part_pair_;  // by pair, and the end
  LargeColumn<std::uint32_t> part_a_, part_b_;  // by part pair
};

// The pair's distance was at most this, m, when it was last brought up to date: the smallest upper
// bound of its part pairs.
[[nodiscard]] inline double upper_of(std::uint32_t pair, const PairTable& table) noexcept {
  const std::uint32_t first = table.first_part_pair(pair), end = table.end_part_pair(pair);
  double upper = table.upper[first];
  for (std::uint32_t i = first + 1; i < end; ++i) {
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
