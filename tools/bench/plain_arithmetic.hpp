// Measures the noise of the machine by a fixed number of multiplications in registers. They always
// take the same time unless something else (the host, interrupts) interferes.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>

#include "tools/bench/clocks.hpp"

namespace clearance::bench {

class PlainArithmetic {
 public:
  // A number of multiplications that takes `ns` when nothing disturbs it.
  explicit PlainArithmetic(double ns) {
    double least = 1e9;
    for (int i = 0; i < 50; ++i) least = std::min(least, time());
    rounds_ = static_cast<int>(ns / least * kSample);
  }

  // Runs them once more and returns the time, ns.
  double time() {
    const double start = wall_ns();
    for (int i = 0; i < rounds_; ++i) value_ = value_ * 0.999 + 1.0;
    benchmark::DoNotOptimize(value_);
    return std::max(0.0, wall_ns() - start - clock_cost_);
  }

 private:
  static constexpr int kSample = 2'000;

  const double clock_cost_ = cost_of(wall_ns);
  double value_ = 0.0;
  int rounds_ = kSample;
};

}  // namespace clearance::bench
