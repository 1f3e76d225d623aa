// Formatted text for a person, on stdout or stderr.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace clearance {

// How long a text may wait for its reader.
enum class Patience {
  kUntilStopped,  // as long as no signal asks the program to stop, then briefly: results
  kBrief,         // half a second at most: messages, and the summary at the end of a run
};

// Writes the text after what was logged before, made printable but for its line breaks
// (printable.hpp). A failed write is no error: whoever reads the output may leave first. What the
// reader does not take in time is lost.
void write_text(std::FILE* file, std::string_view text, Patience patience);

// As fmt::print. Results, on stdout, wait for their reader; messages, on stderr, only briefly.
template <class... Arguments>
void print(std::FILE* file, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_text(file, fmt::format(format, std::forward<Arguments>(arguments)...),
             file == stderr ? Patience::kBrief : Patience::kUntilStopped);
}

}  // namespace clearance
