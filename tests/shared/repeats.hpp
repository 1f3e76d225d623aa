// How often a test repeats its random cases.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace clearance {

// All of them in tools/check --all, which sets CLEARANCE_ALL_REPEATS; otherwise the first quarter,
// or another share, at least one. The first cases are the same in both.
[[nodiscard]] inline std::uint64_t repeats(std::uint64_t all, std::uint64_t share = 4) {
  static const bool is_all = std::getenv("CLEARANCE_ALL_REPEATS") != nullptr;
  return is_all ? all : std::max<std::uint64_t>(all / share, 1);
}

}  // namespace clearance
