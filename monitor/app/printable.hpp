// Makes text from outside fit for a terminal, and for a log with one line per event.
#pragma once

#include <string>
#include <string_view>

namespace clearance {

// The treatment of line feeds, carriage returns and tabs by printable().
enum class LineBreaks { kEscaped, kKept };

// Writes every byte that could do more than show a character as \xNN: control characters (ASCII and
// C1), Unicode's line separators and bidirectional controls, and bytes that are no UTF-8. All other
// UTF-8 stays. A name from outside (a source, a file, a cell) can thus neither begin a line nor
// command the terminal.
[[nodiscard]] std::string printable(std::string_view text,
                                    LineBreaks breaks = LineBreaks::kEscaped);

}  // namespace clearance
