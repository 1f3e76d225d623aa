// The last values of one input that were taken, by their stamps, and the times at which it was
// contradicted.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/stamped_series.hpp"

namespace clearance {

// All times are stamps.
template <class Value>
class PastValues {
 public:
  explicit PastValues(std::size_t most) : values_(most) {}

  // A value was taken. What was contradicted before it is so until then at least.
  void use(std::int64_t stamp_ns, const Value& value) {
    values_.add(stamp_ns, value);
    if (is_open_) newest().until_ns = std::max(newest().until_ns, less(stamp_ns, 1));
    is_open_ = false;
  }
  // A sample was refused because of its contents: nothing is known from the value before it until
  // one is taken again, and for `hold_ns` before and after this stamp.
  void contradict(std::int64_t stamp_ns, std::int64_t hold_ns) noexcept {
    std::int64_t from_ns = less(stamp_ns, hold_ns);
    if (!values_.empty()) from_ns = std::min(from_ns, less(values_.last().stamp_ns, -1));
    const std::int64_t until_ns = less(stamp_ns, -hold_ns);
    const bool goes_on = count_ > 0 && from_ns <= newest().until_ns && until_ns >= newest().from_ns;
    if (!goes_on && count_ == kKept) {
      // The two oldest become one: nothing that was contradicted is forgotten.
      times_[1].from_ns = times_[0].from_ns;
      std::copy(times_.begin() + 1, times_.end(), times_.begin());
      --count_;
    }
    if (!goes_on) times_[count_++] = {from_ns, until_ns};
    newest() = {std::min(newest().from_ns, from_ns), std::max(newest().until_ns, until_ns)};
    is_open_ = true;
  }
  void clear() noexcept {
    values_.clear();
    count_ = 0;
    is_open_ = false;
  }

  [[nodiscard]] const StampedSeries<Value>& values() const noexcept { return values_; }
  // Was it contradicted at any time from the first to the last of these?
  [[nodiscard]] bool is_contradicted(std::int64_t first_ns, std::int64_t last_ns) const noexcept {
    if (is_open_ && last_ns >= times_[count_ - 1].from_ns) return true;
    return std::any_of(
        times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(count_),
        [&](const Time& time) { return time.from_ns <= last_ns && first_ns <= time.until_ns; });
  }
  [[nodiscard]] bool is_contradicted(std::int64_t stamp_ns) const noexcept {
    return is_contradicted(stamp_ns, stamp_ns);
  }

 private:
  struct Time {
    std::int64_t from_ns = 0, until_ns = 0;
  };
  static constexpr std::size_t kKept = 4;
  [[nodiscard]] Time& newest() noexcept { return times_[count_ - 1]; }

  StampedSeries<Value> values_;
  std::array<Time, kKept> times_{};  // the oldest comes first
  std::size_t count_ = 0;
  bool is_open_ = false;  // no value was taken since the newest of them
};

}  // namespace clearance
