// The log of a program: spdlog's asynchronous logger, to stderr. A thread that logs never waits for
// the reader of the log.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "monitor/interface/log_line.hpp"

namespace clearance {

// `level`: trace, debug, info, warn, error or off. `name` stands in every line after the time.
//
// A line waits in a bounded queue until the log's own thread has written it. While stderr takes
// nothing (a full pipe, a stopped terminal), each new line displaces the oldest one in the queue. A
// line in their place says how many are missing. Each event is one line: its text is made printable
// (config/text/printable.hpp). At its end, the program waits at most kLogPatience for the queue.
void start_log(const std::string& name, const std::string& level);

inline constexpr std::chrono::milliseconds kLogPatience{200};

// Waits until the lines logged so far are written, at most kLogPatience. Messages and summaries,
// which do not pass through the queue, call it first.
void drain_log();

struct LoggedLine {
  std::int64_t time_ns = 0;  // since 1970
  LogLevel level = LogLevel::kInfo;
  std::string text;  // with its code
};

// Keeps the newest `most` lines from now on, for whoever passes them on. Any thread.
void keep_lines(std::size_t most);
// The lines that were kept since the last call, oldest first.
[[nodiscard]] std::vector<LoggedLine> kept_lines();
// The name that start_log() got; before that, "clearance".
[[nodiscard]] std::string log_name();

}  // namespace clearance
