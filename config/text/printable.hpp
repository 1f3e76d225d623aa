// Makes text from outside fit for a terminal, and for a log of one line an event.
#pragma once

#include <string>
#include <string_view>

namespace clearance {

// The treatment of line feeds, carriage returns and tabs by printable().
enum class LineBreaks { kEscaped, kKept };

// Writes every byte that could do something else than show a character as \xNN. These are control
// characters (ASCII and C1), line separators and bidirectional controls of Unicode, and bytes that
// are no UTF-8. All other UTF-8 stays as it is. A name that a stranger chose (of a source, a file,
// a cell) can thus neither begin a new line nor command the terminal.
[[nodiscard]] std::string printable(std::string_view text,
                                    LineBreaks breaks = LineBreaks::kEscaped);

// Returns the printable text of at most the first 300 bytes, for messages that repeat the text of a
// file.
[[nodiscard]] std::string excerpt(std::string_view text);

}  // namespace clearance
