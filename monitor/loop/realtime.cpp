// Each function makes one system call. A refusal is no error: the daemon works without the
// privilege, with later wake-ups.
#include "monitor/loop/realtime.hpp"

#include <fmt/format.h>

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace clearance {

// The timer slack in ns: 1 is the least; 0 would reset it to the default of 50 us.
void use_precise_timers() noexcept { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

// SCHED_FIFO threads run until they sleep; SCHED_OTHER has only priority 0.
Refusal use_fifo_scheduling(int priority, pthread_t thread) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int policy = priority > 0 ? SCHED_FIFO : SCHED_OTHER;
  const int error = pthread_setschedparam(thread, policy, &parameters);
  if (error == 0) return std::nullopt;
  return fmt::format(
      "SCHED_FIFO priority {} was refused ({}): ticks may wake late. Run as root, give the binary "
      "CAP_SYS_NICE, or raise the rtprio limit (ulimit -r)",
      priority, std::strerror(error));
}

// The kernel refuses an empty set, so a number out of range needs no check here.
Refusal pin_to_cpu(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(cpu, &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  if (error == 0) return std::nullopt;
  return fmt::format(
      "processor {} cannot be used ({}): the tick thread is not pinned. `taskset -p $$` shows "
      "which processors are allowed",
      cpu, std::strerror(error));
}

Refusal lock_memory() {
  // With a limit on locked memory, MCL_FUTURE would make later allocations fail, so only the
  // present pages are locked.
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool unlimited = geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY;
  if (mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0) return std::nullopt;
  return fmt::format(
      "locking memory was refused ({}): a page fault may delay a tick. Run as root, give the "
      "binary CAP_IPC_LOCK, or raise the memlock limit (ulimit -l)",
      std::strerror(errno));
}

// The nice value is that of a thread in Linux. Nice 10 has a weight of 110 beside 1024.
void lower_priority() noexcept { (void)setpriority(PRIO_PROCESS, 0, 10); }

void name_thread(const char* name) noexcept { pthread_setname_np(pthread_self(), name); }

}  // namespace clearance
