#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace clearance::test {

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

}  // namespace clearance::test
