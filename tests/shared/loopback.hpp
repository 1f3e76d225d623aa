// DDS for tests: on the loopback interface, and separated from every other test run on this
// machine.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "monitor/participant/participant.hpp"

namespace clearance::test {

// Returns a new domain and a new partition at every call. Domains repeat, because there are few;
// partitions do not. Domains below 100 avoid the ports that the kernel assigns.
[[nodiscard]] inline DdsOptions own_dds() {
  static std::atomic<int> calls{0};
  const auto pid = static_cast<std::uint32_t>(getpid());
  DdsOptions dds;
  dds.domain = 1 + pid % 99;
  dds.interface = "lo";
  dds.partition = "test-" + std::to_string(pid) + "-" + std::to_string(++calls);
  return dds;
}

// Waits until a condition is true. Returns false after a time that only a broken program exceeds.
[[nodiscard]] inline bool eventually(const std::function<bool()>& is_so,
                                     std::chrono::seconds limit = std::chrono::seconds(60)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

[[nodiscard]] inline std::uint32_t matched_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return status.current_count;
}

[[nodiscard]] inline std::uint32_t matched_writers(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return status.current_count;
}

}  // namespace clearance::test
