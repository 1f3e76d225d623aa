// One kind of log line: its code, level and wording. log_lines.hpp holds all of them.
#pragma once

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "config/text/sentences.hpp"

namespace clearance {

// The code stands at the end of every line, "... are late [poses-late]": programs and tests look
// for it, so that the wording may change. `Arguments` are the types of what `text` names.
template <class... Arguments>
struct LogLine {
  std::string_view code;
  spdlog::level::level_enum level;
  fmt::format_string<Arguments...> text;
};

template <class... Arguments>
[[nodiscard]] std::string rendered(const LogLine<Arguments...>& line,
                                   const std::type_identity_t<Arguments>&... arguments) {
  const fmt::string_view text = line.text;
  return fmt::format("{} [{}]", fmt::vformat(text, fmt::make_format_args(arguments...)), line.code);
}

// Logs this line unless its level is below that of the log.
template <class... Arguments>
void log_line(const LogLine<Arguments...>& line,
              const std::type_identity_t<Arguments>&... arguments) {
  if (!spdlog::should_log(line.level)) return;
  const std::string text = rendered(line, arguments...);
  spdlog::default_logger_raw()->log(line.level, std::string_view(text));
}

// "1 batch", "2 batches"; a plural in -s is made by counted() of config/text.
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one,
                                         std::string_view more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

}  // namespace clearance
