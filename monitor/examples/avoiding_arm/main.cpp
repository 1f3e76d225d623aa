// An example of a controller that keeps its arm away from moving obstacles by the daemon's
// gradients. Its hand follows a path twice, without and with avoidance, while the obstacles make
// the same motion. A table shows what avoidance costs.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/client/client.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/examples/avoiding_arm/run.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  both runs were made
  1  something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  stopped, or the daemon did not answer with gradients

Example, beside clearanced config/cells/avoid.yaml --partition lab:
  build/bin/avoiding_arm config/cells/avoid.yaml --partition lab)";

struct Arguments {
  CellArguments cell;
  avoid::RunOptions run;
  DdsArguments dds;
};

void add_options(CLI::App& app, Arguments& arguments) {
  arguments.cell.add_to(app);
  app.add_option("--seconds", arguments.run.seconds, "Length of each run")
      ->check(CLI::Range(2.0, 3600.0))
      ->capture_default_str();
  app.add_option("--keep", arguments.run.controller.keep_m, "Distance that is kept, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  arguments.dds.add_to(app);
  app.footer(kFooter);
}

void print_row(const char* name, const avoid::RunResult& result) {
  print(stdout, "{:<18} {:>9.4f}  {:>9.4f} / {:<9.4f} {:>7}  {}\n", name, result.least_distance_m,
        result.mean_error_m, result.largest_error_m, result.steps, result.nearest);
  std::fflush(stdout);
}

int run_both(const Cell& cell, Arguments& arguments, StopSignal& signal) {
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(cell), cell.topics);
  print(stdout, "{:<18} {:>9}  {:>21} {:>7}\n", "", "nearest m", "task error m, mean / max",
        "steps");
  for (const bool avoids : {false, true}) {
    arguments.run.controller.avoids = avoids;
    const avoid::RunResult result =
        avoid::run(cell, connection, arguments.run, [&signal] { return !signal.wait(0); });
    if (!result.heard) {
      print(stderr,
            "avoiding_arm: stopped, or no gradients came on {}; does clearanced run there, with "
            "'gradients: true' in its cell or --gradients?\n",
            connection.where());
      return kIncomplete;
    }
    print_row(avoids ? "with avoidance" : "without avoidance", result);
  }
  return kOk;
}

int run(int argc, char** argv, StopSignal& signal) {
  CLI::App app(
      "Moves a redundant arm along a path past moving obstacles, without and with avoidance.");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  start_log("avoiding_arm", "error");
  const auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  return run_both(*cell, arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "avoiding_arm", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
