// Requests to Linux that make the tick thread wake on time. Each returns nothing when it was
// granted, and otherwise a sentence that says what was refused and how to get it.
#pragma once

#include <optional>
#include <string>

namespace clearance {

using Refusal = std::optional<std::string>;

// The calling thread, and threads it makes from now on: timers fire on time instead of up to 50 us
// late.
void use_precise_timers() noexcept;

// The calling thread, and threads it makes from now on. Priority 0: back to ordinary scheduling.
[[nodiscard]] Refusal use_fifo_scheduling(int priority);

// The calling thread runs on this processor only.
[[nodiscard]] Refusal pin_to_cpu(int cpu);

// The whole process: no page fault once it runs.
[[nodiscard]] Refusal lock_memory();

// The calling thread's name in top and gdb, at most 15 characters.
void name_thread(const char* name) noexcept;

}  // namespace clearance
