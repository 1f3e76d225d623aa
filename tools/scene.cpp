// clearance-scene writes cell files of a robot or of a generated warehouse. It also proposes the
// pairs of a robot's links that may touch, and reports the models of objects.
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
  1  a file could not be read or written, or errors do not explain what was measured
  2  wrong usage
  3  the cell that was written or read has errors (printed)
  4, 6  see 'send --help'

Examples:
  clearance-scene new --robots panda.urdf --on table,person -o panda.yaml
  clearance-scene new --robots left.urdf,ur.urdf.xacro --xacro name:=ur --xacro ur_type:=ur5e
  clearance-scene import panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml
  clearance-scene allow panda.urdf -o panda.srdf
  clearance-scene warehouse 1000 -o warehouse.yaml
  clearance-scene report warehouse.yaml
  clearance-scene errors cell.yaml --joint left_elbow=1.2
  clearance-scene stops cell.yaml --plot stops.svg
  clearance-scene send --change 'attach: {object: part, to: left_hand}')";

std::vector<Option> robot_options(RobotCellOptions& robot, const char* srdf) {
  return {
      {"URDF", &robot.urdf, "The robot's URDF, with xacro expanded", existing_file(), required()},
      {"--srdf", &robot.srdf, srdf, existing_file()},
      packages_option(robot.packages)};
}

CommandLine import_line(ImportArguments& arguments) {
  RobotCellOptions& robot = arguments.robot;
  CommandLine line{
      .about =
          "Write a cell file in which each link of a robot is an object, whose pose has to "
          "arrive, from its URDF (collision shapes) and SRDF",
      .footer =
          "Example:\n  clearance-scene import panda.urdf --srdf panda.srdf --max-speed 3 -o "
          "panda.yaml",
      .name = "import"};
  line.add(robot_options(robot,
                         "The robot's SRDF, which disables pairs, with reasons; without it, pairs "
                         "of links that a joint connects are left out"));
  line.add({
      {"-o,--output", &arguments.output, "The cell file to write; mesh paths are relative to it",
       required()},
      {"--max-speed", &robot.max_speed,
       "Speed that no point of the robot exceeds, m/s; without it, bounds are unknown while poses "
       "are late",
       number_from_zero()},
      {"--age-limit-ms", &robot.age_limit_ms, "Maximum age of a pose, ms", positive_number(),
       shown()},
      force_option(arguments.force),
  });
  return line;
}

CommandLine new_line(NewArguments& arguments) {
  const auto are_bodies = [](const std::string& list) {
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t comma = std::min(list.find(',', at), list.size());
      const std::string body = list.substr(at, comma - at);
      const auto known = {"table", "machine", "person", "camera"};
      if (std::ranges::find(known, body) == known.end()) return false;
      at = comma + 1;
    }
    return true;
  };
  const auto is_argument = [](const std::string& text) {
    const std::size_t mark = text.find(":=");
    return mark != std::string::npos && mark > 0 && text.front() != '-';
  };
  return {
      .about =
          "Write a commented cell of robots that joint states drive, side by side, to start from. "
          "An SRDF beside the URDF says which links may touch; without one, 'allow' proposes it",
      .footer =
          "Example:\n  clearance-scene new --robots panda.urdf --on table,person -o bench.yaml",
      .name = "new",
      .options = {
          {"--robots", &arguments.robots,
           "URDF files with commas between, also one file twice; A.urdf,A.srdf names an SRDF that "
           "is elsewhere. The program xacro expands a file that ends with .xacro, beside the cell",
           required()},
          {"--on", &arguments.bodies,
           "Bodies that the cell has, with commas between: a table that the robots stand on, a "
           "machine with a door, a person, a depth camera",
           expecting("a list of table, machine, person and camera, such as table,person",
                     are_bodies)},
          {"-o,--output", &arguments.output,
           "The cell file to write; paths in it are relative to it", shown()},
          {"--xacro", &arguments.xacro, "NAME:=VALUE, an argument for xacro; repeatable",
           expecting("NAME:=VALUE", is_argument)},
          packages_option(arguments.packages),
          force_option(arguments.force),
      }};
}

CommandLine allow_line(AllowArguments& arguments) {
  CommandLine line{
      .about =
          "Propose which pairs of a robot's links need not be watched, by sampling its joints: "
          "pairs that are adjacent, in contact with all joints at zero, always in contact, or "
          "never within --never-margin. 'Never' is what the samples show and no proof",
      .footer = "Example:\n  clearance-scene allow panda.urdf -o panda.srdf",
      .name = "allow"};
  line.add(robot_options(arguments.robot, "Also print where this SRDF agrees with the proposal"));
  line.add({
      {"-o,--output", &arguments.output, "Write the proposal here; default: stdout"},
      {"--samples", &arguments.sampling.samples, "Number of joint positions to try",
       whole_number(1, 1'000'000'000), shown()},
      {"--never-margin", &arguments.never_margin,
       "Propose 'Never' only for pairs that stay farther apart than this in all samples, m; nearer "
       "ones are listed on stderr and stay watched",
       number_from_zero(), shown()},
      {"--seed", &arguments.sampling.seed, "Random seed of the positions", shown()},
      {"--as", &arguments.form,
       "srdf: <disable_collisions> lines; cell: the allowed_collisions of a cell",
       one_word_of({"srdf", "cell"}), shown()},
      force_option(arguments.force),
  });
  return line;
}

CommandLine warehouse_line(WarehouseArguments& arguments) {
  return {.about = "Generate the cell of a warehouse, with a simulation",
          .footer = "Example:\n  clearance-scene warehouse 1000 -o warehouse.yaml",
          .name = "warehouse",
          .options = {
              {"OBJECTS", &arguments.warehouse.objects, "Number of objects, 60 to 4096",
               whole_number_in(kLeastWarehouse, 4096), required()},
              {"-o,--output", &arguments.output, "The cell file to write", required()},
              {"--seed", &arguments.warehouse.seed, "Random seed", shown()},
              force_option(arguments.force),
          }};
}

CommandLine report_line(ReportArguments& arguments) {
  return {.about = "Print the models of each object of a cell: facets, certified errors, memory",
          .footer = "Example:\n  clearance-scene report warehouse.yaml",
          .name = "report",
          .options = {{"CELL", &arguments.cell, "The cell file (YAML)", required()},
                      {"--json", &arguments.json, "Print JSON"}}};
}

CommandLine errors_line(ErrorsArguments& arguments) {
  return {
      .about =
          "Print what the stated errors of a cell do in one posture, and by which joint, "
          "base or mount; or whether they explain measured places",
      .footer = "Example:\n  clearance-scene errors cell.yaml --joint left_elbow=1.2",
      .name = "errors",
      .options = {
          {"CELL", &arguments.cell, "The cell file (YAML)", required()},
          {"--joint", &arguments.joints,
           "NAME=POSITION, rad or m: where a joint is; repeatable. Others are at zero"},
          {"--measured", &arguments.measured,
           "CSV with joint positions and places that were measured: columns by the joints' "
           "names (rad or m), and x, y, z (m, in the world). Exit status 1 if the stated errors "
           "do not explain all",
           needing("--link")},
          {"--link", &arguments.link, "The link whose origin was there", needing("--measured")},
      }};
}

CommandLine stops_line(StopsArguments& arguments) {
  return {.about =
              "Print how far and how long each joint goes on once its robot is to stop, by what "
              "the cell states",
          .footer = "Example:\n  clearance-scene stops cell.yaml --plot stops.svg",
          .name = "stops",
          .options = {{"CELL", &arguments.cell, "The cell file (YAML)", required()},
                      {"--plot", &arguments.plot, "SVG of distances over speeds, by gnuplot"}}};
}

int run(int argc, char** argv) {
  NewArguments fresh;
  ImportArguments import;
  AllowArguments allow;
  WarehouseArguments warehouse;
  ErrorsArguments errors;
  StopsArguments stops;
  ReportArguments report;
  SendArguments send;
  CommandLine line{"Writes cell files, reports the models of objects, and changes running scenes.",
                   kFooter};
  line.subcommands = {new_line(fresh),           import_line(import), allow_line(allow),
                      warehouse_line(warehouse), report_line(report), errors_line(errors),
                      stops_line(stops),         send_line(send)};
  if (const auto done = parse(line, argc, argv)) return *done;
  if (line.chosen == "new") return new_cell(fresh);
  if (line.chosen == "import") return import_robot(std::move(import));
  if (line.chosen == "allow") return allow_collisions(allow);
  if (line.chosen == "warehouse") return make_warehouse(warehouse);
  if (line.chosen == "errors") return report_errors(errors);
  if (line.chosen == "stops") return report_stops(stops);
  if (line.chosen == "report") return report_models(report);
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
