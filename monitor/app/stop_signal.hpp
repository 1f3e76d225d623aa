// Lets one place of the program wait for SIGINT and SIGTERM.
#pragma once

#include <csignal>
#include <cstdint>

namespace clearance {

// Made before any other thread: blocks both signals in all of them. The sooner it is made, the
// shorter is the time in which they end the program in the system's way.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // For work that nobody has to end in order: a signal, also one that has come already, says
  // `last_words` on stderr and ends the program with `status`. The words must stay.
  void end_with(int status, const char* last_words);

  // True: a signal has come, now or before. Waits for one up to the given time.
  bool wait(std::int64_t timeout_ms);

 private:
  sigset_t signals_, before_;
  bool came_ = false;
};

// True: SIGINT or SIGTERM has come, whether or not wait() has been asked since.
[[nodiscard]] bool stop_is_asked_for() noexcept;

}  // namespace clearance
