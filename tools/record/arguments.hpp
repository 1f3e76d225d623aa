// The arguments of clearance-record.
#pragma once

#include <string>

#include "config/scene.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"

namespace clearance {

struct RecordArguments {
  std::string out;
  std::string cell;      // empty: none
  std::string from_csv;  // empty: record from DDS
  double seconds = 0.0;  // 0: until stopped
  bool scene = false;    // the scene for 3D viewers as well; only with a cell
  bool force = false;
  DdsArguments dds;
};

// tools/record/from_csv.cpp, tools/record/subscribe.cpp. Both return the exit code. `scene` is the
// cell, or null when none was given.
[[nodiscard]] int record_from_csv(const RecordArguments& arguments, const Scene* scene,
                                  StopSignal& stop);
[[nodiscard]] int record_from_dds(const RecordArguments& arguments, const Scene* scene,
                                  StopSignal& stop);

}  // namespace clearance
