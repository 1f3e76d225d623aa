// Checks of a COLLADA file that assimp leaves out.
#pragma once

#include <string>

namespace clearance {

// Checks that every <accessor> stays inside its array: it covers offset + (count - 1) * stride +
// params numbers. Checks also that lists of indices hold whole numbers only, and that nothing that
// places or shapes a surface is left out by assimp. Returns the end of a sentence with the line of
// the first fault; empty: there is none.
[[nodiscard]] std::string fault_of_collada(const std::string& xml);

}  // namespace clearance
