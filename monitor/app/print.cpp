// Writes at most PIPE_BUF bytes at a time: a pipe or terminal that is ready takes so many without
// waiting.
#include "monitor/app/print.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <string>

#include "config/text/printable.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/stop_signal.hpp"

namespace clearance {
namespace {

constexpr int kSliceMs = 50, kBriefMs = 500;

// A reader that has kept one message waiting cannot keep the next ones waiting.
std::atomic<bool> keeps_waiting{false};

// Returns false when the time is over and the reader still takes nothing.
bool wait_for_room(int descriptor, Patience patience) {
  const int most = keeps_waiting ? 0 : kBriefMs;
  for (int waited = 0;;) {
    const bool hurried = patience == Patience::kBrief || stop_is_asked_for();
    const int slice = hurried ? std::clamp(most - waited, 0, kSliceMs) : kSliceMs;
    pollfd writable{.fd = descriptor, .events = POLLOUT, .revents = 0};
    if (::poll(&writable, 1, slice) > 0) return true;
    waited += slice;
    if (hurried && waited >= most) return false;
  }
}

}  // namespace

void write_text(std::FILE* file, std::string_view text, Patience patience) {
  drain_log();
  std::fflush(file);
  const std::string shown = printable(text, LineBreaks::kKept);
  const int descriptor = ::fileno(file);
  for (std::size_t at = 0; at < shown.size();) {
    if (!wait_for_room(descriptor, patience)) {
      keeps_waiting = true;
      return;
    }
    const ssize_t written =
        ::write(descriptor, shown.data() + at, std::min<std::size_t>(shown.size() - at, PIPE_BUF));
    if (written >= 0) {
      at += static_cast<std::size_t>(written);
      keeps_waiting = false;
    } else if (errno != EINTR && errno != EAGAIN) {
      return;
    }
  }
}

}  // namespace clearance
