// An example of a program beside the daemon: an arm that keeps away from obstacles by the daemon's
// gradients, tells it what it holds, asks it before each motion, stops for a person, changes its
// tool, or works beside a tracked person.
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/client/client.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/examples/arm/ask.hpp"
#include "monitor/examples/arm/avoid.hpp"
#include "monitor/examples/arm/people.hpp"
#include "monitor/examples/arm/pick.hpp"
#include "monitor/examples/arm/stops.hpp"
#include "monitor/examples/arm/tools.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  all motions were made or decided
  1  something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  stopped, or the daemon did not answer
  6  the daemon refused a command

Examples, beside clearanced config/cells/avoid.yaml --partition lab, or pick.yaml, stops.yaml, tools.yaml, people.yaml:
  build/bin/example_arm avoid config/cells/avoid.yaml --partition lab
  build/bin/example_arm pick config/cells/pick.yaml --partition lab
  build/bin/example_arm stops config/cells/stops.yaml --partition lab
  build/bin/example_arm tools config/cells/tools.yaml --partition lab --changes 100
  build/bin/example_arm people config/cells/people.yaml --partition lab
  build/bin/example_arm ask config/cells/pick.yaml --partition lab    # clearanced --questions "example arm")";

struct Arguments {
  CellArguments cell;
  DdsArguments dds;
  avoid::RunOptions avoid;
  pick::RunOptions pick;
  stops::RunOptions stops;
  tools::RunOptions tools;
  people::RunOptions people;
  double speed = 1.0;  // of the jogs that are asked about
};

// The cell and DDS, and what this kind has beside.
CommandLine kind(Arguments& arguments, const char* name, const char* about,
                 std::vector<Option> options) {
  CommandLine line{.about = about, .name = name};
  arguments.cell.add_to(line);
  arguments.dds.add_to(line);
  line.add(std::move(options));
  return line;
}

int no_answer(const client::Connection& connection, const std::string& what) {
  print(stderr, "example_arm: stopped, or no {} on {}?\n", what, connection.where());
  return kIncomplete;
}

void print_row(const char* name, const avoid::RunResult& result) {
  print(stdout, "{:<18} {:>9.4f}  {:>9.4f} / {:<9.4f} {:>7}  {}\n", name, result.least_distance_m,
        result.mean_error_m, result.largest_error_m, result.steps, result.nearest);
  std::fflush(stdout);
}

// The hand follows a path twice, without and with avoidance, past the same moving obstacles.
int avoid_twice(const Cell& cell, client::Connection& connection, Arguments& arguments,
                StopSignal& signal) {
  print(stdout, "{:<18} {:>9}  {:>21} {:>7}\n", "", "nearest m", "task error m, mean / max",
        "steps");
  for (const bool avoids : {false, true}) {
    arguments.avoid.controller.avoids = avoids;
    const avoid::RunResult result =
        avoid::run(cell, connection, arguments.avoid, [&signal] { return !signal.wait(0); });
    if (!result.heard) {
      return no_answer(connection,
                       "gradients came; does clearanced run, with 'gradients: true' in its cell "
                       "or --gradients,");
    }
    print_row(avoids ? "with avoidance" : "without avoidance", result);
  }
  return kOk;
}

void print_row(const char* name, const pick::RunResult& result) {
  print(stdout, "{:<16} {:>9.4f} {:>12.4f}  {:<20} {:>12} {:>12.1f}\n", name,
        result.least_distance_m, result.least_lower_m, result.nearest, result.entered,
        1e3 * result.slowest_command_s);
  std::fflush(stdout);
}

// The arm carries a part twice, without and with commands that say so.
int pick_twice(client::Connection& connection, Arguments& arguments, StopSignal& signal) {
  print(stdout, "{:<16} {:>9} {:>12}  {:<20} {:>12} {:>12}\n", "payload", "nearest m",
        "certified m", "pair", "zone entries", "command ms");
  for (const bool tells : {false, true}) {
    arguments.pick.tells = tells;
    const pick::RunResult result =
        pick::run(connection, arguments.pick, [&signal] { return !signal.wait(0); });
    if (!result.refusal.empty()) {
      print(stderr, "example_arm: a command was refused: {}\n", result.refusal);
      return kRefused;
    }
    if (!result.heard) {
      return no_answer(
          connection, "reports or results came; does clearanced run, with config/cells/pick.yaml,");
    }
    print_row(tells ? "known" : "not known", result);
  }
  return kOk;
}

void print_row(const char* name, const stops::RunResult& result) {
  print(stdout, "{:<12} {:>7} {:>10.0f} %  {:>14.3f}  {:>9.3f}\n", name, result.strokes,
        100.0 * result.at_full_speed, result.least_while_moving_m, result.least_distance_m);
  std::fflush(stdout);
}

// The arm works beside the same person three times.
int stop_thrice(const Cell& cell, client::Connection& connection, Arguments& arguments,
                StopSignal& signal) {
  print(stdout, "{:<12} {:>7} {:>12}  {:>14}  {:>9}\n", "obeys", "strokes", "full speed",
        "nearest moving", "nearest m");
  const std::pair<const char*, stops::Obeyed> kinds[] = {
      {"zones", stops::Obeyed::kZones},
      {"S_p", stops::Obeyed::kSeparation},
      {"stops", stops::Obeyed::kStops},
  };
  for (const auto& [name, obeyed] : kinds) {
    arguments.stops.obeyed = obeyed;
    const stops::RunResult result =
        stops::run(cell, connection, arguments.stops, [&signal] { return !signal.wait(0); });
    if (!result.heard)
      return no_answer(connection,
                       "reports came; does clearanced run, with config/cells/stops.yaml,");
    print_row(name, result);
  }
  return kOk;
}

// A gripper and a torch come and go while a person walks past.
int change_tools(const Cell& cell, client::Connection& connection, Arguments& arguments,
                 StopSignal& signal) {
  const tools::RunResult result =
      tools::run(cell, connection, arguments.tools, [&signal] { return !signal.wait(0); });
  if (!result.refusal.empty()) {
    print(stderr, "example_arm: a command was refused: {}\n", result.refusal);
    return kRefused;
  }
  if (!result.heard) {
    return no_answer(connection,
                     "reports or results came; does clearanced run, with config/cells/tools.yaml,");
  }
  const std::vector<double>& ms = result.commands_ms;
  print(stdout, "{:>7} {:>8} {:>6} {:>7}  {:>14} {:>5}  {:>9}  {:<20} {:>21}\n", "changes",
        "reports", "missed", "unknown", "bounds checked", "false", "nearest m", "pair",
        "change ms, p50 / max");
  print(stdout, "{:>7} {:>8} {:>6} {:>7}  {:>14} {:>5}  {:>9.4f}  {:<20} {:>12.1f} / {:<6.1f}\n",
        result.changes, result.reports, result.missed, result.unknown, result.compared,
        result.wrong, result.least_distance_m, result.nearest, ms[ms.size() / 2], ms.back());
  return kOk;
}

// A person walks up to the arm and reaches out, leaves, and comes again.
int work_beside_people(const Cell& cell, client::Connection& connection, Arguments& arguments,
                       StopSignal& signal) {
  const people::RunResult result =
      people::run(cell, connection, arguments.people, [&signal] { return !signal.wait(0); });
  if (!result.heard) {
    return no_answer(connection,
                     "reports came; does clearanced run, with config/cells/people.yaml,");
  }
  const std::vector<double>& below = result.below_truth_m;
  print(stdout, "{:>7} {:>6} {:>6}  {:>14} {:>5}  {:>9}  {:<26} {:>22}\n", "reports", "missed",
        "bodies", "bounds checked", "false", "nearest m", "pair", "truth - lower, median m");
  print(stdout, "{:>7} {:>6} {:>6}  {:>14} {:>5}  {:>9.4f}  {:<26} {:>22.4f}\n", result.reports,
        result.missed, result.bodies, result.compared, result.wrong, result.least_distance_m,
        result.nearest, below.empty() ? 0.0 : below[below.size() / 2]);
  return kOk;
}

const char* name_of(jog::Decision decision) {
  switch (decision) {
    case jog::Decision::kMade:
      return "made";
    case jog::Decision::kSlowed:
      return "slowed";
    case jog::Decision::kRefused:
      break;
  }
  return "refused";
}

// The daemon says of each jog of an operator how near it comes. The arm makes it, slows it down, or
// refuses it.
int ask_each(client::Connection& connection, const Arguments& arguments, StopSignal& signal) {
  print(stdout, "{:<6} {:<8} {:>9} {:>8}  {}\n", "jog", "decision", "nearest m", "asked ms",
        "reason");
  const jog::RunResult result = jog::run(
      connection, arguments.speed,
      [](const jog::Jog& each) {
        print(stdout, "{:<6} {:<8} {:>9.4f} {:>8.2f}  {}\n", each.name, name_of(each.decision),
              each.lower_m, each.asked_ms, each.reason);
        std::fflush(stdout);
      },
      [&signal] { return !signal.wait(0); });
  if (!result.heard) {
    return no_answer(connection,
                     "reports or answers came; does clearanced run, with --questions \"" +
                         std::string(jog::kClient) + "\",");
  }
  print(stdout,
        "{} jogs made, {} slowed, {} refused; the least distance in all certified reports is at "
        "least {:.4f} "
        "m\n",
        result.made, result.slowed, result.refused, result.least_lower_m);
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  Arguments arguments;
  CommandLine line{
      "An arm beside the daemon that avoids obstacles, carries a part, asks first, "
      "stops for a person, changes its tool, or works beside a tracked person.",
      kFooter};
  line.subcommands = {
      kind(arguments, "avoid",
           "Follows a path past moving obstacles, without and with keeping away from them",
           {{"--seconds", &arguments.avoid.seconds, "Length of each run", number_in(2.0, 3600.0),
             shown()},
            {"--keep", &arguments.avoid.controller.keep_m, "Distance that is kept, m",
             number_in(0.0, 1.0), shown()}}),
      kind(arguments, "pick",
           "Carries a part over a wall, without and with telling the daemon what the arm holds",
           {{"--speed", &arguments.pick.speed, "Speed of the motion; 1: about 10 s a run",
             number_in(0.1, 3.0), shown()}}),
      kind(arguments, "ask", "Jogs past a wall, and asks the daemon before each jog",
           {{"--speed", &arguments.speed, "Speed of the jogs; 1: about 10 s in all",
             number_in(0.1, 5.0), shown()}}),
      kind(arguments, "stops",
           "Works beside a person: by distance zones, by S_p, and by how it stops",
           {{"--seconds", &arguments.stops.seconds, "Length of each run", number_in(2.0, 3600.0),
             shown()}}),
      kind(arguments, "tools", "Attaches and detaches a gripper and a torch beside a person",
           {{"--changes", &arguments.tools.changes, "Tools that come or go", number_in(1.0, 1e6),
             shown()}}),
      kind(arguments, "people",
           "Works beside a person whose motion was recorded, as a tracker of ROS4HRI tells it",
           {{"--seconds", &arguments.people.seconds, "Length of the run", number_in(2.0, 3600.0),
             shown()},
            {"--motion", &arguments.people.motion, "A BVH file; none: a motion that is made up"},
            {"--metres", &arguments.people.metres, "The unit of its lengths, m",
             number_in(1e-4, 10.0), shown()}}),
  };
  if (const auto done = parse(line, argc, argv)) return *done;
  start_log("example_arm", "error");
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(*cell), cell->topics);
  if (line.chosen == "avoid") return avoid_twice(*cell, connection, arguments, signal);
  if (line.chosen == "pick") return pick_twice(connection, arguments, signal);
  if (line.chosen == "stops") return stop_thrice(*cell, connection, arguments, signal);
  if (line.chosen == "people") return work_beside_people(*cell, connection, arguments, signal);
  if (line.chosen == "tools") return change_tools(*cell, connection, arguments, signal);
  return ask_each(connection, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "example_arm", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
