// What this thread has computed so far: other programs do not count.
#pragma once

#include <time.h>

namespace clearance::bench {

inline double cpu_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

}  // namespace clearance::bench
