// clearance-scene writes cell files of a robot or of a generated warehouse. It also proposes the
// pairs of a robot's links that may touch, and reports or simplifies the models of objects.
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
#include "tools/shared/former_spelling.hpp"

namespace clearance {
namespace {

constexpr const char* kProgram = "clearance-scene";

constexpr const char* kFooter = R"(Exit status:
  0  done; a cell that was written has no errors
  1  a file could not be read or written, or no model of 'reduce' is within --tolerance
  2  wrong usage
  3  the cell that was written or read has errors (printed)
  4, 6  see 'send --help'

Examples:
  clearance-scene import panda.urdf --srdf panda.srdf --joints -o panda.yaml
  clearance-scene import panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml
  clearance-scene import panda.urdf --max-speed 3 --add shelf.scene -o panda.yaml
  clearance-scene allow panda.urdf -o panda.srdf
  clearance-scene warehouse 1000 -o warehouse.yaml
  clearance-scene report warehouse.yaml
  clearance-scene reduce panda.urdf --tolerance 0.005
  clearance-scene reduce a.stl b.stl --distance 0.1 0.5 --speed 1 --plot models.svg
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
  CLI::Option* const group =
      import->add_option("--group", robot.group, "Group of all links; default: the robot's name");
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
  joints->excludes(group)->excludes(max_speed);
  import
      ->add_flag("--fixed-base", robot.fixed_base,
                 "The root link stands at the world's origin, and no pose arrives for it")
      ->excludes(joints);
  import
      ->add_option("--add", robot.scenes,
                   "A planning scene of MoveIt (.scene) whose obstacles the robot is watched "
                   "against; repeatable")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false)
      ->excludes(joints);
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

CLI::App* add_reduce(CLI::App& app, ReduceArguments& arguments) {
  CLI::App* const reduce = app.add_subcommand(
      "reduce",
      "Print simpler models around meshes, objects or links, with certified errors: a sphere, "
      "capsule, box, rounded box, cylinder, ellipsoid, polyhedra of 8, 16, 32, ... facets, the "
      "hull, and 2, 4, 8 and 16 parts");
  ReductionOptions& options = arguments.reduction;
  reduce
      ->add_option("FILE", options.files,
                   "Meshes; cells (.yaml) or robots (.urdf), of which each object or link is taken")
      ->required()
      ->check(CLI::ExistingFile);
  reduce->add_option("--object", options.object, "Only this object or link");
  CLI::Option* const tolerance =
      reduce
          ->add_option("--tolerance", options.tolerance,
                       "Choose the cheapest model whose error is at most this, m")
          ->check(number_from_zero());
  reduce
      ->add_option("--facets", options.facets,
                   "Choose the best polyhedron of at most this many facets")
      ->check(CLI::Range(6u, 4096u))
      ->excludes(tolerance);
  reduce->add_flag("--time", options.time, "Measure a query against each model, ns");
  CLI::Option* const distance =
      reduce
          ->add_option("--distance", options.distances,
                       "Distances beyond a zone's threshold at which to compare the costs of "
                       "models, m; measures queries")
          ->check(positive_number());
  reduce
      ->add_option("--speed", options.speed,
                   "Sum of the speeds of both objects, m/s; for --distance")
      ->check(positive_number())
      ->capture_default_str()
      ->needs(distance);
  reduce
      ->add_option("--plot", arguments.plot,
                   "Draw error against time (SVG, by gnuplot), and write the tables as Markdown "
                   "beside the picture")
      ->needs(distance);
  reduce->add_flag("--json", arguments.json, "Print JSON");
  add_force(*reduce, arguments.force);
  return reduce;
}

// An option that chose what to do before there were subcommands, with the number of its values.
struct FormerMode {
  const char* option;
  const char* subcommand;
  std::size_t values;
};
constexpr FormerMode kFormerModes[] = {{"--from-urdf", "import", 1},
                                       {"--warehouse", "warehouse", 1},
                                       {"--report", "report", 1},
                                       {"--reduce", "reduce", 1000}};

Words present_spelling(Words words) {
  if (words.empty() || !words[0].starts_with('-')) return words;
  for (const FormerMode& mode : kFormerModes) {
    if (!has_option(words, mode.option)) continue;
    const Words values = take_option(words, mode.option, mode.values);
    const bool allows = mode.option == kFormerModes[0].option && has_option(words, "--allow");
    if (allows) take_option(words, "--allow", 0);
    words.insert(words.begin(), values.begin(), values.end());
    return note_former_spelling(kProgram, mode.option, allows ? "allow" : mode.subcommand,
                                std::move(words));
  }
  return words;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Writes cell files, reports or simplifies the models of objects, and changes running "
      "scenes.");
  ImportArguments import;
  AllowArguments allow;
  WarehouseArguments warehouse;
  ReportArguments report;
  ReduceArguments reduce;
  SendArguments send;
  const CLI::App* const importing = add_import(app, import);
  const CLI::App* const allowing = add_allow(app, allow);
  const CLI::App* const building = add_warehouse(app, warehouse);
  const CLI::App* const reporting = add_report(app, report);
  const CLI::App* const reducing = add_reduce(app, reduce);
  add_send(app, send);
  app.require_subcommand(1);
  app.footer(kFooter);
  Words words = present_spelling(words_of(argc, argv));
  std::vector<char*> arguments = arguments_of(argv[0], words);
  if (const auto done = parse(app, static_cast<int>(arguments.size()), arguments.data())) {
    return *done;
  }
  if (importing->parsed()) return import_robot(std::move(import));
  if (allowing->parsed()) return allow_collisions(allow);
  if (building->parsed()) return make_warehouse(warehouse);
  if (reporting->parsed()) return report_models(report);
  if (reducing->parsed()) return reduce_bodies(reduce);
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
