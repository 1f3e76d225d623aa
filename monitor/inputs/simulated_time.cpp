#include "monitor/inputs/simulated_time.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// A simulation is assumed to run at most this many times as fast as the true time.
constexpr std::int64_t kFastest = 10;

}  // namespace

std::int64_t SimulatedTime::Segment::after(std::int64_t passed_ns) const noexcept {
  const double share =
      static_cast<double>(std::max<std::int64_t>(passed_ns, 0)) / static_cast<double>(interval_ns);
  if (share >= 1.0) return end_ns;
  const auto step = static_cast<std::int64_t>(share * static_cast<double>(step_ns));
  return std::min(begin_ns + step, end_ns);
}

std::int64_t SimulatedTime::Segment::present(std::int64_t monotonic_ns,
                                             std::int64_t led_ns) const noexcept {
  const std::int64_t time_ns = after(elapsed(came_ns, monotonic_ns));
  return led_ns <= latest_ns ? std::max(time_ns, led_ns) : time_ns;
}

std::optional<SimulatedTime::Segment> SimulatedTime::segment(std::uint64_t number) const noexcept {
  std::array<std::int64_t, kWords> words;
  const auto& kept = kept_[number % kKept];
  for (std::size_t i = 0; i < kWords; ++i) words[i] = kept[i].load();
  // The writer may be filling the place of the oldest one.
  if (count_.load() >= number + kKept) return std::nullopt;
  return std::bit_cast<Segment>(words);
}

SimulatedTime::Segment SimulatedTime::last() const noexcept {
  for (;;) {
    const std::uint64_t count = count_.load();
    if (count == 0) return {};
    if (const auto found = segment(count - 1)) return *found;
  }
}

SimulatedTime::Change SimulatedTime::note(std::int64_t time_ns, std::int64_t sent_ns,
                                          std::int64_t came_ns) noexcept {
  const bool is_first = !is_known();
  const Segment before = last();
  Segment now{.sent_ns = sent_ns,
              .came_ns = came_ns,
              .clock_ns = time_ns,
              .begin_ns = time_ns,
              .end_ns = time_ns,
              .latest_ns = time_ns + kLongestStepNs + kLateNs,
              .resets = before.resets};
  const bool is_back = !is_first && time_ns < before.clock_ns;
  if (is_back) {
    ++now.resets;
    now.latest_ns = time_ns + elapsed(before.clock_ns, before.latest_ns);
  }
  if (!is_first && !is_back) {
    const std::int64_t step_ns = elapsed(before.clock_ns, time_ns);
    now.begin_ns = std::max(time_ns, before.after(now.sent_ns - before.sent_ns));
    now.end_ns = now.begin_ns;
    now.latest_ns =
        std::max(before.latest_ns, time_ns + std::min(2 * step_ns, kLongestStepNs) + kLateNs);
    if (step_ns <= kLongestStepNs) {
      now.end_ns = std::max(now.begin_ns, time_ns + step_ns);
      now.step_ns = step_ns;
      now.interval_ns = std::max<std::int64_t>(now.sent_ns - before.sent_ns, 1);
    }
  }
  const std::uint64_t number = count_.load();
  const auto words = std::bit_cast<std::array<std::int64_t, kWords>>(now);
  for (std::size_t i = 0; i < kWords; ++i) kept_[number % kKept][i].store(words[i]);
  count_.store(number + 1);
  if (is_first) return Change::kFirst;
  return is_back ? Change::kBack : Change::kGoesOn;
}

void SimulatedTime::lead(std::int64_t stamp_ns) noexcept {
  for (std::int64_t led_ns = led_ns_.load(); led_ns != stamp_ns;) {
    const std::int64_t latest_ns = this->latest_ns();
    const bool is_passed = led_ns >= stamp_ns && led_ns <= latest_ns;
    if (stamp_ns > latest_ns || is_passed || led_ns_.compare_exchange_weak(led_ns, stamp_ns))
      return;
  }
}

bool SimulatedTime::is_silent(std::int64_t monotonic_ns) const noexcept {
  return is_known() && elapsed(last().came_ns, monotonic_ns) > kSilentNs;
}

std::uint64_t SimulatedTime::resets() const noexcept { return last().resets; }

std::int64_t SimulatedTime::clock_ns() const noexcept { return last().clock_ns; }

std::int64_t SimulatedTime::now_ns(std::int64_t monotonic_ns) const noexcept {
  const std::int64_t led_ns = led_ns_.load();
  return last().present(monotonic_ns, led_ns);
}

std::int64_t SimulatedTime::passes_in(std::int64_t true_ns) const noexcept {
  const Segment now = last();
  const double speed = static_cast<double>(now.step_ns) / static_cast<double>(now.interval_ns);
  constexpr double kMost = 1e18;  // a step within 1 ns has any speed
  return static_cast<std::int64_t>(
      std::clamp(std::ceil(speed * static_cast<double>(true_ns)), -kMost, kMost));
}

std::int64_t SimulatedTime::at(std::int64_t sent_ns) const noexcept {
  Segment later{};
  bool has_later = false;
  for (std::uint64_t number = count_.load(); number > 0; --number) {
    const auto found = segment(number - 1);
    if (!found) break;
    if (found->sent_ns <= sent_ns) {
      const std::int64_t time_ns = found->after(sent_ns - found->sent_ns);
      // The step after it may have been a smaller one.
      const bool goes_on = has_later && later.resets == found->resets;
      return goes_on ? std::min(time_ns, later.begin_ns) : time_ns;
    }
    later = *found;
    has_later = true;
  }
  if (!has_later) return 0;
  return less(later.clock_ns,
              kFastest * std::min(elapsed(sent_ns, later.sent_ns), 100 * kSilentNs));
}

TickTime SimulatedTime::tick_time(std::int64_t monotonic_ns) noexcept {
  const std::int64_t led_ns = led_ns_.load();
  const Segment now = last();
  const std::int64_t time_ns = now.present(monotonic_ns, led_ns);
  const bool is_silent_now = is_silent(monotonic_ns);
  if (std::exchange(told_resets_, now.resets) != now.resets) {
    told_ns_ = std::max<std::int64_t>(std::min(time_ns, told_ns_ - 1), 0);
  } else if (is_silent_now && !told_silence_) {
    --told_ns_;
  } else {
    told_ns_ = std::max(time_ns, told_ns_ + 1);
  }
  told_silence_ = is_silent_now;
  return told_ns_;
}

}  // namespace clearance
