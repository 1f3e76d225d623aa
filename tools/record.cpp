// clearance-record: records Clearance's topics, or converts a pose log kept as CSV, to an MCAP
// file.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/program.hpp"
#include "tools/record/arguments.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  the recording is complete
  1  the recording is incomplete, or nothing was received; the message says why. SIGINT and SIGTERM end a recording
     from DDS in order; they interrupt --from-csv, which then removes its output
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined

A pose log has a header line that names t_ns,object,px,py,pz,qw,qx,qy,qz in any order (other columns are
ignored), then a line a pose: poses of the object's frame in the world, m, times in ns, not going back.
With --cell, every object must be in the cell; without, clearance-replay finds them by name.

Examples:
  clearance-record -o run.mcap --cell cell.yaml
  clearance-record -o run.mcap --cell cell.yaml --scene
  clearance-record -o run.mcap --domain 7 --partition lab --seconds 60
  clearance-record --from-csv poses.csv.gz -o run.mcap --cell cell.yaml)";

int run(int argc, char** argv, StopSignal& stop) {
  CLI::App app("Records every topic of Clearance, as it is on the wire, to an MCAP file.");
  RecordArguments arguments;
  app.add_option("-o,--output", arguments.out, "The recording to write")->required();
  CLI::Option* const cell = app.add_option(
      "--cell", arguments.cell, "The cell file, which names domain, partition, topics and objects");
  CLI::Option* const csv =
      app.add_option("--from-csv", arguments.from_csv,
                     "Convert this pose log, plain or gzip, instead of recording from DDS");
  app.add_option("--seconds", arguments.seconds,
                 "Stop after this many seconds; otherwise on Ctrl-C")
      ->check(positive_number())
      ->excludes(csv);
  app.add_flag("--scene", arguments.scene,
               "Record the scene as well, as ROS 2 transforms and markers at 60 Hz: /tf, "
               "/clearance/bodies, /clearance/closest. Foxglove, Lichtblick and their like then "
               "show the recording in 3D")
      ->needs(cell)
      ->excludes(csv);
  add_force(app, arguments.force);
  arguments.dds.add_to(app);
  app.footer(kFooter);
  if (const auto done = parse(app, argc, argv)) return *done;
  if (!output_is_not_an_input("clearance-record", arguments.out,
                              {arguments.from_csv, arguments.cell}))
    return kUsage;
  if (!can_create("clearance-record", arguments.out, arguments.force)) return kFailed;
  const bool from_csv = !arguments.from_csv.empty();
  std::optional<Scene> scene;
  if (!arguments.cell.empty()) {
    scene = scene_or_errors(read_cell(arguments.cell));
    if (!scene) return kBadCell;
  }
  const Scene* const known = scene ? &*scene : nullptr;
  return from_csv ? record_from_csv(arguments, known, stop)
                  : record_from_dds(arguments, known, stop);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-record", [=](auto& stop) { return clearance::run(argc, argv, stop); },
      clearance::dds_exit_code);
}
