// The example of a tool changer: an arm takes a gripper from its dock, puts it back, takes a
// welding torch, and so on, while a person walks past. The loop is closed over DDS.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/commands.hpp"

namespace clearance::tools {

struct RunOptions {
  int changes = 1000;  // tools that are attached or detached
};

struct RunResult {
  bool heard = false;               // the daemon always answered, and took all commands
  std::string refusal;              // of a command; empty: none
  int changes = 0;                  // that are in force
  std::uint64_t reports = 0;        // of the time from the first change on, as all that follow
  std::uint64_t missed = 0;         // cycles without a report
  std::uint64_t unknown = 0;        // reports with a pair that is not known
  std::uint64_t compared = 0;       // pairs whose bounds were compared with the true distance
  std::uint64_t wrong = 0;          // those that do not hold
  double least_distance_m = 1e9;    // the least true one of a pair with the person
  std::string nearest;              // that pair
  std::vector<double> commands_ms;  // sorted: until the first report of the changed scene came
};

// Throws std::invalid_argument if the cell has not an arm with a `flange` and two robots behind it,
// each with one joint.
[[nodiscard]] RunResult run(const Cell& cell, client::Connection& connection,
                            const RunOptions& options, const std::function<bool()>& go_on);

}  // namespace clearance::tools
