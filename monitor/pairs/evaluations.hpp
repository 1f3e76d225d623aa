// The results that queries of part pairs have left: hints for the next query, the closest points,
// and the bounds that the direction between them proves.
//
// In large cells hardly any pair is ever queried: models of its objects prove it far. So the room
// for this is not by part pair. Published pairs have theirs for good. The others share a number of
// records, which small cells never use up. When a large cell does, a part pair loses its record to
// another one. It then counts as never evaluated: its bounds stay, and its next query starts cold.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/distance.hpp"
#include "monitor/bodies/large_column.hpp"

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

struct Evaluation {
  TrackingState tracking;
  ClosestPoints closest;
  double gap = -kInfinity;  // kept_gap() of the last evaluation along closest.normal, m
  // A lower bound of the pair's distance, m, which only the first part pair of a pair has. It holds
  // from the tick before the last evaluation up to that evaluation. The directions of two
  // evaluations prove it. -infinity: they prove none.
  double lower_between = -kInfinity;
  DistanceStatus status = DistanceStatus::kIterationLimit;
};

class Evaluations {
 public:
  // Records that part pairs share, unless there are fewer of them, or many more; 3 MB.
  static constexpr std::size_t kShared = 16'384;
  static constexpr std::size_t kPartPairsPerRecord = 64;

  // `queries`: the most that a tick makes.
  Evaluations(std::size_t part_pairs, std::size_t queries);

  // Call this for part pairs that keep their record, before the first query.
  void keep(std::uint32_t part_pair);
  // Makes the shared records, once all that keep theirs have them.
  void share();

  [[nodiscard]] const Evaluation& operator[](std::uint32_t part_pair) const noexcept {
    return records_[slot_[part_pair]];
  }
  // The record of a part pair that is queried in this tick; maybe one that another part pair had.
  [[nodiscard]] Evaluation& of_query(std::uint32_t part_pair, std::uint64_t cycle) noexcept {
    const std::uint32_t slot = slot_[part_pair];
    return slot != kNever ? records_[slot] : assign(part_pair, cycle);
  }
  // The tick of a part pair's last evaluation; 0: never. These stand side by side: ticks look for
  // the part pair of a pair that is evaluated and closest.
  [[nodiscard]] std::uint64_t cycle(std::uint32_t part_pair) const noexcept {
    return cycle_[part_pair];
  }
  void set_cycle(std::uint32_t part_pair, std::uint64_t cycle) noexcept {
    cycle_[part_pair] = cycle;
  }
  // Null: the part pair has no record.
  [[nodiscard]] Evaluation* find(std::uint32_t part_pair) noexcept {
    const std::uint32_t slot = slot_[part_pair];
    return slot != kNever ? &records_[slot] : nullptr;
  }

 private:
  static constexpr std::uint32_t kNever = 0;  // a record of what was never evaluated

  [[nodiscard]] Evaluation& assign(std::uint32_t part_pair, std::uint64_t cycle) noexcept;

  const std::size_t queries_;
  std::size_t shared_ = 0;            // records
  LargeColumn<std::uint32_t> slot_;   // by part pair
  LargeColumn<std::uint64_t> cycle_;  // by part pair
  LargeColumn<Evaluation> records_;   // with capacity for all
  std::vector<std::uint32_t> user_;   // part pair by shared record
  std::uint32_t first_shared_ = 1;    // record
  std::uint32_t next_ = 1;            // the next one that loses its part pair
};

}  // namespace clearance
