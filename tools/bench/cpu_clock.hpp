// What this thread has computed so far: other programs do not count.
#pragma once

#include <time.h>

#include <algorithm>
#include <array>

namespace clearance::bench {

inline double cpu_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

// What reading it costs, which is in every difference of two readings: the kernel is asked, 0.2 to
// 0.8 us.
inline double cpu_clock_cost() {
  std::array<double, 1001> costs;
  for (double& cost : costs) {
    const double start = cpu_ns();
    cost = cpu_ns() - start;
  }
  std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
  return costs[costs.size() / 2];
}

}  // namespace clearance::bench
