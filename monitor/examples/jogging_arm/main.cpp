// An example of a program that asks before it moves. An operator jogs an arm; the daemon says of
// each jog how near it comes, and the program makes it, slows it down, or refuses it.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/examples/jogging_arm/run.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  all jogs were decided
  1  something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  stopped, or the daemon did not answer

Example, beside clearanced config/cells/pick.yaml --questions "jogging arm" --partition lab:
  build/bin/jogging_arm config/cells/pick.yaml --partition lab)";

struct Arguments {
  CellArguments cell;
  double speed = 1.0;
  DdsArguments dds;
};

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

int run_jogs(const Cell& cell, const Arguments& arguments, StopSignal& signal) {
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(cell), cell.topics);
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
    print(stderr,
          "jogging_arm: stopped, or no reports or answers came on {}; does clearanced run there "
          "with --questions \"{}\"?\n",
          connection.where(), jog::kClient);
    return kIncomplete;
  }
  print(stdout,
        "{} jogs made, {} slowed, {} refused; the least distance in all reports is at least {:.4f} "
        "m\n",
        result.made, result.slowed, result.refused, result.least_lower_m);
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CLI::App app("Jogs an arm past a wall, and asks the daemon before each jog.");
  Arguments arguments;
  arguments.cell.add_to(app);
  app.add_option("--speed", arguments.speed, "Speed of the jogs; 1: about 10 s in all")
      ->check(CLI::Range(0.1, 5.0))
      ->capture_default_str();
  arguments.dds.add_to(app);
  app.footer(kFooter);
  if (const auto done = parse(app, argc, argv)) return *done;
  start_log("jogging_arm", "error");
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  return run_jogs(*cell, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "jogging_arm", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
