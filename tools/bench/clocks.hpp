// The two clocks that things are timed by.
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

// What this thread has computed so far: other programs do not count.
inline double cpu_ns() { return ns_of(CLOCK_THREAD_CPUTIME_ID); }

// The time on the wall, which is what somebody waits for: whatever else the machine does counts.
inline double wall_ns() { return ns_of(CLOCK_MONOTONIC); }

// What reading a clock costs, which is in every difference of two readings: 0.02 us on the wall;
// for the thread's time the kernel is asked, 0.2 to 0.8 us.
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
