// Checks of a COLLADA file that assimp leaves out.
#pragma once

#include <string>

namespace clearance {

// Checks that every <accessor> stays inside its array, with offset + (count - 1) * stride + params
// numbers, and that lists of indices hold whole numbers only. Returns the end of a sentence with
// the line of the first that does not; empty: all do.
[[nodiscard]] std::string fault_of_collada(const std::string& xml);

}  // namespace clearance
