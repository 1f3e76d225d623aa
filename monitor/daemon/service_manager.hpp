// Tells a service manager (systemd, or any other that sets NOTIFY_SOCKET) about the daemon.
#pragma once

#include <cstdint>
#include <string>

namespace clearance {

// Sends the messages of sd_notify(3). Without a service manager nothing is sent, and no call fails.
// notice() has one caller at a time; the others may be called by any thread.
class ServiceManager {
 public:
  // Reads NOTIFY_SOCKET and WATCHDOG_USEC. `title` is the start of every status line.
  explicit ServiceManager(std::string title);

  // `published` is the cycle of the last report that was published, 0 before the first one. Call it
  // several times a second. The first report makes the service ready. After that, the watchdog is
  // fed only if a later cycle was published since it was last fed.
  void notice(std::uint64_t published);

  // A reload begins. It ends with reloaded(), whose text says what came of it.
  void reloading() const;
  void reloaded(const std::string& outcome) const;

  void stopping() const;

 private:
  void send(const std::string& state) const;

  std::string title_;
  std::uint64_t watchdog_us_ = 0;  // 0: no watchdog
  std::uint64_t fed_us_ = 0;       // time when the watchdog was fed last, CLOCK_MONOTONIC
  std::uint64_t fed_cycle_ = 0;    // 0: not ready yet
};

}  // namespace clearance
