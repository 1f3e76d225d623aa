// clearance-bench --ask: certified motions beside FCL's continuous collision and beside postures at
// every degree.
#pragma once

namespace clearance::bench {

// Prints a table, and returns the exit status. argv[0] is "--ask".
[[nodiscard]] int run_ask(int argc, char** argv);

}  // namespace clearance::bench
