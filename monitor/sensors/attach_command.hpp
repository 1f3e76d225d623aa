// The command that attaches what a hand carries and no body of the cell is.
#pragma once

#include <string>

#include "config/cell/cell.hpp"
#include "monitor/sensors/unknown_payloads.hpp"

namespace clearance {

// A line for a shell: clearance-scene adds a box and attaches it to the link. The box may overlap
// the link by a cell of the grid in which it was found, and touch the links that hang on it.
// Cell::yaml has to be the text of the cell, since an entry of it has its unit.
[[nodiscard]] std::string attach_command(const Cell& cell, const UnknownPayload& payload);

}  // namespace clearance
