// Damages files, for tests of their readers.
#pragma once

#include <random>
#include <string>

namespace clearance::test {

// Returns `text` after one to four edits: bytes erased, inserted, changed, or copied elsewhere. The
// result is never empty.
[[nodiscard]] std::string mutated(std::string text, std::mt19937& random);

// Returns a text as mutated() does, with additional edits that are dangerous for formats with
// counts and indices. An integer is replaced by another, four bytes are replaced by an extreme
// integer or float, or the end is cut off.
[[nodiscard]] std::string mutated_numbers(std::string bytes, std::mt19937& random);

}  // namespace clearance::test
