// The smallest octomap that has something.
#pragma once

#include <array>
#include <string>

namespace clearance::test {

// A binary tree with one occupied leaf at these numbers of cubes from the middle, each 0 or more:
// the child 7 of the root, and so on. `levels`: fewer than 16 give a larger cube that begins there.
inline std::string one_cube(std::array<unsigned, 3> at, int levels = 16) {
  std::string bytes;
  for (int depth = 1; depth <= levels; ++depth) {
    unsigned child = 0;
    for (unsigned k = 0; k < 3; ++k) child |= ((at[k] + 32768U) >> (16 - depth) & 1U) << k;
    const unsigned two_bits = (depth == levels ? 2U : 3U) << 2 * child;
    bytes += static_cast<char>(two_bits & 0xFF);
    bytes += static_cast<char>(two_bits >> 8);
  }
  return bytes;
}

}  // namespace clearance::test
