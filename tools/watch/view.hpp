// Formats the feed for clearance-watch: as lines of a screen, as one plain line, and as a summary.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/watch/feed.hpp"
#include "tools/watch/terminal.hpp"

namespace clearance::watch {

struct ViewContext {
  std::string where;        // DDS domain and partition
  std::int64_t now_ns = 0;  // CLOCK_REALTIME
  double reports_a_second = 0.0;
  PartnerCounts partner_counts = {};  // since the last plain line
};

// At most size.rows lines; the closest pairs fill the remaining lines.
[[nodiscard]] std::vector<Line> screen_lines(const Feed& feed, const ViewContext& context,
                                             Size size);

// One line without escape sequences.
[[nodiscard]] std::string plain_line(const Feed& feed, const ViewContext& context);

// Several lines about what was received in `seconds`; `now_ns` is CLOCK_REALTIME.
[[nodiscard]] std::string final_summary(const Feed& feed, double seconds, std::int64_t now_ns);

}  // namespace clearance::watch
