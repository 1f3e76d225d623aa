// One run of the example: the arm of config/cells/pick.yaml carries the part from the left bin over
// the wall into the right one. The loop is closed over DDS.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "monitor/client/commands.hpp"

namespace clearance::pick {

struct RunOptions {
  bool tells = true;   // the daemon gets commands that say what the arm holds
  double speed = 1.0;  // of the motion; 1: about 10 s
};

struct RunResult {
  bool heard = false;              // the daemon always answered, and took all commands
  std::string refusal;             // of a command; empty: none
  std::uint64_t steps = 0;         // joint states sent
  double least_distance_m = 1e9;   // between the wall and what the daemon knows to move
  std::string nearest;             // the pair with that distance
  double least_lower_m = 1e9;      // the least of the certified lower bounds
  unsigned entered = 0;            // the times that a zone was entered
  double slowest_command_s = 0.0;  // until the first report of the changed scene came
};

// `go_on` is called before each step; the run ends when it returns false. The time of the motion
// stops while the daemon does not answer.
[[nodiscard]] RunResult run(client::Connection& connection, const RunOptions& options,
                            const std::function<bool()>& go_on);

}  // namespace clearance::pick
