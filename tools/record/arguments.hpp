// The arguments of clearance-record.
#pragma once

#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/daemon/recording_arguments.hpp"
#include "monitor/dds/dds_arguments.hpp"

namespace clearance {

struct RecordArguments {
  std::string out;
  std::string cell;                       // empty: none
  std::string from_csv;                   // empty: record from DDS, or
  std::string from_bag;                   // this
  std::vector<std::string> joint_topics;  // of the bag
  std::vector<std::string> joints;        // NAME=POSITION: those that a log does not have
  double seconds = 0.0;                   // 0: until stopped
  bool scene = false;                     // the scene for 3D viewers as well; only with a cell
  bool force = false;
  RecordingArguments recording;
  DdsArguments dds;
};

// These are in convert.cpp and subscribe.cpp. All return the exit code. `cell` is null if none was
// given.
[[nodiscard]] int record_from_csv(const RecordArguments& arguments, const Cell* cell,
                                  StopSignal& stop);
// Converts a bag, or joints as CSV.
[[nodiscard]] int record_from_log(const RecordArguments& arguments, const std::string& log,
                                  const Cell& cell, StopSignal& stop);
[[nodiscard]] int record_from_dds(const RecordArguments& arguments, const Cell* cell,
                                  StopSignal& stop);

}  // namespace clearance
