// Numbers that tell one build of a cloud from all others.
#pragma once

#include <atomic>
#include <cstdint>

namespace clearance {

// A number that no other call in this process returns, and never 0. Only its equality has a
// meaning, so results do not depend on the order of calls.
[[nodiscard]] inline std::uint64_t next_revision() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace clearance
