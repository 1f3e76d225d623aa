// A log whose lines hold the hash of the line before, so that none can be changed, removed,
// inserted or moved unnoticed.
//
// Each line is an object of JSON:
//   {"number":7,"time":"2026-11-28T10:45:12.003512Z","before":"HASH","kind":"stop",...,"hash":"HASH"}
// `hash` is the SHA-256 of the line up to the comma in front of it, and `before` the hash of the
// line before: 64 zeros in the first one. Whoever writes all lines anew can forge the log. A hash
// that is kept elsewhere shows it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace clearance {

// The place where a log goes on: its last line.
struct ChainEnd {
  std::uint64_t number = 0;  // 0: no line yet
  std::string hash = std::string(64, '0');
};

// Returns the line after `end`, with its line break, and moves `end` to it. `fields`: members of
// JSON, such as "ticks":7,"cause":"a signal"; may be empty.
[[nodiscard]] std::string next_line(ChainEnd& end, std::int64_t time_ns, std::string_view kind,
                                    std::string_view fields);

struct ChainedLine {
  std::uint64_t number = 0;
  std::string_view time, before, kind, hash;
  std::string_view fields;  // as in next_line()
};

struct ChainedLog {
  std::string error;  // why the file cannot be read; empty: it was
  ChainEnd end;       // the last line that has the hash of its own content
  std::string kind;   // of that line
  std::string fault;  // names the first line that is not as it was written; empty: all are
  std::string torn;   // what stands behind the last line break
};

// Reads and judges a log. `visit` gets each line that has the hash of its own content, in order;
// may be empty.
[[nodiscard]] ChainedLog read_chained_log(
    const std::filesystem::path& file, const std::function<void(const ChainedLine&)>& visit = {});

}  // namespace clearance
