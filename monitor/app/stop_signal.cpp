// Blocks the signals in every thread and waits for them with sigtimedwait. A handler is needed only
// where a program must end at once.
#include "monitor/app/stop_signal.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <ctime>

namespace clearance {
namespace {

// A handler takes no argument of ours, hence these two globals. They are set before it is
// installed.
int status_at_the_end = 0;
const char* words_at_the_end = "";

// True when wait() has taken a signal off the pending ones.
std::atomic<bool> a_signal_came{false};

// False: SIGHUP does not stop the program.
std::atomic<bool> hangup_stops{true};

// Signals whose default is to end a program, and which nothing here sends or expects.
constexpr std::array kMeaningless{SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR};

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

// The time that the last words may wait for their reader.
constexpr int kLastWordsMs = 200;

// This makes async-signal-safe calls only: poll, write and _exit.
extern "C" void end_now(int) {
  pollfd writable{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  if (poll(&writable, 1, kLastWordsMs) <= 0) _exit(status_at_the_end);
  [[maybe_unused]] const auto written =
      write(STDERR_FILENO, words_at_the_end, std::strlen(words_at_the_end));
  _exit(status_at_the_end);
}

}  // namespace

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (!is_ignored(SIGHUP)) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  // The reader of our output may leave first, and a file may get too large: then a write fails, and
  // nothing else happens.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : kMeaningless) std::signal(signal, SIG_IGN);
}

void StopSignal::keep_running_on_hangup() noexcept { hangup_stops = false; }

// A signal that is pending is delivered when the mask is restored.
void StopSignal::end_with(int status, const char* last_words) {
  status_at_the_end = status;
  words_at_the_end = last_words;
  std::signal(SIGINT, end_now);
  std::signal(SIGTERM, end_now);
  if (sigismember(&signals_, SIGHUP) == 1) std::signal(SIGHUP, end_now);
  std::signal(SIGPIPE, SIG_DFL);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

// A timeout of 0 polls.
bool StopSignal::wait(std::int64_t timeout_ms) {
  const timespec timeout{.tv_sec = timeout_ms / 1000, .tv_nsec = timeout_ms % 1000 * 1'000'000};
  if (!came_) {
    const int signal = sigtimedwait(&signals_, nullptr, &timeout);
    hung_up_ = hung_up_ || (signal == SIGHUP && !hangup_stops);
    came_ = signal > 0 && (signal != SIGHUP || hangup_stops);
  }
  if (came_) a_signal_came = true;
  return came_;
}

bool stop_is_asked_for() noexcept {
  sigset_t pending;
  sigpending(&pending);
  const auto is_pending = [&](int signal) { return sigismember(&pending, signal) == 1; };
  return a_signal_came || is_pending(SIGINT) || is_pending(SIGTERM) ||
         (hangup_stops && is_pending(SIGHUP));
}

}  // namespace clearance
