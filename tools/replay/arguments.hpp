// The arguments of clearance-replay.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/write/single_robot_cell.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"

namespace clearance {

struct ReplayArguments {
  std::vector<std::string> recordings;  // at least one

  [[nodiscard]] const std::string& recording() const { return recordings.front(); }
  double start_s = 0.0;
  double end_s = 1e18;
  bool progress = false;

  // Over DDS.
  DdsArguments dds;
  double rate = 1.0;
  double wait_s = 1.0;
  bool restamp = false;
  std::vector<std::string> only;  // topics; empty: all

  // Offline.
  bool offline = false;
  std::string cell;                   // empty: the one in the recording, or
  SingleRobotOptions robot;           // this, if it has a URDF
  std::vector<std::string> packages;  // NAME=DIRECTORY
  std::optional<double> tick_hz;
  std::vector<std::string> joint_topics;
  std::vector<std::string> joints;  // NAME=POSITION
  std::string out;
  std::string csv;
  std::string plot;                                             // SVG; empty: none
  std::string report;                                           // HTML; empty: none
  std::vector<std::pair<std::string, std::string>> plot_pairs;  // empty: the nearest
  bool force = false;
  bool published = false;
  bool evaluate_all = false;
  bool gradients = false;
  bool compare = false;
  std::string reference;            // a table of distances; empty: none
  std::optional<double> tolerance;  // m; of the reference
  bool compare_bounds = false;
  std::optional<double> expect_min_distance;
  std::vector<std::string> expect_no_zone;
};

// tools/replay/offline.cpp, tools/replay/publish.cpp. Both return the exit code.
[[nodiscard]] int replay_without_dds(const ReplayArguments& arguments, StopSignal& stop);
[[nodiscard]] int replay_over_dds(const ReplayArguments& arguments, StopSignal& stop);

}  // namespace clearance
