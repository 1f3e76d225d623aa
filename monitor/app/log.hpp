// Where the log goes: spdlog, to stderr; Cyclone's own messages too, a few a second at most.
#pragma once

#include <string>

namespace clearance {

// `level`: trace, debug, info, warn, error or off. `name` starts every line.
void start_log(const std::string& name, const std::string& level);

// Before the first participant is made.
void route_dds_log();

}  // namespace clearance
