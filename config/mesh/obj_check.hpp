// Checks of an OBJ file that assimp leaves out.
#pragma once

#include <string>

namespace clearance {

// Checks that each line begins with a word that assimp reads, or that is no part of the surface.
// Assimp skips all others: free-form surfaces, files that are called, and misspelt faces. Returns
// the end of a sentence with the line of the first fault; empty: there is none.
[[nodiscard]] std::string fault_of_obj(const std::string& text);

}  // namespace clearance
