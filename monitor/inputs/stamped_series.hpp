// The last values of one input by their stamps, and the two that enclose a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {

// A stamp that is this much older than the last one is of a clock that was set back, ns.
inline constexpr std::int64_t kSetBackNs = 1'000'000'000;

// A ring of fixed memory. Stamps increase.
template <class Value>
class StampedSeries {
 public:
  explicit StampedSeries(std::size_t most) : entries_(most) {}

  struct Entry {
    std::int64_t stamp_ns = 0;
    Value value{};
  };
  // The last entry at or before the time and the first one at or after it; null: none is kept.
  struct Neighbours {
    const Entry* before = nullptr;
    const Entry* after = nullptr;
  };

  // Values that are not newer than the last one are left out. One of a clock that was set back
  // begins the series anew.
  void add(std::int64_t stamp_ns, const Value& value) {
    if (size_ > 0 && stamp_ns <= last().stamp_ns) {
      if (elapsed(stamp_ns, last().stamp_ns) <= kSetBackNs) return;
      clear();
    }
    entries_[(first_ + size_) % entries_.size()] = {stamp_ns, value};
    if (size_ < entries_.size()) {
      ++size_;
    } else {
      first_ = (first_ + 1) % entries_.size();
    }
  }
  void clear() noexcept { first_ = size_ = 0; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  // The oldest comes first.
  [[nodiscard]] const Entry& at(std::size_t i) const noexcept {
    return entries_[(first_ + i) % entries_.size()];
  }
  [[nodiscard]] const Entry& last() const noexcept { return at(size_ - 1); }

  // The first entry at or after the time; size(): there is none.
  [[nodiscard]] std::size_t first_from(std::int64_t stamp_ns) const noexcept {
    std::size_t low = 0, high = size_;  // it is in [low, high]
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (at(middle).stamp_ns < stamp_ns) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

  [[nodiscard]] Neighbours around(std::int64_t stamp_ns) const noexcept {
    const std::size_t low = first_from(stamp_ns);
    Neighbours found;
    if (low < size_) found.after = &at(low);
    if (found.after != nullptr && found.after->stamp_ns == stamp_ns) {
      found.before = found.after;
    } else if (low > 0) {
      found.before = &at(low - 1);
    }
    return found;
  }

 private:
  std::vector<Entry> entries_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace clearance
