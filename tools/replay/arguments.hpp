// The arguments of clearance-replay's subcommands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/write/single_robot_cell.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"

namespace clearance {

// The part of a recording that is replayed.
struct RecordedSpan {
  std::vector<std::string> recordings;  // at least one
  double start_s = 0.0;                 // after the first message
  double end_s = 1e18;

  [[nodiscard]] const std::string& recording() const { return recordings.front(); }
};

struct PublishArguments {
  RecordedSpan span;
  DdsArguments dds;
  std::string cell;  // names domain and partition; empty: none
  double rate = 1.0;
  double wait_s = 1.0;
  bool restamp = false;
  std::vector<std::string> only;  // topics; empty: all
};

struct CheckArguments {
  RecordedSpan span;
  std::string cell;          // empty: the one in the recording, or
  SingleRobotOptions robot;  // this, if it has a URDF
  std::optional<double> tick_hz;
  std::vector<std::string> joint_topics;
  std::vector<std::string> joints;  // NAME=POSITION
  std::string out;
  std::string csv;
  std::string junit;
  std::uint32_t balance = 0;  // a cell in this many shares of the same cost; 0: none
  bool force = false;
  bool published = false;
  bool evaluate_all = false;
  bool gradients = false;
  bool use_sim_time = false;
  bool compare = false;
  std::string reference;            // a table of distances; empty: none
  std::optional<double> tolerance;  // m; of the reference
  bool true_meshes = false;         // the reference is of meshes, not of their parts
  bool compare_bounds = false;
  std::optional<double> expect_min_distance;
  std::vector<std::string> between;  // A,B or a zone, with =METRES or the distance above
  double allow_unknown = 0.0;        // share of ticks
  std::vector<std::string> expect_no_zone;
  std::vector<std::string> errors;  // OBJECT=LINK

  [[nodiscard]] const std::string& recording() const { return span.recording(); }
};

struct CompareArguments {
  std::string first, second;
};

struct LogArguments {
  std::string file;
  std::string holds;  // a hash; empty: none
};

// All return the exit code.
[[nodiscard]] int publish_recording(const PublishArguments& arguments, StopSignal& stop);
[[nodiscard]] int check_recording(const CheckArguments& arguments, StopSignal& stop);
[[nodiscard]] int compare_two_recordings(const CompareArguments& arguments, StopSignal& stop);
[[nodiscard]] int verify_log(const LogArguments& arguments);

}  // namespace clearance
