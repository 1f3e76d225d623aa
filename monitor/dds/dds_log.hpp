// Routes Cyclone's own messages into the program's log.
#pragma once

#include <cstdint>

namespace clearance {

// Sends Cyclone's warnings and errors to the log, a few a second at most. Call it before the first
// participant is made.
void route_dds_log();

// The number of samples that Cyclone could not decode since route_dds_log(), for all readers of the
// process. Cyclone 0.10 has no status and no callback for them, only a line of its log.
[[nodiscard]] std::uint64_t undecodable_samples() noexcept;

}  // namespace clearance
