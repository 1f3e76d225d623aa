// Damages files, for tests of what reads them.
#pragma once

#include <random>
#include <string>

namespace clearance::test {

// `text` after one to four edits: bytes erased, put in, changed, copied elsewhere. Never empty.
[[nodiscard]] std::string mutated(std::string text, std::mt19937& random);

// As mutated(), with edits that formats with counts and indices fear: a whole number that is
// replaced by another, four bytes by an extreme integer or float, and the end cut off.
[[nodiscard]] std::string mutated_numbers(std::string bytes, std::mt19937& random);

}  // namespace clearance::test
