// clearance-replay: publishes a recording over DDS again, runs it through the monitor and checks
// the result, compares two recordings, or verifies a log of interventions.
#include <cstdio>
#include <optional>

#include "config/cell/shares.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/replay/arguments.hpp"

namespace clearance {
namespace {

constexpr const char* kProgram = "clearance-replay";

constexpr const char* kExamples = R"(Examples:
  clearance-replay publish run.mcap --rate 2 --start 10 --end 20
  clearance-replay check run.mcap --compare
  clearance-replay check run.mcap --cell cell.yaml --expect-min-distance 0.05 --expect-no-zone stop
  clearance-replay compare left.mcap right.mcap
  clearance-replay log interventions.jsonl)";

constexpr const char* kPublishFooter = R"(Exit status:
  0  every message was published, or SIGINT, SIGTERM or SIGHUP stopped the replay
  1  a file cannot be read, or holds no message between --start and --end
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  the recording is damaged; the messages before the damage were published

Examples:
  clearance-replay publish run.mcap --rate 2 --start 10 --end 20
  clearance-replay publish run.mcap --only clearance/poses --restamp --partition lab)";

constexpr const char* kCheckFooter = R"(Exit status:
  0  every expectation held, and nothing differed
  1  an expectation did not hold, the replay differs (from the recording or the reference), or a file cannot be
     read or written
  2  wrong usage
  3  the cell file is wrong
  5  the recording is damaged, or SIGINT, SIGTERM or SIGHUP stopped the replay; the part before that gave no reason for 1

Examples:
  clearance-replay check run.mcap --cell cell.yaml --compare
  clearance-replay check run.mcap --cell cell.yaml --expect-min-distance 0.05 --expect-no-zone stop
  clearance-replay check run.mcap --cell cell.yaml --csv distances.csv
  clearance-replay check rosbag2_2026_11_22/ --urdf R.urdf --srdf R.srdf --expect-min-distance 0.05
  clearance-replay check run.mcap --cell cell.yaml --reference distances.csv.gz --tolerance 1e-6
  clearance-replay check run.mcap --cell cell.yaml --balance 3)";

constexpr const char* kCompareFooter = R"(Exit status:
  0  every cycle that both recordings have is the same, to the bit
  1  a cycle differs, a file cannot be read, or the recordings have no cycle in common
  2  wrong usage
  5  a recording is damaged, or SIGINT, SIGTERM or SIGHUP stopped the comparison; there was no difference before

Example:
  clearance-replay compare left.mcap right.mcap)";

constexpr const char* kLogFooter = R"(Exit status:
  0  every line is as it was written
  1  a line is not (the first one is named), --holds is of no line, or the file cannot be read
  2  wrong usage
  5  the last line is not whole: its program was killed while it wrote

Example:
  clearance-replay log interventions.jsonl --holds 3f79bb7b435b05321651daefd374cdc681dc06faa65e374e38337b88ca046dea)";

void add_span(CommandLine& line, RecordedSpan& span, const char* files) {
  line.add({
      {"FILE", &span.recordings, files, required()},
      {"--start", &span.start_s, "Begin this many seconds after the first message",
       number_from_zero()},
      {"--end", &span.end_s, "End this many seconds after the first message", number_from_zero()},
  });
}

CommandLine publish_line(PublishArguments& arguments) {
  CommandLine line{.about = "Publish a recording over DDS with its original timing",
                   .footer = kPublishFooter,
                   .name = "publish"};
  add_span(line, arguments.span, "The recording (MCAP), or its files in their order");
  line.add({
      {"--cell", &arguments.cell, "A cell file; only its DDS domain and partition are used"},
      {"--rate", &arguments.rate, "Speed, in multiples of the recorded speed", positive_number(),
       shown()},
      {"--wait", &arguments.wait_s, "Wait this many seconds for a first reader", number_from_zero(),
       shown()},
      {"--only", &arguments.only, "Publish this topic only; repeatable"},
      {"--restamp", &arguments.restamp,
       "Move the stamps of poses and joint states to now, so that a running daemon accepts them as "
       "fresh. Velocities are scaled with --rate; the daemon refuses objects that are then faster "
       "than the cell says"},
  });
  arguments.dds.add_to(line);
  return line;
}

// The cell, or a robot in its place.
void add_cell(CommandLine& line, CheckArguments& arguments) {
  line.add({
      {"--cell", &arguments.cell,
       "The cell file; otherwise the cell that is kept in the recording"},
      {"--urdf", &arguments.robot.urdf,
       "A robot's URDF, xacro expanded, instead of a cell file: the robot stands in the world, and "
       "every pair of its links is watched. Without --urdf and --cell, a bag's topic "
       "robot_description is used",
       excluding("--cell")},
      {"--srdf", &arguments.robot.srdf,
       "The robot's SRDF, which disables pairs; without it, a link may touch the nearest link "
       "above it that has shapes",
       excluding("--cell")},
      packages_option(arguments.robot.packages, {"--cell"}),
      {"--age-limit-ms",
       &arguments.robot.age_limit_ms,
       "An older joint position makes the links after that joint stale",
       positive_number(),
       {.shows_default = true, .excludes = {"--cell"}}},
  });
}

void add_expectations(CommandLine& line, CheckArguments& arguments) {
  line.add({
      {"--expect-min-distance", &arguments.expect_min_distance,
       "Every pair's distance is certified to be at least this, m, in every tick and at every "
       "instant since the tick before. At the end of the recording, an object may have been late "
       "for up to 1 s, as after its driver's end: its pairs then count only where they are "
       "certainly too near",
       finite_number()},
      {"--between",
       &arguments.between,
       "Only these pairs: A,B of two objects or groups, or a zone; with '=METRES' a distance of "
       "their own. Repeatable. Example: --between arm,table=0.02",
       {.value_name = "A,B[=METRES]"}},
      {"--allow-unknown", &arguments.allow_unknown,
       "The share of judged ticks, 0 to 1, in which a pair may be unknown. Ticks count from the "
       "first one in which all objects are known and on time",
       number_in(0.0, 1.0)},
      {"--expect-no-zone", &arguments.expect_no_zone, "This zone is never active; repeatable"},
      {"--junit", &arguments.junit,
       "Write the result as JUnit's XML for a CI system, with the ticks that were not judged"},
      {"--errors",
       &arguments.errors,
       "The poses of this object, as a tracker sends them, are those of this link, which joints "
       "place: compare the two, and fail if the errors that the cell states do not explain the "
       "difference of their origins; repeatable",
       {.value_name = "OBJECT=LINK"}},
  });
}

void add_comparisons(CommandLine& line, CheckArguments& arguments) {
  line.add({
      {"--evaluate-all", &arguments.evaluate_all,
       "Evaluate every pair in every tick, whatever the cell's budget. Otherwise pairs that a tick "
       "did not evaluate have the status 'carried' and true bounds"},
      {"--compare", &arguments.compare,
       "Compare with the recorded reports and zones, to the bit, and name the first tick and field "
       "that differs",
       excluding("--evaluate-all")},
      {"--compare-bounds", &arguments.compare_bounds,
       "Compare certified values only: recorded and replayed bounds of a pair must overlap",
       excluding("--compare")},
      {"--reference", &arguments.reference,
       "Compare every pair's distance and bounds with this table (CSV, plain or gzip: "
       "t_ns,object_a,object_b,distance in m), where 0 is contact or penetration. Evaluates all "
       "pairs",
       excluding("--compare")},
      {"--tolerance", &arguments.tolerance,
       "Error of the reference, m: distances may differ by it, and may lie outside of the bounds "
       "by it. Default: distances may differ by 1e-6, and the bounds must hold the reference as "
       "written, to half a unit of its last digit",
       number_from_zero(), needing("--reference")},
      {"--true-meshes", &arguments.true_meshes,
       "The reference is of the meshes themselves: our distances may be smaller by the stated "
       "errors of both objects' parts (clearance-scene report)",
       needing("--reference")},
  });
}

void add_outputs(CommandLine& line, CheckArguments& arguments) {
  line.add({
      {"-o,--output", &arguments.out, "Write the reports to this recording"},
      {"--csv", &arguments.csv, "Write a table with one row per tick and pair"},
      {"--published", &arguments.published,
       "Write only pairs that the cell publishes into the table", needing("--csv")},
      {"--gradients", &arguments.gradients,
       "Compute gradients of distances by joint positions for -o, as 'gradients: true' in the cell "
       "does"},
      force_option(arguments.force),
      {"--balance",
       &arguments.balance,
       "Print the key 'shares' that divides the cell among so many daemons of the same cost, by "
       "what this run has evaluated",
       whole_number_in(1, kMaxShares),
       {.excludes = {"--evaluate-all", "--reference"}}},
  });
}

// For bags, joint logs and other recordings without the ticks of a daemon.
void add_inputs(CommandLine& line, CheckArguments& arguments) {
  line.add({
      {"--tick-hz", &arguments.tick_hz,
       "Tick rate, Hz; 0: one tick per message. Default: the cell's rate for bags and joint logs, "
       "0 for recordings without reports. Recordings with reports always use their own ticks",
       number_in(0.0, 1e6)},
      {"--joint-topic", &arguments.joint_topics,
       "Use joint states of this topic of the bag, for example /left/joint_states; repeatable. "
       "Default: every topic named joint_states"},
      {"--joint", &arguments.joints,
       "NAME=POSITION, rad or m: the position of a joint that the bag or joint log does not have; "
       "repeatable"},
      {"--use-sim-time", &arguments.use_sim_time,
       "The time is that of a simulation, by /clock in the bag or by its times of recording, as "
       "'use_sim_time: true' of 'ros2' in the cell file says"},
  });
}

CommandLine check_line(CheckArguments& arguments) {
  CommandLine line{
      .about =
          "Run a recording or a bag through the monitor, without DDS or a clock, as fast as "
          "possible",
      .footer = kCheckFooter,
      .name = "check"};
  add_span(line, arguments.span,
           "The recording (MCAP), or its files in their order; a ROS 2 bag (MCAP, .db3, or the "
           "folder); or joint positions as CSV: t_ns and a column per joint");
  add_cell(line, arguments);
  add_expectations(line, arguments);
  add_comparisons(line, arguments);
  add_outputs(line, arguments);
  add_inputs(line, arguments);
  return line;
}

CommandLine compare_line(CompareArguments& arguments) {
  return {.about =
              "Name the first difference of two recordings, such as those of two daemons, and "
              "whether it is one of their inputs or of their results",
          .footer = kCompareFooter,
          .name = "compare",
          .options = {
              {"FIRST", &arguments.first, "A recording (MCAP)", required()},
              {"SECOND", &arguments.second, "The other recording (MCAP)", required()},
          }};
}

CommandLine interventions_line(LogArguments& arguments) {
  return {
      .about =
          "Verify the chain of a log of interventions (clearanced --interventions), print it, "
          "and name the first line that was changed, removed, inserted or moved",
      .footer = kLogFooter,
      .name = "log",
      .options = {
          {"FILE", &arguments.file, "The log", required()},
          {"--holds", &arguments.holds,
           "Fail if no line has this hash, which the daemon's log told at a start or an end: lines "
           "at the end were cut off, or all lines were written anew",
           expecting("64 hexadecimal digits",
                     [](const std::string& text) {
                       return text.size() == 64 &&
                              text.find_first_not_of("0123456789abcdef") == std::string::npos;
                     })},
      }};
}

bool is_forwards(const RecordedSpan& span) {
  if (span.start_s <= span.end_s) return true;
  print(stderr, "clearance-replay: --start {:g} lies after --end {:g}\n", span.start_s, span.end_s);
  return false;
}

int run(int argc, char** argv, StopSignal& stop) {
  PublishArguments publish;
  CheckArguments check;
  CompareArguments compare;
  LogArguments log;
  CommandLine line{
      "Publishes a recording again, checks a robot program against one, compares two, or verifies "
      "a "
      "log of interventions.",
      kExamples};
  line.subcommands = {publish_line(publish), check_line(check), compare_line(compare),
                      interventions_line(log)};
  if (const auto done = parse(line, argc, argv)) return *done;
  if (line.chosen == "log") return verify_log(log);
  if (line.chosen == "compare") return compare_two_recordings(compare, stop);
  const bool publishes = line.chosen == "publish";
  if (!is_forwards(publishes ? publish.span : check.span)) return kUsage;
  return publishes ? publish_recording(publish, stop) : check_recording(check, stop);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      clearance::kProgram, [=](auto& stop) { return clearance::run(argc, argv, stop); },
      clearance::dds_exit_code);
}
