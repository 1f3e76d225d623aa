// clearance-bench --ask: certified motions beside FCL's continuous collision and beside postures at
// every degree.
#pragma once

#include <string>
#include <vector>

namespace clearance::bench {

// Prints a table, and returns the exit status. `arguments` follow --ask.
[[nodiscard]] int run_ask(const std::vector<std::string>& arguments);

}  // namespace clearance::bench
