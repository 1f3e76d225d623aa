// Suggestions for misspelt names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace clearance {

// Counts the insertions, deletions, substitutions and swaps of neighbours that turn one word into
// the other. Case does not count, nor does '-' against '_'.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns "; did you mean 'radius'?" when one of `known` is near enough (a third of the letters),
// else "".
[[nodiscard]] std::string did_you_mean(std::string_view found, std::span<const std::string> known);

}  // namespace clearance
