// SIGINT and SIGTERM as something to wait for, in one place of the program.
#pragma once

#include <csignal>
#include <cstdint>

namespace clearance {

// Made before any other thread: blocks both signals in all of them.
class StopSignal {
 public:
  StopSignal();
  // True: a signal has come, now or before. Waits for one up to the given time.
  bool wait(std::int64_t timeout_ms);

 private:
  sigset_t signals_;
  bool came_ = false;
};

}  // namespace clearance
