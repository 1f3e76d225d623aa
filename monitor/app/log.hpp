// The log of a program: spdlog, to stderr, by a thread of its own. Nothing that logs ever waits for
// whoever reads the log.
#pragma once

#include <chrono>
#include <string>

namespace clearance {

// `level`: trace, debug, info, warn, error or off. `name` starts every line after the time.
//
// A line waits in a bounded queue (log_queue.hpp) until it is written; when stderr takes nothing
// (a pipe that is full, a terminal that is stopped), lines that find the queue full are left out,
// and where they are missing a line says how many. Each line is one line of text: what it says is
// made printable (printable.hpp). At the end, the program waits at most kLogPatience for lines that
// are still to be written.
void start_log(const std::string& name, const std::string& level);

inline constexpr std::chrono::milliseconds kLogPatience{200};

// Waits until what was logged so far is written, at most kLogPatience. For what follows on another
// way: messages and summaries.
void drain_log();

}  // namespace clearance
