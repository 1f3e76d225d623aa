// One run of the example: a person whose motion was recorded walks up to an arm and reaches out. A
// tracker of ROS4HRI tells the daemon of the person, who now and then leaves and comes again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"

namespace clearance::people {

struct RunOptions {
  double seconds = 20.0;
  std::string motion = {};  // a BVH file; empty: one that is made up
  double metres = 0.01;     // the unit of its lengths
};

struct RunResult {
  bool heard = false;  // the daemon always answered
  std::uint64_t reports = 0, missed = 0;
  int bodies = 0;  // times that a person came, each with another id
  // Pairs of reports: compared with the true distance, and of these with a false lower bound.
  std::uint64_t compared = 0, wrong = 0;
  double least_distance_m = 1e9;      // true
  std::string nearest = {};           // its pair
  std::vector<double> below_truth_m;  // the true distance less the lower bound, in ascending order
};

// Throws std::invalid_argument if the motion cannot be read, or if the cell has no persons beside
// objects that a simulation moves.
[[nodiscard]] RunResult run(const Cell& cell, client::Connection& connection,
                            const RunOptions& options, const std::function<bool()>& go_on);

}  // namespace clearance::people
