// The two clocks of the benchmark.
#pragma once

#include <time.h>

#include <algorithm>
#include <array>

namespace clearance::bench {

inline double ns_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

// CPU time of this thread, which excludes other programs.
inline double cpu_ns() { return ns_of(CLOCK_THREAD_CPUTIME_ID); }

// Wall-clock time, which includes whatever else the machine does.
inline double wall_ns() { return ns_of(CLOCK_MONOTONIC); }

// The cost of reading a clock, which is part of every difference of two readings. It is 0.02 us for
// the wall clock. It is 0.2 to 0.8 us for the thread's time, which takes a system call.
template <class Clock>
double cost_of(const Clock& clock) {
  std::array<double, 1001> costs;
  for (double& cost : costs) {
    const double start = clock();
    cost = clock() - start;
  }
  std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
  return costs[costs.size() / 2];
}

}  // namespace clearance::bench
