// An example of a program that tells the daemon what its arm holds. The arm carries a part twice,
// without and with commands that say so. A table shows what the daemon reports.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/examples/picking_arm/run.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  both runs were made
  1  something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  stopped, or the daemon did not answer
  6  the daemon refused a command

Example, beside clearanced config/cells/pick.yaml --partition lab:
  build/bin/picking_arm config/cells/pick.yaml --partition lab)";

struct Arguments {
  CellArguments cell;
  pick::RunOptions run;
  DdsArguments dds;
};

void print_row(const char* name, const pick::RunResult& result) {
  print(stdout, "{:<16} {:>9.4f} {:>12.4f}  {:<20} {:>12} {:>12.1f}\n", name,
        result.least_distance_m, result.least_lower_m, result.nearest, result.entered,
        1e3 * result.slowest_command_s);
  std::fflush(stdout);
}

int run_both(const Cell& cell, Arguments& arguments, StopSignal& signal) {
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(cell), cell.topics);
  print(stdout, "{:<16} {:>9} {:>12}  {:<20} {:>12} {:>12}\n", "payload", "nearest m",
        "certified m", "pair", "zone entries", "command ms");
  for (const bool tells : {false, true}) {
    arguments.run.tells = tells;
    const pick::RunResult result =
        pick::run(connection, arguments.run, [&signal] { return !signal.wait(0); });
    if (!result.refusal.empty()) {
      print(stderr, "picking_arm: a command was refused: {}\n", result.refusal);
      return kRefused;
    }
    if (!result.heard) {
      print(stderr,
            "picking_arm: stopped, or no reports or results came on {}; does clearanced run there "
            "with config/cells/pick.yaml?\n",
            connection.where());
      return kIncomplete;
    }
    print_row(tells ? "known" : "not known", result);
  }
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CLI::App app(
      "Carries a part over a wall, without and with telling the daemon what the arm holds.");
  Arguments arguments;
  arguments.cell.add_to(app);
  app.add_option("--speed", arguments.run.speed, "Speed of the motion; 1: about 10 s a run")
      ->check(CLI::Range(0.1, 3.0))
      ->capture_default_str();
  arguments.dds.add_to(app);
  app.footer(kFooter);
  if (const auto done = parse(app, argc, argv)) return *done;
  start_log("picking_arm", "error");
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  return run_both(*cell, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "picking_arm", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
