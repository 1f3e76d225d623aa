// What assimp does not check of a COLLADA file before it reads with it.
#pragma once

#include <string>

namespace clearance {

// Every <accessor> stays inside its array, with offset + (count - 1) * stride + params numbers; and
// lists of indices hold whole numbers only. The end of a sentence with the line of the first that
// does not; empty where all do.
[[nodiscard]] std::string fault_of_collada(const std::string& xml);

}  // namespace clearance
