// Routes Cyclone's own messages into the program's log.
#pragma once

#include <cstdint>

namespace clearance {

// Sends Cyclone's warnings and errors to spdlog, a few a second at most. Call it before the first
// participant is made.
void route_dds_log();

// Samples that Cyclone has dropped because they could not be decoded, of all readers of the
// process, since route_dds_log(). Cyclone 0.10 has no status and no callback for them, only this
// line of its log.
[[nodiscard]] std::uint64_t undecodable_samples() noexcept;

}  // namespace clearance
