// News about the inputs for a person, each told once: a line of the log that is not written yet.
#pragma once

#include <string>
#include <string_view>

#include "monitor/interface/log_lines.hpp"

namespace clearance {

struct News {
  template <class... Arguments>
  explicit News(const LogLine<Arguments...>& line,
                const std::type_identity_t<Arguments>&... arguments)
      : code(line.code), level(line.level), text(worded(line, arguments...)) {}

  std::string_view code;
  LogLevel level;
  std::string text;
};

// "'arm'", or "(no name)" for an empty name.
[[nodiscard]] inline std::string quoted(std::string_view name) {
  return name.empty() ? "(no name)" : fmt::format("'{}'", name);
}

}  // namespace clearance
