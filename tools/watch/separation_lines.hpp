// Lines of clearance-watch about the zones that keep a robot from people (`separation:` of a cell).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/watch/feed.hpp"
#include "tools/watch/terminal.hpp"

namespace clearance::watch {

// One text per zone: "people: scaling 0.43, robot up to 0.51 m/s, 0.120 m above S_p, person -
// hand". Empty if no zone has `separation`, or if no such message has come yet.
[[nodiscard]] std::vector<std::string> separation_texts(const Feed& feed);

// The same as lines of the screen; a robot that has to slow down stands out.
void add_separation(std::vector<Line>& lines, const Feed& feed, std::size_t width);

}  // namespace clearance::watch
