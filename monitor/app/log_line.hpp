// Writes lines of log_lines.hpp into the program's log.
#pragma once

#include <string_view>

#include "monitor/app/intervention_log.hpp"
#include "monitor/interface/log_lines.hpp"

namespace clearance {

// False: the log leaves lines of this level out.
[[nodiscard]] bool is_logged(LogLevel level);

// "TEXT [CODE]", or only the text of what has no code. An intervention also goes into its own log,
// whatever its level.
void log_text(LogLevel level, std::string_view text, std::string_view code = "");

template <class... Arguments>
void log_line(const LogLine<Arguments...>& line,
              const std::type_identity_t<Arguments>&... arguments) {
  if (is_logged(line.level) || is_intervention(line.code))
    log_text(line.level, worded(line, arguments...), line.code);
}

}  // namespace clearance
