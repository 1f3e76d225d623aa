// Lists of words in one text, separated by blanks, as tables of formats have them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace clearance {

[[nodiscard]] bool has_word(std::string_view words, std::string_view word);
[[nodiscard]] std::vector<std::string> words_of(std::string_view words);

}  // namespace clearance
