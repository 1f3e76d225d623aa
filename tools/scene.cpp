// clearance-scene writes cell files of a robot or of a generated warehouse. It also proposes the
// pairs of a robot's links that may touch, and reports the models of objects.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/scene/arguments.hpp"
#include "tools/scene/send.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  done; a cell that was written has no errors
  1  a file could not be read or written
  2  wrong usage
  3  the cell that was written or read has errors (printed)
  4, 6  see 'send --help'

Examples:
  clearance-scene import panda.urdf --srdf panda.srdf --joints -o panda.yaml
  clearance-scene import panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml
  clearance-scene allow panda.urdf -o panda.srdf
  clearance-scene warehouse 1000 -o warehouse.yaml
  clearance-scene report warehouse.yaml
  clearance-scene send --change 'attach: {object: part, to: left_hand}')";

void add_robot(CLI::App& app, RobotCellOptions& robot, const char* srdf) {
  app.add_option("URDF", robot.urdf, "The robot's URDF, with xacro expanded")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--srdf", robot.srdf, srdf)->check(CLI::ExistingFile);
  add_packages(app, robot.packages);
}

CLI::App* add_import(CLI::App& app, ImportArguments& arguments) {
  CLI::App* const import = app.add_subcommand(
      "import", "Write a cell file of a robot from its URDF (collision shapes) and SRDF");
  RobotCellOptions& robot = arguments.robot;
  add_robot(*import, robot,
            "The robot's SRDF, which disables pairs, with reasons; without it, pairs of links that "
            "a joint connects are left out");
  import
      ->add_option("-o,--output", arguments.output,
                   "The cell file to write; mesh paths are relative to it")
      ->required();
  CLI::Option* const max_speed =
      import
          ->add_option(
              "--max-speed", robot.max_speed,
              "Speed that no point of the robot exceeds, m/s; without it, bounds are unknown "
              "while poses are late")
          ->check(number_from_zero());
  import->add_option("--age-limit-ms", robot.age_limit_ms, "Maximum age of a pose, ms")
      ->check(positive_number())
      ->capture_default_str();
  import
      ->add_option("--mesh-tolerance", robot.mesh_tolerance,
                   "Aim for the error of a mesh's convex parts, m; default 0.005")
      ->check(positive_number());
  import
      ->add_option("--max-parts", robot.max_parts,
                   "Largest number of parts per mesh; default 24; 1: one hull per mesh")
      ->check(CLI::Range(1u, 64u));
  CLI::Option* const joints = import->add_flag(
      "--joints", arguments.joints,
      "Write the cell of a robot that joint states drive, as clearanced --urdf runs it, to start "
      "from. Without it, each link is an object, and its pose has to arrive");
  joints->excludes(max_speed);
  add_force(*import, arguments.force);
  return import;
}

CLI::App* add_allow(CLI::App& app, AllowArguments& arguments) {
  CLI::App* const allow = app.add_subcommand(
      "allow",
      "Propose which pairs of a robot's links need not be watched, by sampling its joints: pairs "
      "that are adjacent, in contact with all joints at zero, always in contact, or never within "
      "--never-margin. 'Never' is what the samples show and no proof");
  add_robot(*allow, arguments.robot, "Also print where this SRDF agrees with the proposal");
  allow->add_option("-o,--output", arguments.output, "Write the proposal here; default: stdout");
  allow->add_option("--samples", arguments.sampling.samples, "Number of joint positions to try")
      ->check(whole_number(1, 1'000'000'000))
      ->capture_default_str();
  allow
      ->add_option("--never-margin", arguments.never_margin,
                   "Propose 'Never' only for pairs that stay farther apart than this in all "
                   "samples, m; nearer ones are listed on stderr and stay watched")
      ->check(number_from_zero())
      ->capture_default_str();
  allow->add_option("--seed", arguments.sampling.seed, "Random seed of the positions")
      ->capture_default_str();
  allow
      ->add_option("--as", arguments.form,
                   "srdf: <disable_collisions> lines; cell: the allowed_collisions of a cell")
      ->check(CLI::IsMember({"srdf", "cell"}))
      ->capture_default_str();
  add_force(*allow, arguments.force);
  return allow;
}

CLI::App* add_warehouse(CLI::App& app, WarehouseArguments& arguments) {
  CLI::App* const warehouse =
      app.add_subcommand("warehouse", "Generate the cell of a warehouse, with a simulation");
  warehouse->add_option("OBJECTS", arguments.warehouse.objects, "Number of objects, 60 to 4096")
      ->required()
      ->check(CLI::Range(kLeastWarehouse, 4096u));
  warehouse->add_option("-o,--output", arguments.output, "The cell file to write")->required();
  warehouse->add_option("--seed", arguments.warehouse.seed, "Random seed")->capture_default_str();
  add_force(*warehouse, arguments.force);
  return warehouse;
}

CLI::App* add_report(CLI::App& app, ReportArguments& arguments) {
  CLI::App* const report = app.add_subcommand(
      "report", "Print the models of each object of a cell: facets, certified errors, memory");
  report->add_option("CELL", arguments.cell, "The cell file (YAML)")->required();
  report->add_flag("--json", arguments.json, "Print JSON");
  return report;
}

int run(int argc, char** argv) {
  CLI::App app("Writes cell files, reports the models of objects, and changes running scenes.");
  ImportArguments import;
  AllowArguments allow;
  WarehouseArguments warehouse;
  ReportArguments report;
  SendArguments send;
  const CLI::App* const importing = add_import(app, import);
  const CLI::App* const allowing = add_allow(app, allow);
  const CLI::App* const building = add_warehouse(app, warehouse);
  const CLI::App* const reporting = add_report(app, report);
  add_send(app, send);
  app.require_subcommand(1);
  app.footer(kFooter);
  if (const auto done = parse(app, argc, argv)) return *done;
  if (importing->parsed()) return import_robot(std::move(import));
  if (allowing->parsed()) return allow_collisions(allow);
  if (building->parsed()) return make_warehouse(warehouse);
  if (reporting->parsed()) return report_models(report);
  return send_changes(send);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  try {
    return clearance::run(argc, argv);
  } catch (const std::exception& error) {
    clearance::print(stderr, "clearance-scene: {}\n", error.what());
    return clearance::dds_exit_code(error);
  }
}
