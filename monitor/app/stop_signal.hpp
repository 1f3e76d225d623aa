// Collects SIGINT, SIGTERM and SIGHUP, so that the program can wait for them in one place. Signals
// that mean nothing to a program, such as SIGUSR1 and SIGALRM, are ignored.
#pragma once

#include <csignal>
#include <cstdint>
#include <utility>

namespace clearance {

// Blocks these signals in all threads, so it is made before any other thread. Until it is made, a
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

  // After this call SIGHUP does not stop the program: hung_up() tells of it instead. Without the
  // call it stops the program like SIGTERM, since a closed terminal sends it. A program that was
  // started with SIGHUP ignored (nohup) does not hear it at all.
  void keep_running_on_hangup() noexcept;

  // Waits for a signal up to the given time. Returns true when one that stops has come, now or
  // before. After a SIGHUP that does not stop, it returns early.
  bool wait(std::int64_t timeout_ms);

  // Returns true once after each SIGHUP that did not stop the program.
  [[nodiscard]] bool hung_up() noexcept { return std::exchange(hung_up_, false); }

 private:
  sigset_t signals_, before_;
  bool came_ = false, hung_up_ = false;
};

// Returns true when a signal that stops has come, whether or not wait() was called since.
[[nodiscard]] bool stop_is_asked_for() noexcept;

}  // namespace clearance
