// Detects values that contradict the rates sent with them: frozen values, values that lag behind,
// and wrong rates. The `Metric` is that of plausibility.hpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/motion_limits.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// Whether values and sent rates agree, and if not, which of the two decides.
enum class Agreement : std::uint8_t {
  kAgree,
  kValuesContradict,  // the value is not where the rates lead: it must not be used
  kRatesContradict,   // the rates say less than the values show: the values decide
};

// Dead reckoning: integrates the sent rates from an older value.
//
// A rate may have a timing error of the age limit and a relative error of one sixth. Over the whole
// integration time, noise of up to a thirtieth of the usual speed accumulates to little, and so
// does an offset of up to a fiftieth of that speed. Samples without a rate are left out. Nothing is
// checked if rates come less often than every two age limits.
template <class Metric>
class Reckoning {
 public:
  using Value = typename Metric::Value;
  using Rate = typename Metric::Rate;

  // The integration time, in age limits. Over a longer time, noise would accumulate too much.
  static constexpr std::int64_t kAgeLimits = 50;
  // The time of the short integration, in age limits.
  static constexpr std::int64_t kShortAgeLimits = 10;
  // Values are compared at most so often in an age limit. The steps between are summed up, and the
  // last comparison holds for them.
  static constexpr std::int64_t kComparesAnAgeLimit = 8;
  // Over a longer gap, in age limits, the mean of two rates says nothing about the motion between.
  static constexpr std::int64_t kGapAgeLimits = 2;
  static constexpr double kRateError = 1.0 / 6.0;
  // The share of the usual motion in an age limit that rates may leave out without being wrong.
  static constexpr double kLeftOut = 0.125;

  // Adds a sample. `same` means the same as in Repetition::add().
  [[nodiscard]] Agreement add(const Value& value, const Rate& rate, std::int64_t stamp_ns,
                              bool same, const MotionLimits& limits,
                              const Metric& metric) noexcept {
    const std::int64_t age_ns = limits.age_limit_ns;
    if (!any_ || elapsed(last_ns_, stamp_ns) > kGapAgeLimits * age_ns) {
      start_both(value, rate, stamp_ns, metric);
      return Agreement::kAgree;
    }
    const Step step = step_to(rate, stamp_ns, metric);
    const Agreement of_short = compare_short(value, step, stamp_ns, same, limits, metric);
    if (of_short == Agreement::kRatesContradict) {
      start_both(value, rate, stamp_ns, metric);
      return of_short;
    }
    if (elapsed(since_ns_, stamp_ns) > kAgeLimits * age_ns) {
      start(value, rate, stamp_ns, metric);
    } else {
      integrate(step, rate, stamp_ns);
    }
    if (of_short != Agreement::kAgree) return of_short;
    if (elapsed(compared_ns_, stamp_ns) < age_ns / kComparesAnAgeLimit) return agreement_;
    compared_ns_ = stamp_ns;
    led_to_ = metric.moved(led_to_, std::exchange(to_add_, Rate{}));
    const Agreement agreement = agreement_ = compare(value, stamp_ns, limits, metric);
    if (agreement != Agreement::kAgree && !same) start(value, rate, stamp_ns, metric);
    return agreement;
  }

  // The last stamp at which a value that repeats, with a rate of zero, continues both integrations
  // without a change.
  [[nodiscard]] std::int64_t unchanged_until(const MotionLimits& limits) const noexcept {
    return std::min(less(since_ns_, -kAgeLimits * limits.age_limit_ns),
                    less(short_.since_ns, -kShortAgeLimits * limits.age_limit_ns));
  }
  // Values like that were left out up to this stamp.
  void catch_up(std::int64_t stamp_ns) noexcept { last_ns_ = stamp_ns; }

  [[nodiscard]] bool is_sound() const noexcept {
    return are_flags(any_, short_.repeats) && agreement_ <= Agreement::kRatesContradict;
  }
  // True if the rates have moved by more than any error.
  [[nodiscard]] bool has_moved(const MotionLimits& limits) const noexcept {
    return path_ > 2.0 * largest_error(path_, fastest_, limits);
  }

 private:
  struct Step {
    Rate change;    // the integral of the rate from one sample to the next
    double length;  // of that path
    double speed;   // at its end
  };
  // An integration over a short time, which begins anew when a value begins or ceases to repeat. An
  // input that freezes late in the long integration, or whose rates become wrong there, is detected
  // as fast as early in it. Rates are compared only if they may be wrong.
  struct Short {
    bool repeats = false;    // the last sample repeated a value
    Value from{}, led_to{};  // where it began, and where the rates lead from there
    double path = 0.0;
    double fastest = 0.0;
    std::int64_t since_ns = 0;
  };

  // A value that repeats contradicts rates that say that the input has moved since. One that has
  // moved at least as far as they say, but to another place, shows that they are wrong.
  [[nodiscard]] Agreement compare_short(const Value& value, const Step& step, std::int64_t stamp_ns,
                                        bool same, const MotionLimits& limits,
                                        const Metric& metric) noexcept {
    if (!same && !Metric::kRatesMayBeWrong) {
      short_.repeats = false;
      return Agreement::kAgree;
    }
    if (same != short_.repeats ||
        elapsed(short_.since_ns, stamp_ns) > kShortAgeLimits * limits.age_limit_ns) {
      short_ = {.repeats = same, .from = value, .led_to = value, .since_ns = stamp_ns};
      short_.fastest = same ? last_speed_ : step.speed;
      if (!same) return Agreement::kAgree;
      short_.since_ns = last_ns_;  // it was there already
    }
    short_.fastest = std::max(short_.fastest, step.speed);
    if (step.length > 0.0) {
      short_.led_to = metric.moved(short_.led_to, step.change);
      short_.path += step.length;
    }
    if (same) {
      return short_.path == 0.0 ||
                     metric.stay_within(largest_error(short_.path, short_.fastest, limits),
                                        short_.led_to, value)
                 ? Agreement::kAgree
                 : Agreement::kValuesContradict;
    }
    if constexpr (Metric::kRatesMayBeWrong) {
      const bool moves_less =
          metric.distance(short_.from, value) < (1.0 - kRateError) * short_.path;
      if (!moves_less && !metric.stay_within(least_error(short_.path, short_.fastest, limits),
                                             short_.led_to, value)) {
        return Agreement::kRatesContradict;
      }
    }
    return Agreement::kAgree;
  }

  // Farther than this, a value contradicts the rates that were integrated along `path`. Rates that
  // are an age limit late do not contain the last part of the motion yet. Instead they contain what
  // preceded the first of them.
  [[nodiscard]] static double largest_error(double path, double fastest,
                                            const MotionLimits& limits) noexcept {
    return (std::max(limits.usual, fastest) + fastest) * seconds(limits.age_limit_ns) +
           kRateError * path;
  }
  // A value at most this far from where the rates lead does not show that the rates are too small.
  [[nodiscard]] static double least_error(double path, double fastest,
                                          const MotionLimits& limits) noexcept {
    return (kLeftOut * limits.usual + 2.0 * fastest) * seconds(limits.age_limit_ns) +
           kRateError * path;
  }

  // A value that moves less than its rates say may be frozen. If it moves at least as far, but to
  // another place, the rates are wrong, provided that Metric::kRatesMayBeWrong. Many drivers of
  // joints, for example, send rates of 0.
  [[nodiscard]] Agreement compare(const Value& value, std::int64_t stamp_ns,
                                  const MotionLimits& limits, const Metric& metric) noexcept {
    if constexpr (Metric::kRatesMayBeWrong) {
      const double step = metric.distance(step_from_, value);
      const bool moves_less = value_path_ + step < (1.0 - kRateError) * path_;
      if (elapsed(step_ns_, stamp_ns) >= limits.age_limit_ns) {
        value_path_ += step;
        step_from_ = value;
        step_ns_ = stamp_ns;
      }
      if (!moves_less) {
        return metric.stay_within(least_error(path_, fastest_, limits), led_to_, value)
                   ? Agreement::kAgree
                   : Agreement::kRatesContradict;
      }
    }
    return metric.stay_within(largest_error(path_, fastest_, limits), led_to_, value)
               ? Agreement::kAgree
               : Agreement::kValuesContradict;
  }

  void start_both(const Value& value, const Rate& rate, std::int64_t stamp_ns,
                  const Metric& metric) noexcept {
    start(value, rate, stamp_ns, metric);
    short_ = {.from = value, .led_to = value, .fastest = last_speed_, .since_ns = stamp_ns};
  }
  void start(const Value& value, const Rate& rate, std::int64_t stamp_ns,
             const Metric& metric) noexcept {
    any_ = true;
    led_to_ = step_from_ = value;
    path_ = value_path_ = 0.0;
    last_ = rate;
    last_speed_ = fastest_ = metric.length(rate);
    to_add_ = Rate{};
    agreement_ = Agreement::kAgree;
    since_ns_ = last_ns_ = step_ns_ = compared_ns_ = stamp_ns;
  }

  // Trapezoidal rule: integrates the mean of the last rate and this one.
  [[nodiscard]] Step step_to(const Rate& rate, std::int64_t stamp_ns,
                             const Metric& metric) const noexcept {
    const double half = 0.5 * seconds(elapsed(last_ns_, stamp_ns));
    const double speed = metric.length(rate);
    return {Metric::scaled_sum(half, last_, rate), half * (last_speed_ + speed), speed};
  }
  void integrate(const Step& step, const Rate& rate, std::int64_t stamp_ns) noexcept {
    to_add_ = Metric::scaled_sum(1.0, to_add_, step.change);
    path_ += step.length;
    last_ = rate;
    last_speed_ = step.speed;
    fastest_ = std::max(fastest_, last_speed_);
    last_ns_ = stamp_ns;
  }

  bool any_ = false;
  Value led_to_{};        // where the rates lead from the first value, without `to_add_`
  Rate to_add_{};         // what they moved since `compared_ns_`
  double path_ = 0.0;     // length of the integrated path
  double fastest_ = 0.0;  // the fastest speed since since_ns_
  Rate last_{};
  double last_speed_ = 0.0;
  std::int64_t since_ns_ = 0, last_ns_ = 0, compared_ns_ = 0;
  Agreement agreement_ = Agreement::kAgree;  // of the last comparison
  Short short_;
  // The length of the values' path, in steps of at least an age limit, so that noise does not add
  // up. The last step began at step_from_.
  double value_path_ = 0.0;
  Value step_from_{};
  std::int64_t step_ns_ = 0;
};

}  // namespace clearance
