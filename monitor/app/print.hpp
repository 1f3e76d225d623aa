// Formatted text for a person, on stdout or stderr.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace clearance {

// As fmt::print, except that a failed write is no error: whoever reads the output may leave first.
template <class... Arguments>
void print(std::FILE* file, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
  std::fwrite(text.data(), 1, text.size(), file);
}

}  // namespace clearance
