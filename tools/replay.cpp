// clearance-replay: publishes a recording again over DDS, or runs it through the monitor offline.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/replay/arguments.hpp"

namespace clearance {
namespace {

constexpr const char* kOffline = "Offline";

constexpr const char* kFooter = R"(Exit status:
  0  done; with --offline: every expectation held, nothing differed
  1  an expectation did not hold, the replay differs (from the recording or the reference), or a file cannot be
     read or written
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  the recording is damaged, or SIGINT or SIGTERM stopped the replay with --offline; what came before gave no
     reason for 1

Examples:
  clearance-replay run.mcap --rate 2 --start 10 --end 20
  clearance-replay run.mcap --only clearance/poses --restamp --partition lab
  clearance-replay --offline --cell cell.yaml run.mcap --compare
  clearance-replay --offline --cell cell.yaml run.mcap --expect-min-distance 0.05 --expect-no-zone stop
  clearance-replay --offline --cell cell.yaml run.mcap --csv distances.csv
  clearance-replay --offline --urdf R.urdf --srdf R.srdf rosbag2_2026_11_22/ --expect-min-distance 0.05
  clearance-replay --offline --cell cell.yaml run.mcap --plot run.svg --plot-pair hand table
  clearance-replay --offline --cell cell.yaml run.mcap --report run.html --expect-no-zone stop
  clearance-replay --offline --cell cell.yaml run.mcap --reference distances.csv.gz --tolerance 1e-6)";

// Instead of a cell.
void add_robot_options(CLI::App& app, ReplayArguments& arguments, CLI::Option* offline) {
  app.add_option("--urdf", arguments.robot.urdf,
                 "A robot's URDF, xacro expanded, instead of a cell file: the robot stands in "
                 "the world, and every pair of its links is watched. Of a bag, the one on its "
                 "topic robot_description if neither is given")
      ->excludes("--cell")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--srdf", arguments.robot.srdf,
                 "The robot's SRDF, which disables pairs; without it, a link and the next above it "
                 "that has shapes may touch")
      ->excludes("--cell")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--package", arguments.packages,
                 "NAME=DIRECTORY of a package:// that the URDF names; repeatable")
      ->allow_extra_args(false)
      ->excludes("--cell")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--age-limit-ms", arguments.robot.age_limit_ms,
                 "An older position makes what hangs on the joint stale")
      ->check(positive_number())
      ->capture_default_str()
      ->excludes("--cell")
      ->needs(offline)
      ->group(kOffline);
}

// Of what holds no ticks of a daemon.
void add_log_options(CLI::App& app, ReplayArguments& arguments, CLI::Option* offline) {
  app.add_option("--tick-hz", arguments.tick_hz,
                 "Ticks a second, also while nothing comes, as the daemon has them; 0: only when "
                 "something came. Without it, the cell's rate for bags and joint logs, 0 for "
                 "recordings without reports; those with reports have their own ticks")
      ->check(number_from_zero())
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--joint-topic", arguments.joint_topics,
                 "Take joint states of this topic of the bag, /left/joint_states for instance; "
                 "repeatable. Without it, of all that are named joint_states")
      ->allow_extra_args(false)
      ->needs(offline)
      ->group(kOffline);
  app.add_option(
         "--joint", arguments.joints,
         "NAME=POSITION: a joint that the bag or joint log does not have stays there (rad or "
         "m); repeatable")
      ->allow_extra_args(false)
      ->needs(offline)
      ->group(kOffline);
}

void add_options(CLI::App& app, ReplayArguments& arguments) {
  app.add_option(
         "FILE", arguments.recordings,
         "The recording (MCAP), or its files in their order; with --offline also a ROS 2 bag "
         "(MCAP, .db3, or the folder), or joint positions as CSV: t_ns and a column a joint")
      ->required();
  app.add_option("--start", arguments.start_s, "Begin this many seconds after its first message")
      ->check(number_from_zero());
  app.add_option("--end", arguments.end_s, "End this many seconds after its first message")
      ->check(number_from_zero());
  app.add_flag("--progress", arguments.progress,
               "Show progress on stderr even if it is no terminal");

  CLI::Option* const offline = app.add_flag(
      "--offline", arguments.offline,
      "Run the recorded poses through the monitor instead, without DDS or a clock, as fast as "
      "possible");
  app.add_option(
         "--cell", arguments.cell,
         "The cell file; otherwise the cell that is kept in the recording, which lacks mesh "
         "files. Without --offline: only its domain and partition are used")
      ->group(kOffline);
  app.add_option("-o,--output", arguments.out, "Write the reports to this recording")
      ->needs(offline)
      ->group(kOffline);
  add_robot_options(app, arguments, offline);
  add_log_options(app, arguments, offline);
  CLI::Option* const csv =
      app.add_option("--csv", arguments.csv, "Write a table with one row a tick and pair")
          ->needs(offline)
          ->group(kOffline);
  app.add_flag("--published", arguments.published,
               "Only pairs that the cell publishes go into the table")
      ->needs(csv)
      ->group(kOffline);
  app.add_flag("--gradients", arguments.gradients,
               "Compute gradients of distances by joint positions, for -o, as 'gradients: true' in "
               "the cell does")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--plot", arguments.plot,
                 "Draw distances, bounds, zones and closing speeds over time (SVG, by gnuplot)")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--report", arguments.report,
                 "Write one self-contained page of the run (HTML): summary, expectations, plot, "
                 "worst moments with pictures, zones")
      ->needs(offline)
      ->group(kOffline);
  app.add_option("--plot-pair", arguments.plot_pairs,
                 "Draw this pair, of --plot and --report: two objects; repeatable. Otherwise those "
                 "four that came nearest. The cell must publish it")
      ->needs(offline)
      ->group(kOffline);
  CLI::Option* const evaluate_all =
      app.add_flag("--evaluate-all", arguments.evaluate_all,
                   "Evaluate every pair in every tick, whatever the cell's budget; otherwise the "
                   "status of pairs that the tick did not evaluate is 'carried', with true bounds")
          ->needs(offline)
          ->group(kOffline);
  CLI::Option* const compare =
      app.add_flag(
             "--compare", arguments.compare,
             "Compare with the recorded reports and zones, to the bit; name the first tick and "
             "field that differs")
          ->needs(offline)
          ->excludes(evaluate_all)
          ->group(kOffline);
  app.add_flag("--compare-bounds", arguments.compare_bounds,
               "Compare only certified values: recorded and replayed bounds of a pair must overlap")
      ->needs(offline)
      ->excludes(compare)
      ->group(kOffline);
  CLI::Option* const reference =
      app.add_option(
             "--reference", arguments.reference,
             "Compare every pair's distance and bounds with this table (CSV, plain or gzip: "
             "t_ns,object_a,object_b,distance in m), where 0 is contact or penetration. "
             "Evaluates all pairs")
          ->needs(offline)
          ->excludes(compare)
          ->group(kOffline);
  app.add_option(
         "--tolerance", arguments.tolerance,
         "How far off a reference may be, m: distances may differ by that much, and lie "
         "outside of the bounds by that much. Without it, distances may differ by 1e-6, and "
         "the bounds hold the reference as it is written, to half a unit of its last digit")
      ->needs(reference)
      ->check(number_from_zero())
      ->group(kOffline);
  app.add_option(
         "--expect-min-distance", arguments.expect_min_distance,
         "Every pair's distance is certified to be at least this (m) in every tick and at every "
         "instant since the tick before")
      ->needs(offline)
      ->check(finite_number())
      ->group(kOffline);
  app.add_option("--expect-no-zone", arguments.expect_no_zone,
                 "This zone is never active; repeatable")
      ->needs(offline)
      ->group(kOffline);

  app.add_flag("--force", arguments.force, "Overwrite files that exist")
      ->needs(offline)
      ->group(kOffline);

  const char* const kDds = "Over DDS";
  app.add_option("--rate", arguments.rate, "Speed, in multiples of the recorded one")
      ->check(positive_number())
      ->excludes(offline)
      ->capture_default_str()
      ->group(kDds);
  app.add_option("--wait", arguments.wait_s, "Seconds to wait for a first reader before beginning")
      ->check(number_from_zero())
      ->excludes(offline)
      ->capture_default_str()
      ->group(kDds);
  app.add_option("--only", arguments.only, "Publish this topic only; repeatable")
      ->excludes(offline)
      ->group(kDds);
  app.add_flag(
         "--restamp", arguments.restamp,
         "Move the stamps of poses to now, so that a running daemon takes them as fresh; twists "
         "are scaled with --rate. Objects that are then faster than the cell says are refused")
      ->excludes(offline)
      ->group(kDds);
  arguments.dds.add_to(app);
  app.footer(kFooter);
}

int run(int argc, char** argv, StopSignal& stop) {
  CLI::App app(
      "Publishes a recording over DDS with its original timing; with --offline runs it through "
      "the monitor and checks the result.");
  ReplayArguments arguments;
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  if (arguments.start_s > arguments.end_s) {
    print(stderr, "clearance-replay: --start {:g} lies after --end {:g}\n", arguments.start_s,
          arguments.end_s);
    return kUsage;
  }
  return arguments.offline ? replay_without_dds(arguments, stop) : replay_over_dds(arguments, stop);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-replay", [=](auto& stop) { return clearance::run(argc, argv, stop); },
      clearance::dds_exit_code);
}
