// Requests to Linux that make the tick thread wake on time. Each returns nothing when it was
// granted, else a text that says what was refused and how to get it.
#pragma once

#include <pthread.h>

#include <optional>
#include <string>

namespace clearance {

using Refusal = std::optional<std::string>;

// For the calling thread and the threads that it makes from now on: timers fire on time instead of
// up to 50 us late.
void use_precise_timers() noexcept;

// For this thread and the threads that it makes from now on. Priority 0 restores ordinary
// scheduling.
[[nodiscard]] Refusal use_fifo_scheduling(int priority, pthread_t thread = pthread_self());

// The calling thread then runs on this processor only.
[[nodiscard]] Refusal pin_to_cpu(int cpu);

// Keeps the memory of the process in place, so that no page fault delays a tick.
[[nodiscard]] Refusal lock_memory();

// The calling thread then yields to the threads with ordinary scheduling: Linux gives it a tenth
// of their share of a processor that is busy.
void lower_priority() noexcept;

// Sets the calling thread's name in top and gdb, at most 15 characters.
void name_thread(const char* name) noexcept;

}  // namespace clearance
