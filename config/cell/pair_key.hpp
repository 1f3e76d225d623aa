// Two objects in one number.
#pragma once

#include <cstdint>

namespace clearance {

// The smaller index first: the order of keys is the order of pairs in the scene.
using PairKey = std::uint64_t;

// The arguments may stand in either order.
[[nodiscard]] inline PairKey pair_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? PairKey{a} << 32 | b : PairKey{b} << 32 | a;
}
[[nodiscard]] inline std::uint32_t first_of(PairKey key) {
  return static_cast<std::uint32_t>(key >> 32);
}
[[nodiscard]] inline std::uint32_t second_of(PairKey key) {
  return static_cast<std::uint32_t>(key);
}

}  // namespace clearance
