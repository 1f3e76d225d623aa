// clearance-bench --stops: how fast an arm gets through its motion beside a person who walks past,
// by distance zones, by S_p, and by its stops.
#pragma once

namespace clearance::bench {

// Prints a table, and returns the exit status. argv[0] is "--stops".
[[nodiscard]] int run_stops(int argc, char** argv);

}  // namespace clearance::bench
