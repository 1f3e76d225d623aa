// Collects SIGINT and SIGTERM, so that the program can wait for them in one place.
#pragma once

#include <csignal>
#include <cstdint>

namespace clearance {

// Blocks both signals in all threads, so it is made before any other thread. Until it is made, a
// signal ends the program in the system's default manner.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // For work that may stop anywhere. After this call a signal writes `last_words` to stderr and
  // ends the program with `status`. This includes a signal that has already come. `last_words` must
  // stay valid.
  void end_with(int status, const char* last_words);

  // Waits for a signal up to the given time. Returns true when one has come, now or before.
  bool wait(std::int64_t timeout_ms);

 private:
  sigset_t signals_, before_;
  bool came_ = false;
};

// Returns true when SIGINT or SIGTERM has come, whether or not wait() was called since.
[[nodiscard]] bool stop_is_asked_for() noexcept;

}  // namespace clearance
