// clearance-scene: makes cell files, from a robot's URDF and SRDF or of a generated warehouse, and
// tells what models a cell's objects have.
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

// The NAME=DIRECTORY of --package.
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
    std::fprintf(stderr, "%s: cannot be written: %s\n", output.c_str(), std::strerror(errno));
    return kFailed;
  }
  const auto scene = scene_or_errors(read_cell(output));
  if (!scene) return kBadCell;
  std::printf("%s: %s\n", output.c_str(), summary(*scene).c_str());
  return kOk;
}

int make_robot_cell(RobotCellOptions options, const std::string& output) {
  options.directory = std::filesystem::absolute(output).parent_path();
  const auto result = robot_cell(options);
  if (const auto* fault = std::get_if<UrdfFault>(&result)) {
    std::fprintf(stderr, "%s\n", fault->text.c_str());
    return kFailed;
  }
  const RobotCell& cell = std::get<RobotCell>(result);
  for (const std::string& note : cell.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  return write(cell.yaml, output);
}

int report(const std::string& cell, bool json) {
  const auto scene = scene_or_errors(read_cell(cell));
  if (!scene) return kBadCell;
  std::fputs((json ? model_json(*scene) : model_table(*scene)).c_str(), stdout);
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
                 "The cell file to write; meshes are named relative to it")
      ->excludes(report);
  app.add_option("--srdf", robot.srdf, "The robot's SRDF: its disabled pairs, with their reasons")
      ->check(CLI::ExistingFile)
      ->needs(urdf);
  app.add_option("--package", arguments.packages,
                 "NAME=DIRECTORY of a package:// that is not above the URDF; may be repeated")
      ->needs(urdf);
  app.add_option("--group", robot.group, "The group of all links; else the robot's name")
      ->needs(urdf);
  app.add_option(
         "--max-speed", robot.max_speed,
         "m/s that no point of the robot exceeds; bounds go unknown without it when poses are late")
      ->check(number_from_zero())
      ->needs(urdf);
  app.add_option("--age-limit-ms", robot.age_limit_ms, "How old a pose may be")
      ->check(positive_number())
      ->capture_default_str()
      ->needs(urdf);
  app.add_flag("--fixed-base", robot.fixed_base,
               "The root link stands at the world's origin, and no pose arrives for it")
      ->needs(urdf);
  app.add_option("--seed", arguments.warehouse.seed, "Of the warehouse: another seed, another one")
      ->capture_default_str()
      ->needs(warehouse);
  app.add_flag("--json", arguments.json, "The report as JSON")->needs(report);
  add_force(app, arguments.force);
  app.footer(kFooter);
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Makes cell files: of a robot from its URDF (collision shapes) and SRDF (disabled pairs), or "
      "of a generated warehouse. Tells what models a cell's objects have."};
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  for (const std::string& package : arguments.packages) {
    if (add_package(package, arguments.robot)) continue;
    std::fprintf(stderr, "--package %s: expected NAME=DIRECTORY\n", package.c_str());
    return kUsage;
  }
  if (!arguments.report.empty()) return report(arguments.report, arguments.json);
  if (arguments.output.empty()) {
    std::fputs("--output is missing: which file is to be written?\n", stderr);
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
