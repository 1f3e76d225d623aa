// Lines of clearance-watch about the contacts that a cell allows (`contacts:`).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/watch/feed.hpp"
#include "tools/watch/terminal.hpp"

namespace clearance::watch {

// One text for each pair of a contact, contact_text() and the pair. Empty if the cell allows none.
[[nodiscard]] std::vector<std::string> contact_texts(const Feed& feed);

// The same as lines of the screen; a contact that is not as allowed stands out.
void add_contacts(std::vector<Line>& lines, const Feed& feed, std::size_t width);

}  // namespace clearance::watch
