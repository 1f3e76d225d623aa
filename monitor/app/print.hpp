// Formatted text for a person, on stdout or stderr.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace clearance {

// The time that a text may wait for its reader.
enum class Patience {
  kUntilStopped,  // results: until a signal asks the program to stop, then briefly
  kBrief,         // messages, and the summary at the end of a run: half a second at most
};

// Writes the text after the lines logged before. It is made printable except for its line breaks
// (printable.hpp). A failed write is no error, since the reader may leave first. Text that the
// reader does not take in time is lost.
void write_text(std::FILE* file, std::string_view text, Patience patience);

// Works like fmt::print. Results on stdout wait for their reader; messages on stderr wait briefly.
template <class... Arguments>
void print(std::FILE* file, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_text(file, fmt::format(format, std::forward<Arguments>(arguments)...),
             file == stderr ? Patience::kBrief : Patience::kUntilStopped);
}

}  // namespace clearance
