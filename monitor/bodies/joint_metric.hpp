// The distance of two positions of a joint, rad or m, as the metric of Plausibility.
#pragma once

#include <cmath>

#include "monitor/inputs/plausibility.hpp"

namespace clearance {

class JointMetric {
 public:
  using Value = double;
  using Rate = double;

  // `wraps`: positions that differ by full turns are the same.
  explicit JointMetric(bool wraps) noexcept : wraps_(wraps) {}

  // Returns to - from, by the shorter turn if positions wrap.
  [[nodiscard]] double difference(double from, double to) const noexcept {
    constexpr double kTurn = 6.283185307179586;
    const double difference = to - from;
    if (!wraps_ || std::abs(difference) <= 0.5 * kTurn) return difference;
    return difference - kTurn * std::nearbyint(difference / kTurn);
  }
  [[nodiscard]] bool stay_within(double limit, double from, double to) const noexcept {
    return std::abs(difference(from, to)) <= limit;
  }
  [[nodiscard]] static double length(double rate) noexcept { return std::abs(rate); }
  [[nodiscard]] static double scaled_sum(double factor, double a, double b) noexcept {
    return factor * (a + b);
  }
  [[nodiscard]] static double moved(double position, double step) noexcept {
    return position + step;
  }

  [[nodiscard]] double distance(double from, double to) const noexcept {
    return std::abs(difference(from, to));
  }
  static constexpr bool kRatesMayBeWrong = true;

 private:
  bool wraps_;
};

}  // namespace clearance
