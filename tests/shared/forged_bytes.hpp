// Changes bytes of a partner as a stranger may: their length stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance::test {

// These are a NaN, all bits set, -1, infinities, 1e300, the largest integers, a sign bit, and small
// integers.
inline constexpr std::uint64_t kHostile[] = {0x7ff8'0000'0000'0000,
                                             ~std::uint64_t{0},
                                             0xbff0'0000'0000'0000,
                                             0x7ff0'0000'0000'0000,
                                             0xfff0'0000'0000'0000,
                                             0x7e37'e43c'8800'759c,
                                             0x7fff'ffff'ffff'ffff,
                                             0x7fff'ffff,
                                             0x8000'0000'0000'0000,
                                             0,
                                             1,
                                             2};

// Overwrites one to three places, most of them aligned. `genuine` has more than eight bytes.
[[nodiscard]] inline std::vector<std::byte> forged(std::vector<std::byte> genuine, Random& random) {
  for (int changes = random.integer(1, 3); changes > 0; --changes) {
    const std::uint64_t value =
        random.chance(0.5) ? random.next() : kHostile[random.next() % std::size(kHostile)];
    const std::size_t width = random.chance(0.4) ? 1 : random.chance(0.5) ? 4 : 8;
    const std::size_t at = random.next() % (genuine.size() - width);
    std::memcpy(genuine.data() + at - (random.chance(0.8) ? at % width : 0), &value, width);
  }
  return genuine;
}

}  // namespace clearance::test
