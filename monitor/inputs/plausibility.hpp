// Checks whether an input can have a value, given its earlier values and the speed that the cell
// states for it. One rule serves all inputs: poses of objects and positions of joints.
//
// An input with the speed limit v does not change by more than v (t + age limit) in the time t
// between two stamps. The age limit is the largest timing error that the cell accepts. The bound is
// checked against the value in use and against an older one, so that a series of steps cannot
// exceed it either.
//
// If two values exclude each other, they do not tell which one is wrong. The later value is not
// used. The input is unknown until a value agrees again and an age limit has passed since the last
// contradiction.
//
// A `Metric` says what distance and velocity mean for one kind of value:
//   Value, Rate                            a value, and its rate of change per second
//   bool stay_within(limit, from, to)      is the distance of the two values at most `limit`?
//   double length(rate)                    the speed of a rate, at least as large as the true one
//   Value moved(value, step)               the value after a small step (a rate times a time)
//   Rate scaled_sum(factor, a, b)          factor (a + b)
//   kRatesMayBeWrong                       true: values that move at least as far as their rates
//                                          say are right, and the rates are wrong
//   double distance(from, to)              the distance of two values; only if kRatesMayBeWrong
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "monitor/inputs/dead_reckoning.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/motion_limits.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

template <class Metric>
[[nodiscard]] bool can_reach(const Metric& metric, const typename Metric::Value& from,
                             const typename Metric::Value& to, std::int64_t elapsed_ns,
                             const MotionLimits& limits) noexcept {
  const double time = seconds(elapsed_ns) + seconds(limits.age_limit_ns);
  return metric.stay_within(limits.fastest * time, from, to);
}

// Detects a value that is sent repeatedly, bit for bit.
class Repetition {
 public:
  // `same` means that the sample has the value in use. `stamp_ns` is in the tick's time.
  void add(bool same, std::int64_t stamp_ns) noexcept {
    last_ns_ = stamp_ns;
    if (!same) since_ns_ = stamp_ns;
  }
  // The last stamp at which a value that repeats is not frozen.
  [[nodiscard]] std::int64_t permitted_until(const MotionLimits& limits) const noexcept {
    return limits.frozen_limit_ns > 0 ? less(since_ns_, -limits.frozen_limit_ns)
                                      : std::numeric_limits<std::int64_t>::max();
  }
  // True when the value has repeated for longer than the cell permits.
  [[nodiscard]] bool is_frozen(const MotionLimits& limits) const noexcept {
    return limits.frozen_limit_ns > 0 && elapsed(since_ns_, last_ns_) > limits.frozen_limit_ns;
  }

 private:
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

// A value, and its stamp in the tick's time.
template <class Metric>
struct StampedValue {
  using Value = typename Metric::Value;
  Value value{};
  std::int64_t stamp_ns = 0;

  // True if the input can get from this value to a later one.
  [[nodiscard]] bool allows(const Value& later, std::int64_t later_ns, const MotionLimits& limits,
                            const Metric& metric) const noexcept {
    return can_reach(metric, value, later, elapsed(stamp_ns, later_ns), limits);
  }
};

// An older value of the stream in use. The input must be able to get from it to each new value.
template <class Metric>
class FormerValue {
 public:
  using Value = typename Metric::Value;
  // The time for which a value stays, in age limits. It reveals an input whose speed always exceeds
  // its limit by more than a sixth.
  static constexpr std::int64_t kAgeLimits = 6;

  // Starts from the first value of a stream.
  void set(const Value& value, std::int64_t stamp_ns) noexcept { former_ = {value, stamp_ns}; }
  [[nodiscard]] bool allows(const Value& value, std::int64_t stamp_ns, const MotionLimits& limits,
                            const Metric& metric) const noexcept {
    return former_.allows(value, stamp_ns, limits, metric);
  }
  // The last stamp at which follow() does nothing.
  [[nodiscard]] std::int64_t unchanged_until(const MotionLimits& limits) const noexcept {
    return less(former_.stamp_ns, -kAgeLimits * limits.age_limit_ns);
  }
  // Call this with every later value that is taken.
  void follow(const Value& value, std::int64_t stamp_ns, const MotionLimits& limits) noexcept {
    if (elapsed(former_.stamp_ns, stamp_ns) > kAgeLimits * limits.age_limit_ns)
      set(value, stamp_ns);
  }

 private:
  StampedValue<Metric> former_;
};

// Detects values that stay at a place where the input cannot be.
template <class Metric>
class OtherPlace {
 public:
  using Value = typename Metric::Value;
  // Values that stay there for this time are taken.
  static constexpr std::int64_t kTakenAfterNs = 10'000'000'000;
  // The largest time between two consecutive values that still counts as staying; two age limits if
  // that is longer.
  static constexpr std::int64_t kGapNs = 1'000'000'000;

  // Returns true if the values have stayed long enough. Stamps are in the tick's time.
  [[nodiscard]] bool add(const Value& value, std::int64_t stamp_ns, const MotionLimits& limits,
                         const Metric& metric) noexcept {
    const std::int64_t largest_gap_ns = std::max(kGapNs, 2 * limits.age_limit_ns);
    const bool stays = any_ && elapsed(last_.stamp_ns, stamp_ns) <= largest_gap_ns &&
                       last_.allows(value, stamp_ns, limits, metric);
    if (!stays) since_ns_ = stamp_ns;
    any_ = true;
    last_ = {value, stamp_ns};
    return elapsed(since_ns_, stamp_ns) >= kTakenAfterNs;
  }
  void clear() noexcept { any_ = false; }
  [[nodiscard]] bool is_sound() const noexcept { return are_flags(any_); }

 private:
  bool any_ = false;
  StampedValue<Metric> last_;
  std::int64_t since_ns_ = 0;
};

// All checks of one input.
template <class Metric>
class Plausibility {
 public:
  using Value = typename Metric::Value;
  using Rate = typename Metric::Rate;
  struct Sample {
    const Value& value;
    const Rate* rate = nullptr;  // null: none was sent
    std::int64_t stamp_ns = 0;
  };

  // Returns why the sample cannot be true. `in_use` is the value in use, with its stamp; null if
  // there is none. `same` means that the sample has it. `repetition` counts such samples.
  [[nodiscard]] std::optional<Reject> refuses(const Sample& sample, const Value* in_use,
                                              std::int64_t in_use_ns, bool same,
                                              Repetition& repetition, const MotionLimits& limits,
                                              const Metric& metric) noexcept {
    value_contradicts_rates_ = false;
    repetition.add(same, sample.stamp_ns);
    if (same && repetition.is_frozen(limits)) return Reject::kFrozen;
    if (in_use != nullptr && !same && !is_reachable(sample, *in_use, in_use_ns, limits, metric))
      return Reject::kTooFast;
    if (sample.rate == nullptr) return std::nullopt;
    switch (reckoning_.add(sample.value, *sample.rate, sample.stamp_ns, same, limits, metric)) {
      case Agreement::kAgree:
        if (reckoning_.has_moved(limits)) rates_contradict_ = rates_are_impossible_ = false;
        return std::nullopt;
      case Agreement::kRatesContradict:
        if (!rates_are_impossible_ && values_contradict_until_ns_ >= sample.stamp_ns) break;
        rates_contradict_ = true;
        return std::nullopt;
      case Agreement::kValuesContradict:
        if (rates_are_impossible_) return std::nullopt;
        break;
    }
    rates_contradict_ = false;
    value_contradicts_rates_ = true;
    values_contradict_until_ns_ = less(sample.stamp_ns, -agree_for_ns(limits));
    return same ? Reject::kFrozen : Reject::kOtherDirection;
  }

  // Call this when a sample is taken into use. `is_first`: there was no value before.
  void use(const Value& value, std::int64_t stamp_ns, bool is_first,
           const MotionLimits& limits) noexcept {
    if (is_first) former_.set(value, stamp_ns);
    former_.follow(value, stamp_ns, limits);
    other_place_.clear();
  }

  // The last stamp at which a sample of the value in use changes nothing here. Its rate is zero, or
  // it has none, as the sample before it.
  [[nodiscard]] std::int64_t unchanged_until(bool has_rate, const Repetition& repetition,
                                             const MotionLimits& limits) const noexcept {
    const std::int64_t value =
        std::min(former_.unchanged_until(limits), repetition.permitted_until(limits));
    return has_rate ? std::min(value, reckoning_.unchanged_until(limits)) : value;
  }
  // Samples like that, with rates, were left out up to this stamp.
  void catch_up(std::int64_t stamp_ns) noexcept { reckoning_.catch_up(stamp_ns); }

  // The age of the value in use is not known any more.
  void forget_age(const Value& in_use, std::int64_t in_use_ns) noexcept {
    *this = {};
    former_.set(in_use, in_use_ns);
  }

  // After a refusal: the time for which later samples must agree. If the values were not where the
  // rates lead, it is so long that a slow deviation would be detected again. An input that always
  // lags behind is then not known in between.
  [[nodiscard]] std::int64_t agree_for_ns(const MotionLimits& limits) const noexcept {
    const std::int64_t age_limits =
        value_contradicts_rates_ ? Reckoning<Metric>::kAgeLimits + 1 : 1;
    return age_limits * limits.age_limit_ns;
  }

  // True if the sent rates contradict the values, which count as right. This ends when the values
  // agree with rates that have moved, or when they move less than the rates say. The latter ends it
  // only if no rate was one that the input cannot have.
  [[nodiscard]] bool rates_contradict() const noexcept { return rates_contradict_; }
  [[nodiscard]] bool is_sound() const noexcept {
    return are_flags(value_contradicts_rates_, rates_contradict_, rates_are_impossible_) &&
           reckoning_.is_sound() && other_place_.is_sound();
  }
  // Call this for a rate that the input cannot have.
  void distrust_rates() noexcept { rates_contradict_ = rates_are_impossible_ = true; }

 private:
  // True if the input can have come to this value, or if values have stayed there for so long that
  // it is taken anyway.
  [[nodiscard]] bool is_reachable(const Sample& sample, const Value& in_use, std::int64_t in_use_ns,
                                  const MotionLimits& limits, const Metric& metric) noexcept {
    const std::int64_t passed_ns = elapsed(in_use_ns, sample.stamp_ns);
    if (can_reach(metric, in_use, sample.value, passed_ns, limits) &&
        former_.allows(sample.value, sample.stamp_ns, limits, metric)) {
      return true;
    }
    if (!other_place_.add(sample.value, sample.stamp_ns, limits, metric)) return false;
    former_.set(sample.value, sample.stamp_ns);
    return true;
  }

  FormerValue<Metric> former_;
  Reckoning<Metric> reckoning_;
  OtherPlace<Metric> other_place_;
  bool value_contradicts_rates_ = false;  // the sample checked last
  bool rates_contradict_ = false;
  bool rates_are_impossible_ = false;  // one was: no value is refused because of the rates
  // Stamp until which the values have to agree with the rates.
  std::int64_t values_contradict_until_ns_ = std::numeric_limits<std::int64_t>::min();
};

// Two sources claim one input. Returns true if their values exclude each other. This is so if the
// input would need more than `speed` to be at both, within timing errors of an age limit. A quarter
// of a usual motion in an age limit is left for measuring errors.
template <class Metric>
[[nodiscard]] bool is_disputed(const Metric& metric, const typename Metric::Value& a,
                               std::int64_t a_ns, const typename Metric::Value& b,
                               std::int64_t b_ns, double speed,
                               const MotionLimits& limits) noexcept {
  constexpr double kMeasuringShare = 0.25;
  const double age = seconds(limits.age_limit_ns);
  const double time = seconds(std::max(elapsed(a_ns, b_ns), elapsed(b_ns, a_ns))) + age;
  const double error = kMeasuringShare * std::min(limits.usual, kUsualSpeed) * age;
  return !metric.stay_within(speed * time + error, a, b);
}

}  // namespace clearance
