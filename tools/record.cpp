// clearance-record: records Clearance's topics, or converts a ROS 2 bag or a log kept as CSV, to an
// MCAP file.
#include <cstdio>

#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/recording/input_log.hpp"
#include "tools/record/arguments.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  the recording is complete
  1  the recording is incomplete, or nothing was received; the message says why. SIGINT, SIGTERM and SIGHUP end a recording
     from DDS in order; they interrupt --from-csv, which then removes its output
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  the bag is damaged; the recording holds what came before that

A pose log has a header line that names t_ns,object,px,py,pz,qw,qx,qy,qz in any order (other columns are
ignored), then a line a pose: poses of the object's frame in the world, m, times in ns, not going back.
With --cell, every object must be in the cell; without, clearance-replay finds them by name. A joint log names
t_ns and, as columns, joints of the cell's robots: rad or m; NAME/velocity may stand beside them.

Examples:
  clearance-record -o run.mcap --cell cell.yaml
  clearance-record -o run.mcap --cell cell.yaml --scene
  clearance-record -o run.mcap --domain 7 --partition lab --seconds 60
  clearance-record --from-csv poses.csv.gz -o run.mcap --cell cell.yaml
  clearance-record --from-bag rosbag2_2026_11_22/ -o run.mcap --cell cell.yaml)";

// The bag, or the table if it is one of joints; empty: neither.
std::string joint_log_of(const RecordArguments& arguments) {
  if (!arguments.from_bag.empty()) return arguments.from_bag;
  const bool of_joints = !arguments.from_csv.empty() && is_input_log(arguments.from_csv);
  return of_joints ? arguments.from_csv : "";
}

int run(int argc, char** argv, StopSignal& stop) {
  RecordArguments arguments;
  CommandLine line{"Records every topic of Clearance, as it is on the wire, to an MCAP file.",
                   kFooter};
  line.add({
      {"-o,--output", &arguments.out, "The recording to write", required()},
      {"--cell", &arguments.cell,
       "The cell file, which names domain, partition, topics and objects"},
      {"--from-csv", &arguments.from_csv,
       "Convert this pose log or joint log, plain or gzip, instead of recording from DDS"},
      {"--from-bag", &arguments.from_bag,
       "Convert the joint states and transforms of this ROS 2 bag (MCAP, .db3 or the folder) for "
       "the robots and objects of the cell",
       excluding("--from-csv")},
      {"--joint-topic", &arguments.joint_topics,
       "Of the bag, take joint states of this topic; repeatable. Without it, of all that are named "
       "joint_states",
       needing("--from-bag")},
      {"--joint", &arguments.joints,
       "NAME=POSITION: a joint that the bag or joint log does not have stays there (rad or m); "
       "repeatable",
       needing("--cell")},
      {"--seconds",
       &arguments.seconds,
       "Stop after this many seconds; otherwise on Ctrl-C",
       positive_number(),
       {.excludes = {"--from-csv", "--from-bag"}}},
      {"--scene",
       &arguments.scene,
       "Record the scene as well, as ROS 2 transforms and markers at 60 Hz: /tf, "
       "/clearance/bodies, /clearance/closest. Foxglove, Lichtblick and their like then show the "
       "recording in 3D",
       {.needs = {"--cell"}, .excludes = {"--from-csv", "--from-bag"}}},
      force_option(arguments.force),
  });
  arguments.recording.add_to(line, "--");
  arguments.dds.add_to(line);
  if (const auto done = parse(line, argc, argv)) return *done;
  if (!output_is_not_an_input("clearance-record", arguments.out,
                              {arguments.from_csv, arguments.from_bag, arguments.cell}))
    return kUsage;
  if (!can_create("clearance-record", arguments.out, arguments.force)) return kFailed;
  const std::string log = joint_log_of(arguments);
  if (!log.empty() && arguments.cell.empty()) {
    print(stderr,
          "clearance-record: --cell is missing: {} names joints, and a cell says whose they are\n",
          log);
    return kUsage;
  }
  std::optional<Cell> read;
  if (!arguments.cell.empty()) {
    read = cell_or_errors(read_cell(arguments.cell, told_on_stderr()));
    if (!read) return kBadCell;
  }
  const Cell* const known = read ? &*read : nullptr;
  if (!log.empty()) return record_from_log(arguments, log, *read, stop);
  return arguments.from_csv.empty() ? record_from_dds(arguments, known, stop)
                                    : record_from_csv(arguments, known, stop);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-record", [=](auto& stop) { return clearance::run(argc, argv, stop); },
      clearance::dds_exit_code);
}
