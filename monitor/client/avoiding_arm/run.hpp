// One run of the example: the controller's arm and the obstacles of the cell, closed over DDS
// through the daemon's gradients.
#pragma once

#include <functional>

#include "config/cell/cell.hpp"
#include "monitor/client/avoiding_arm/controller.hpp"
#include "monitor/client/client.hpp"

namespace clearance::avoid {

struct RunOptions {
  double seconds = 10.0;  // of the motion; a machine that stalls takes longer
  std::string end_link = "hand";
  ControllerOptions controller;
};

struct RunResult {
  bool heard = false;                                // the daemon answered all the time
  std::uint64_t steps = 0;                           // of the controller
  double mean_error_m = 0.0, largest_error_m = 0.0;  // of the end point on its path
  double least_distance_m = kInfinity;               // between robot and obstacles
  std::string nearest;                               // the pair at that distance
};

// Obstacles and path are functions of the run's own time, which stands still while the daemon does
// not answer. Every run therefore has the same motion. The run ends when `go_on`, which is called
// before each step, returns false.
[[nodiscard]] RunResult run(const Cell& cell, client::Connection& connection,
                            const RunOptions& options, const std::function<bool()>& go_on);

}  // namespace clearance::avoid
