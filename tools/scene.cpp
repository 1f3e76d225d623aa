// clearance-scene: makes the cell file of a robot from its URDF and SRDF, and checks it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "config/robot_cell.hpp"
#include "monitor/daemon/program.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  the cell was written, and is a good one
  1  a file could not be read or written
  2  wrong usage
  3  the cell was written, and has errors (printed)

Example:
  clearance-scene --from-urdf panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml)";

// The NAME=DIRECTORY of --package.
bool add_package(const std::string& argument, RobotCellOptions& options) {
  const std::size_t equals = argument.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == argument.size()) return false;
  options.packages.emplace_back(argument.substr(0, equals), argument.substr(equals + 1));
  return true;
}

int check(const std::string& output) {
  const auto scene = scene_or_errors(read_cell(output));
  if (!scene) return kBadCell;
  std::printf("%s: %s\n", output.c_str(), summary(*scene).c_str());
  return kOk;
}

int run(RobotCellOptions options, const std::string& output) {
  options.directory = std::filesystem::absolute(output).parent_path();
  const auto result = robot_cell(options);
  if (const auto* fault = std::get_if<UrdfFault>(&result)) {
    std::fprintf(stderr, "%s\n", fault->text.c_str());
    return kFailed;
  }
  const RobotCell& cell = std::get<RobotCell>(result);
  std::ofstream stream(output, std::ios::binary);
  stream << cell.yaml;
  stream.close();
  if (!stream) {
    std::fprintf(stderr, "%s: cannot be written\n", output.c_str());
    return kFailed;
  }
  for (const std::string& note : cell.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  return check(output);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  using namespace clearance;
  RobotCellOptions options;
  std::string output;
  std::vector<std::string> packages;
  bool force = false;
  CLI::App app{
      "Makes the cell file of a robot from its URDF (collision shapes) and SRDF (disabled pairs)."};
  app.footer(kFooter);
  app.add_option("--from-urdf", options.urdf, "The robot's URDF, with xacro expanded")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--srdf", options.srdf, "The robot's SRDF: its disabled pairs, with their reasons")
      ->check(CLI::ExistingFile);
  app.add_option("-o,--output", output, "The cell file to write; meshes are named relative to it")
      ->required();
  app.add_option("--package", packages,
                 "NAME=DIRECTORY of a package:// that is not above the URDF; may be repeated");
  app.add_option("--group", options.group, "The group of all links; else the robot's name");
  app.add_option(
         "--max-speed", options.max_speed,
         "m/s that no point of the robot exceeds; bounds go unknown without it when poses are late")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--age-limit-ms", options.age_limit_ms, "How old a pose may be")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--fixed-base", options.fixed_base,
               "The root link stands at the world's origin, and no pose arrives for it");
  add_force(app, force);
  if (const auto done = parse(app, argc, argv)) return *done;
  for (const std::string& package : packages) {
    if (add_package(package, options)) continue;
    std::fprintf(stderr, "--package %s: expected NAME=DIRECTORY\n", package.c_str());
    return kUsage;
  }
  if (!may_write("clearance-scene", output, force)) return kFailed;
  return run(std::move(options), output);
}
