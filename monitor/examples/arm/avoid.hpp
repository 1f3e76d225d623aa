// One run of the example: the arm and the obstacles of the cell, and a controller. It closes the
// loop through the daemon's gradients over DDS.
#pragma once

#include <functional>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"
#include "monitor/examples/arm/controller.hpp"

namespace clearance::avoid {

struct RunOptions {
  double seconds = 10.0;  // duration of the motion; a run takes longer if the machine stalls
  ControllerOptions controller;
};

struct RunResult {
  bool heard = false;                                // the daemon always answered
  std::uint64_t steps = 0;                           // number of controller steps
  double mean_error_m = 0.0, largest_error_m = 0.0;  // path errors of the end point
  double least_distance_m = kInfinity;               // between robot and obstacles
  std::string nearest;                               // the pair with that distance
};

// Obstacles and path are functions of the run's own time, which stops while the daemon does not
// answer. Every run therefore has the same motion. `go_on` is called before each step; the run ends
// when it returns false.
[[nodiscard]] RunResult run(const Cell& cell, client::Connection& connection,
                            const RunOptions& options, const std::function<bool()>& go_on);

}  // namespace clearance::avoid
