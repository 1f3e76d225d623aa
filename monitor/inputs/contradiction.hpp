// Whether what came last of an object or a joint contradicts what is in use, or the cell: then
// nothing is known of it, until something is taken again and an age limit has passed since.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace clearance {

// Times are the tick's.
class Contradiction {
 public:
  // A sample was refused for what it says: what follows has to agree for `hold_ns`, and as long as
  // others before it asked for.
  void meet(std::int64_t now_ns, std::int64_t hold_ns) noexcept {
    until_ns_ = std::max(until_ns_, now_ns + hold_ns);
    agrees_again_ = false;
  }
  // One was taken.
  void agree() noexcept { agrees_again_ = true; }
  // Nobody can say how long ago the last one was.
  void forget_age() noexcept { until_ns_ = std::numeric_limits<std::int64_t>::min(); }

  [[nodiscard]] bool holds(std::int64_t now_ns) const noexcept {
    return !agrees_again_ || now_ns <= until_ns_;
  }

 private:
  std::int64_t until_ns_ = std::numeric_limits<std::int64_t>::min();
  bool agrees_again_ = true;
};

}  // namespace clearance
