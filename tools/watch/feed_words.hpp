// The words of clearance-watch about reports that come, and about those that do not.
#pragma once

#include <cstdint>
#include <string>

#include "tools/watch/feed.hpp"

namespace clearance::watch {

[[nodiscard]] inline double seconds_of(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// The reason why the screen does not show the present state; empty: it does. `now_ns` is
// CLOCK_REALTIME, here and below.
[[nodiscard]] std::string frozen(const Feed& feed, std::int64_t now_ns);
// A present or recent fault of the latest reports themselves; empty: none.
[[nodiscard]] std::string not_fresh(const Feed& feed, std::int64_t now_ns);
// The first of both that is not empty.
[[nodiscard]] std::string trouble(const Feed& feed, std::int64_t now_ns);
// A word for all that places the objects of the cell.
[[nodiscard]] std::string inputs_of(const Feed& feed);
// "oldest input camera": of what is in use, as last told; "oldest input" before that.
[[nodiscard]] std::string oldest_input(const Feed& feed);
// "", or ": poses of hand are late".
[[nodiscard]] std::string cause(const Feed& feed, const clearance_msg_ZoneState& zone);
// Names the shares that a joined cell lacks: "share 'north' is missing, share 'south' is late";
// empty: all are there.
[[nodiscard]] std::string absent_shares(const Feed& feed);
// Before the first report: "waiting for clearanced".
[[nodiscard]] std::string what_it_waits_for(const Feed& feed);

}  // namespace clearance::watch
