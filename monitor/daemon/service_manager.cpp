// libsystemd finds the socket and sends the datagrams. It ignores an absent socket.
#include "monitor/daemon/service_manager.hpp"

#include <systemd/sd-daemon.h>

#include <ctime>
#include <utility>

namespace clearance {
namespace {

// The watchdog is fed this many times in its interval.
constexpr std::uint64_t kFeedsAnInterval = 4;

std::uint64_t monotonic_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000 +
         static_cast<std::uint64_t>(now.tv_nsec) / 1'000;
}

// A line break would begin another variable of the message.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

}  // namespace

ServiceManager::ServiceManager(std::string title) : title_(one_line(std::move(title))) {
  if (sd_watchdog_enabled(0, &watchdog_us_) <= 0) watchdog_us_ = 0;
}

void ServiceManager::notice(std::uint64_t published) {
  if (published == fed_cycle_) return;
  const std::uint64_t now = monotonic_us();
  if (fed_cycle_ == 0) {
    send("READY=1\nSTATUS=" + title_);
  } else if (watchdog_us_ == 0 || now - fed_us_ < watchdog_us_ / kFeedsAnInterval) {
    return;
  }
  if (watchdog_us_ != 0) send("WATCHDOG=1");
  fed_us_ = now;
  fed_cycle_ = published;
}

void ServiceManager::reloading() const {
  send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(monotonic_us()));
}

void ServiceManager::reloaded(const std::string& outcome) const {
  send("READY=1\nSTATUS=" + title_ + "; " + one_line(outcome));
}

void ServiceManager::stopping() const { send("STOPPING=1"); }

void ServiceManager::send(const std::string& state) const { sd_notify(0, state.c_str()); }

}  // namespace clearance
