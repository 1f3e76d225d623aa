// Routes Cyclone's own messages into the program's log.
#pragma once

namespace clearance {

// Sends Cyclone's warnings and errors to spdlog, a few a second at most. Call it before the first
// participant is made.
void route_dds_log();

}  // namespace clearance
