// Timing wheels that run on displacement instead of time: one wheel an object, one timer a pair and
// side.
//
// A timer on an object's wheel is due before the object has moved farther than the timer was set
// for. It may be due up to a quarter of that displacement earlier. An object that stands still
// costs nothing. One that moves costs as much as it has timers due.
//
// A wheel is a hierarchy of rings of eight buckets; a bucket of level l is 2^l units of
// displacement wide. A timer is put into the level where its bucket is at least three and at most
// seven ahead, and stays there. A pair that is due early is examined and its timer is set again.
// This costs no more than moving the timer between levels would.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "monitor/bodies/large_column.hpp"

namespace clearance {

class MotionWheels {
 public:
  // The smallest displacement that can be set, and the step of all others, m.
  static constexpr double kUnit = 0x1p-12;

  MotionWheels(std::size_t objects, std::size_t pairs);

  // Sets timer `timer` (2 * pair + side, not set yet) to be due by the time `object` has advanced
  // by `displacement` more. Returns false and sets nothing when the displacement is too small.
  bool set(std::uint32_t timer, std::uint32_t object, double displacement) noexcept;

  // Cancels a timer, set or not.
  void cancel(std::uint32_t timer) noexcept;

  [[nodiscard]] bool is_set(std::uint32_t timer) const noexcept {
    return timers_[timer].before != kNotSet;
  }

  // Fetches the memory of both timers of a pair that will be set soon.
  void fetch(std::uint32_t pair) const noexcept { __builtin_prefetch(&timers_[2 * pair], 1); }

  // `object` has moved by at most `by`, m: >= 0, finite.
  void advance(std::uint32_t object, double by) noexcept;

  // Appends to `pairs` those with a due timer on this wheel and cancels both their timers. Stops
  // when `pairs` has `most` elements; false: there may be more.
  bool take_due(std::uint32_t object, std::size_t most, std::vector<std::uint32_t>& pairs) noexcept;

 private:
  static constexpr std::uint32_t kRing = 8;
  static constexpr std::uint32_t kLevels = 20;  // the widest bucket: 128 m
  static constexpr std::uint32_t kNoIndex = ~0u;
  static constexpr std::uint32_t kNotSet = ~0u;
  static constexpr std::uint32_t kHead = 1u << 31;  // `before` is a bucket, not a timer

  struct Timer {
    std::uint32_t next = kNoIndex;
    std::uint32_t before = kNotSet;
  };
  struct Wheel {
    double accumulated = 0.0;  // displacement, m, rounded up
    std::int64_t done = 0;     // units: buckets up to here are empty
  };

  bool empty_bucket(std::uint32_t bucket, std::size_t most,
                    std::vector<std::uint32_t>& pairs) noexcept;

  std::vector<Wheel> wheels_;
  std::vector<std::uint32_t> first_;  // timer by bucket: object, level, place in the ring
  LargeColumn<Timer> timers_;
};

}  // namespace clearance
