#include "monitor/daemon/stop_signal.hpp"

#include <pthread.h>

#include <ctime>

namespace clearance {

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  // Whoever reads our output may leave first: then a write fails, that is all.
  std::signal(SIGPIPE, SIG_IGN);
}

void StopSignal::release() {
  std::signal(SIGPIPE, SIG_DFL);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool StopSignal::wait(std::int64_t timeout_ms) {
  const timespec timeout{.tv_sec = timeout_ms / 1000, .tv_nsec = timeout_ms % 1000 * 1'000'000};
  if (!came_) came_ = sigtimedwait(&signals_, nullptr, &timeout) > 0;
  return came_;
}

}  // namespace clearance
