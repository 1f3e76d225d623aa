// Table 4.5: how long a pair must be tracked for tracking to pay.
#pragma once

#include <fmt/format.h>

#include <string>

#include "tools/bench/measure.hpp"

namespace clearance::bench {

// Queries between two cold starts, and the sizes of N1 + N2 = 12, 92, 576.
inline constexpr int kIntervals[] = {1, 5, 20, 50, 100};
inline constexpr const char* kIntervalLoads[] = {"f2", "f6", "f15"};

// PREFIXinterval/STEPS/NAME.
template <class Solver>
void register_intervals(const std::string& prefix) {
  for (const char* load : kIntervalLoads) {
    for (const int steps : kIntervals) {
      register_row<Solver>(fmt::format("{}interval/{}/{}", prefix, steps, load), load, steps);
    }
  }
}

}  // namespace clearance::bench
