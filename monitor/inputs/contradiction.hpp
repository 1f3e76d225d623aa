// The contradiction state of one input: an object's pose or a joint's position.
//
// A contradictory sample is one that excludes the value in use, or that the cell excludes. After it
// nothing is known of the input until a sample is taken again and the hold time has passed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// All times are in the tick's time.
class Contradiction {
 public:
  // Call this when a sample was refused because of its contents. Later samples must agree for
  // `hold_ns`, and at least until the end of any earlier hold.
  void meet(std::int64_t now_ns, std::int64_t hold_ns) noexcept {
    until_ns_ = std::max(until_ns_, now_ns + hold_ns);
    agrees_again_ = false;
  }
  // Call this when a sample was taken into use.
  void agree() noexcept { agrees_again_ = true; }
  // Drops the hold time, because the time of the last contradiction is no longer known.
  void forget_age() noexcept { until_ns_ = std::numeric_limits<std::int64_t>::min(); }

  [[nodiscard]] bool holds(std::int64_t now_ns) const noexcept {
    return !agrees_again_ || now_ns <= until_ns_;
  }
  [[nodiscard]] bool is_sound() const noexcept { return are_flags(agrees_again_); }

 private:
  std::int64_t until_ns_ = std::numeric_limits<std::int64_t>::min();
  bool agrees_again_ = true;
};

}  // namespace clearance
