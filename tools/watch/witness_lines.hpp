// Lines of clearance-watch about the sensors that are witnesses of robots (`witness:`).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/watch/feed.hpp"
#include "tools/watch/terminal.hpp"

namespace clearance::watch {

// One text for each witness and robot, as the last health has them. Empty if there is no witness.
[[nodiscard]] std::vector<std::string> witness_texts(const Feed& feed);

// The same as lines of the screen; a robot that is not where its joints say stands out.
void add_witnesses(std::vector<Line>& lines, const Feed& feed, std::size_t width);

}  // namespace clearance::watch
