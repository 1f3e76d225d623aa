// clearance-scene: writes cell files, of a robot from its URDF and SRDF or of a generated
// warehouse, and reports the models of a cell's objects.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "config/robot_cell.hpp"
#include "config/warehouse_cell.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/scene/model_report.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  done; a cell that was written is a good one
  1  a file could not be read or written
  2  wrong usage
  3  the cell that was written, or is to be reported on, has errors (printed)

Examples:
  clearance-scene --from-urdf panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml
  clearance-scene --warehouse 1000 -o warehouse.yaml
  clearance-scene --report warehouse.yaml)";

struct Arguments {
  RobotCellOptions robot;
  std::vector<std::string> packages;
  WarehouseOptions warehouse;
  std::string output, report;
  bool json = false, force = false;
};

// Parses the NAME=DIRECTORY of --package; false when it is something else.
bool add_package(const std::string& argument, RobotCellOptions& options) {
  const std::size_t equals = argument.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == argument.size()) return false;
  options.packages.emplace_back(argument.substr(0, equals), argument.substr(equals + 1));
  return true;
}

int write(const std::string& yaml, const std::string& output) {
  std::ofstream stream(output, std::ios::binary);
  stream << yaml;
  stream.close();
  if (!stream) {
    print(stderr, "{}: cannot be written: {}\n", output, std::strerror(errno));
    return kFailed;
  }
  const auto scene = scene_or_errors(read_cell(output));
  if (!scene) return kBadCell;
  print(stdout, "{}: {}\n", output, summary(*scene));
  return kOk;
}

int make_robot_cell(RobotCellOptions options, const std::string& output) {
  options.directory = std::filesystem::absolute(output).parent_path();
  const auto result = robot_cell(options);
  if (const auto* faults = std::get_if<UrdfFaults>(&result)) {
    for (const UrdfFault& fault : *faults) print(stderr, "{}\n", fault.text);
    return kFailed;
  }
  const RobotCell& cell = std::get<RobotCell>(result);
  for (const std::string& note : cell.notes) print(stderr, "note: {}\n", note);
  return write(cell.yaml, output);
}

int report(const std::string& cell, bool json) {
  const auto scene = scene_or_errors(read_cell(cell));
  if (!scene) return kBadCell;
  print(stdout, "{}", json ? model_json(*scene) : model_table(*scene));
  return kOk;
}

void add_options(CLI::App& app, Arguments& arguments) {
  RobotCellOptions& robot = arguments.robot;
  auto* what = app.add_option_group("What to do", "exactly one of:");
  auto* urdf = what->add_option("--from-urdf", robot.urdf, "The robot's URDF, with xacro expanded")
                   ->check(CLI::ExistingFile);
  auto* warehouse = what->add_option("--warehouse", arguments.warehouse.objects,
                                     "Generate a warehouse of this many objects, with a simulation")
                        ->check(CLI::Range(kLeastWarehouse, 4096u));
  auto* report = what->add_option(
      "--report", arguments.report,
      "Print the models of each object of this cell: facets, certified errors, memory");
  what->require_option(1);
  app.add_option("-o,--output", arguments.output,
                 "The cell file to write; mesh paths are relative to it")
      ->excludes(report);
  app.add_option("--srdf", robot.srdf,
                 "The robot's SRDF, which disables pairs, with reasons; without it, links that a "
                 "joint joins are left out")
      ->check(CLI::ExistingFile)
      ->needs(urdf);
  app.add_option("--package", arguments.packages,
                 "NAME=DIRECTORY of a package:// that is not above the URDF; repeatable")
      ->needs(urdf);
  app.add_option("--group", robot.group, "Group of all links; by default the robot's name")
      ->needs(urdf);
  app.add_option("--max-speed", robot.max_speed,
                 "Speed that no point of the robot exceeds, m/s; without it, bounds are unknown "
                 "while poses "
                 "are late")
      ->check(number_from_zero())
      ->needs(urdf);
  app.add_option("--age-limit-ms", robot.age_limit_ms, "Maximum age of a pose, ms")
      ->check(positive_number())
      ->capture_default_str()
      ->needs(urdf);
  app.add_flag("--fixed-base", robot.fixed_base,
               "The root link stands at the world's origin, and no pose arrives for it")
      ->needs(urdf);
  app.add_option("--seed", arguments.warehouse.seed, "Random seed of the generated warehouse")
      ->capture_default_str()
      ->needs(warehouse);
  app.add_flag("--json", arguments.json, "Print the report as JSON")->needs(report);
  add_force(app, arguments.force);
  app.footer(kFooter);
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Writes cell files: of a robot from its URDF (collision shapes) and SRDF (disabled pairs), "
      "or "
      "of a generated warehouse. Reports the models of a cell's objects."};
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  for (const std::string& package : arguments.packages) {
    if (add_package(package, arguments.robot)) continue;
    print(stderr, "--package {}: expected NAME=DIRECTORY\n", package);
    return kUsage;
  }
  if (!arguments.report.empty()) return report(arguments.report, arguments.json);
  if (arguments.output.empty()) {
    print(stderr, "--output is missing: it names the cell file to write\n");
    return kUsage;
  }
  if (!output_is_not_an_input("clearance-scene", arguments.output,
                              {arguments.robot.urdf, arguments.robot.srdf})) {
    return kUsage;
  }
  if (!can_create("clearance-scene", arguments.output, arguments.force)) return kFailed;
  if (arguments.robot.urdf.empty()) {
    return write(warehouse_cell(arguments.warehouse), arguments.output);
  }
  return make_robot_cell(std::move(arguments.robot), arguments.output);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) { return clearance::run(argc, argv); }
