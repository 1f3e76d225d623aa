// One kind of log line: its code, level and wording. log_lines.hpp holds all of them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "config/text/sentences.hpp"

namespace clearance {

enum class LogLevel : std::uint8_t { kInfo, kWarn, kError };

// The code stands at the end of every line, "... are late [poses-late]": programs and tests look
// for it, so that the wording may change. `Arguments` are the types of what `text` names.
template <class... Arguments>
struct LogLine {
  std::string_view code;
  LogLevel level;
  fmt::format_string<Arguments...> text;
};

// The sentence, without the code.
template <class... Arguments>
[[nodiscard]] std::string worded(const LogLine<Arguments...>& line,
                                 const std::type_identity_t<Arguments>&... arguments) {
  const fmt::string_view text = line.text;
  return fmt::vformat(text, fmt::make_format_args(arguments...));
}

// "1 batch", "2 batches"; a plural in -s is made by counted() of config/text.
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one,
                                         std::string_view more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

}  // namespace clearance
