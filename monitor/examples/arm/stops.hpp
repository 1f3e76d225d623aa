// One run of the example: an arm swings beside a person, and obeys distance zones, S_p, or the
// scaling of its stops. The loop is closed over DDS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"

namespace clearance::stops {

enum class Obeyed : std::uint8_t {
  kZones,       // the zone `stop` stops it, the zone `slow` slows it down to a quarter
  kSeparation,  // the least scaling of all zones with `separation`
  kStops,       // the scaling of the robot's stops
};

struct RunOptions {
  Obeyed obeyed = Obeyed::kStops;
  double seconds = 20.0;  // duration of the motion
};

struct RunResult {
  bool heard = false;          // the daemon always answered
  std::size_t strokes = 0;     // from one place to the other
  double at_full_speed = 0.0;  // share of the time
  // The true distance from the person: always, and while the arm moved, m.
  double least_distance_m = 1e9, least_while_moving_m = 1e9;
};

// The person is a function of the run's own time: every run has the same one. Throws
// std::invalid_argument if the cell has not one robot that states `stopping` and `acceleration`, or
// not one mover.
[[nodiscard]] RunResult run(const Cell& cell, client::Connection& connection,
                            const RunOptions& options, const std::function<bool()>& go_on);

}  // namespace clearance::stops
