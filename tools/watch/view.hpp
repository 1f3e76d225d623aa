// What clearance-watch shows: the feed as lines of a screen, as one plain line, and as a summary.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/watch/feed.hpp"
#include "tools/watch/terminal.hpp"

namespace clearance::watch {

// Reports that come no more for this long: the daemon is silent.
inline constexpr std::int64_t kSilentNs = 1'000'000'000;

struct ViewContext {
  std::string where;        // DDS domain and partition
  std::int64_t now_ns = 0;  // CLOCK_REALTIME
  double reports_a_second = 0.0;
};

// At most size.rows lines; the closest pairs fill what room is left.
[[nodiscard]] std::vector<Line> screen_lines(const Feed& feed, const ViewContext& context,
                                             Size size);

// One line without escape sequences.
[[nodiscard]] std::string plain_line(const Feed& feed, const ViewContext& context);

// What was seen over `seconds`; several lines.
[[nodiscard]] std::string final_summary(const Feed& feed, double seconds);

}  // namespace clearance::watch
