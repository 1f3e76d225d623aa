// clearance-scene: writes cell files, of a robot from its URDF and SRDF or of a generated
// warehouse, proposes which pairs of a robot may touch, and reports the models of a cell's objects.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "config/write/robot_cell.hpp"
#include "config/write/single_robot_cell.hpp"
#include "config/write/warehouse_cell.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/replay/progress_bar.hpp"
#include "tools/scene/allowed_collisions.hpp"
#include "tools/scene/model_report.hpp"
#include "tools/scene/reduction.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  done; a cell that was written is a good one
  1  a file could not be read or written
  2  wrong usage
  3  the cell that was written, or is to be reported on, has errors (printed)

Examples:
  clearance-scene --from-urdf panda.urdf --srdf panda.srdf --max-speed 3 -o panda.yaml
  clearance-scene --from-urdf panda.urdf --max-speed 3 --add shelf.scene -o panda.yaml
  clearance-scene --from-urdf panda.urdf --allow -o panda.srdf
  clearance-scene --warehouse 1000 -o warehouse.yaml
  clearance-scene --report warehouse.yaml
  clearance-scene --reduce panda.urdf --tolerance 0.005
  clearance-scene --reduce a.stl b.stl --distance 0.1 0.5 --speed 1 --plot models.svg)";

struct Arguments {
  RobotCellOptions robot;
  std::vector<std::string> packages;
  WarehouseOptions warehouse;
  ReductionOptions reduction;
  std::uint64_t seed = 1;
  SamplingOptions sampling;
  std::string output, report, form = "srdf", plot;
  bool json = false, force = false, allow = false;
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
  const auto cell = cell_or_errors(read_cell(output, told_on_stderr()));
  if (!cell) return kBadCell;
  print(stdout, "{}: {}\n", output, summary(cell->scene));
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

// Beside the SRDF that there is, if there is one: what both say.
int propose_allowed(const Arguments& arguments) {
  const RobotCellOptions& robot = arguments.robot;
  const auto cell =
      cell_or_errors(read_single_robot({.urdf = robot.urdf, .packages = robot.packages}));
  if (!cell) return kBadCell;
  const Scene& scene = cell->scene;
  ProgressBar bar(false);
  SamplingOptions options = arguments.sampling;
  options.seed = arguments.seed;
  options.progress = [&bar](double share) { bar.show(share, "positions of the joints"); };
  const std::vector<SampledPair> pairs = sample_contacts(scene, options);
  bar.finish();
  if (!robot.srdf.empty()) {
    const auto srdf = read_srdf(robot.srdf);
    if (const auto* faults = std::get_if<UrdfFaults>(&srdf)) {
      for (const UrdfFault& fault : *faults) print(stderr, "{}\n", fault.text);
      return kFailed;
    }
    print(stderr, "{}", agreement(scene, pairs, options.samples, std::get<Srdf>(srdf)));
  }
  const std::string text = arguments.form == "srdf" ? as_srdf(scene, pairs, options.samples)
                                                    : as_cell(scene, pairs, options.samples);
  if (arguments.output.empty()) {
    print(stdout, "{}", text);
    return kOk;
  }
  std::ofstream stream(arguments.output, std::ios::binary);
  stream << text;
  stream.close();
  if (stream) return kOk;
  print(stderr, "{}: cannot be written: {}\n", arguments.output, std::strerror(errno));
  return kFailed;
}

int report(const std::string& cell, bool json) {
  MeshErrors mesh_errors;
  CellOptions options = told_on_stderr();
  options.mesh_errors = &mesh_errors;
  const auto read = cell_or_errors(read_cell(cell, options));
  if (!read) return kBadCell;
  const Scene& scene = read->scene;
  print(stdout, "{}", json ? model_json(scene, mesh_errors) : model_table(scene, mesh_errors));
  return kOk;
}

std::filesystem::path page_beside(std::filesystem::path svg) {
  return svg.replace_extension(".md");
}

int write_reductions(const std::vector<Reduction>& bodies, const ReductionOptions& options,
                     const std::filesystem::path& svg) {
  const std::string fault = plot_reductions(bodies, options, svg);
  if (!fault.empty()) {
    print(stderr, "{}: {}\n", svg.string(), fault);
    return kFailed;
  }
  const std::filesystem::path page = page_beside(svg);
  std::ofstream stream(page, std::ios::binary);
  stream << reduction_page(bodies, options, svg.filename());
  stream.close();
  if (stream) return kOk;
  print(stderr, "{}: cannot be written: {}\n", page.string(), std::strerror(errno));
  return kFailed;
}

int print_reductions(const Arguments& arguments) {
  const ReductionOptions& options = arguments.reduction;
  const std::string& plot = arguments.plot;
  if (!plot.empty() && (!can_create("clearance-scene", plot, arguments.force) ||
                        !can_create("clearance-scene", page_beside(plot), arguments.force))) {
    return kFailed;
  }
  const auto made = reduce(options);
  if (const auto* faults = std::get_if<std::vector<std::string>>(&made)) {
    for (const std::string& fault : *faults) print(stderr, "{}\n", fault);
    return kFailed;
  }
  const Reductions& all = std::get<Reductions>(made);
  for (const std::string& note : all.notes) print(stderr, "note: {}\n", note);
  print(
      stdout, "{}",
      arguments.json ? reduction_json(all.bodies, options) : reduction_table(all.bodies, options));
  return plot.empty() ? kOk : write_reductions(all.bodies, options, plot);
}

CLI::Option* add_reduction(CLI::App& app, CLI::Option_group& what, ReductionOptions& options,
                           std::string& plot) {
  auto* reduce = what.add_option("--reduce", options.files,
                                 "Simpler models around meshes, or around each object of a cell "
                                 "or link of a robot (.yaml, .urdf), with certified errors")
                     ->check(CLI::ExistingFile);
  app.add_option("--object", options.object, "Only this object or link")->needs(reduce);
  auto* tolerance = app.add_option("--tolerance", options.tolerance,
                                   "Choose the cheapest model that reaches no farther beyond the "
                                   "body, m")
                        ->check(number_from_zero())
                        ->needs(reduce);
  app.add_option("--facets", options.facets, "Choose the best of at most this many facets")
      ->check(CLI::Range(6u, 4096u))
      ->needs(reduce)
      ->excludes(tolerance);
  app.add_flag("--time", options.time, "Measure a query against each model, ns")->needs(reduce);
  auto* distance =
      app.add_option("--distance", options.distances,
                     "Which model is the cheapest to watch a pair by that is so far apart, m, "
                     "beyond a zone's threshold; measures queries; several are possible")
          ->check(positive_number())
          ->needs(reduce);
  app.add_option("--speed", options.speed,
                 "How far both objects come in a second, added up, m/s; for --distance")
      ->check(positive_number())
      ->capture_default_str()
      ->needs(distance);
  app.add_option("--plot", plot,
                 "Write a picture of error against time (SVG, by gnuplot), and the tables as "
                 "Markdown beside it")
      ->needs(distance);
  return reduce;
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
  auto* reduce = add_reduction(app, *what, arguments.reduction, arguments.plot);
  what->require_option(1);
  app.add_option("-o,--output", arguments.output,
                 "The cell file to write; mesh paths are relative to it")
      ->excludes(report)
      ->excludes(reduce);
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
  app.add_option("--mesh-tolerance", robot.mesh_tolerance,
                 "How far the convex parts of a mesh should reach beyond it at most, m; 0.005 "
                 "otherwise")
      ->check(positive_number())
      ->needs(urdf);
  app.add_option("--max-parts", robot.max_parts,
                 "Parts of a mesh at most; 24 otherwise; 1: one hull around each")
      ->check(CLI::Range(1u, 64u))
      ->needs(urdf);
  app.add_flag("--fixed-base", robot.fixed_base,
               "The root link stands at the world's origin, and no pose arrives for it")
      ->needs(urdf);
  app.add_option(
         "--add", robot.scenes,
         "A planning scene of MoveIt (.scene) whose obstacles the robot is watched against; "
         "repeatable")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false)
      ->needs(urdf);
  auto* allow = app.add_flag(
      "--allow", arguments.allow,
      "Write no cell, but which pairs of links need not be watched, by sampling the joints: "
      "adjacent ones, those in contact at zero, always or never. Never is what the samples show "
      "and no proof. With --srdf, also where that agrees");
  allow->needs(urdf);
  app.add_option("--samples", arguments.sampling.samples, "Positions that --allow tries")
      ->check(whole_number(1, 1'000'000'000))
      ->capture_default_str()
      ->needs(allow);
  app.add_option("--as", arguments.form,
                 "What --allow writes: srdf, its <disable_collisions> lines, or cell, the "
                 "allowed_collisions of a cell")
      ->check(CLI::IsMember({"srdf", "cell"}))
      ->capture_default_str()
      ->needs(allow);
  app.add_option("--seed", arguments.seed, "Random seed of the warehouse, or of the positions")
      ->capture_default_str()
      ->excludes(report)
      ->excludes(reduce);
  app.add_flag("--json", arguments.json, "Print the report, or the models, as JSON")
      ->excludes(urdf)
      ->excludes(warehouse);
  add_force(app, arguments.force);
  app.footer(kFooter);
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Writes cell files: of a robot from its URDF (collision shapes) and SRDF (disabled pairs), "
      "or "
      "of a generated warehouse. Reports the models of a cell's objects, and makes simpler ones."};
  add_options(app, arguments);
  if (const auto done = parse(app, argc, argv)) return *done;
  for (const std::string& package : arguments.packages) {
    if (add_package(package, arguments.robot)) continue;
    print(stderr, "--package {}: expected NAME=DIRECTORY\n", package);
    return kUsage;
  }
  if (!arguments.report.empty()) return report(arguments.report, arguments.json);
  if (!arguments.reduction.files.empty()) {
    return print_reductions(arguments);
  }
  arguments.warehouse.seed = arguments.seed;
  if (arguments.allow && arguments.output.empty()) return propose_allowed(arguments);
  if (arguments.output.empty()) {
    print(stderr, "--output is missing: it names the cell file to write\n");
    return kUsage;
  }
  if (!output_is_not_an_input("clearance-scene", arguments.output,
                              {arguments.robot.urdf, arguments.robot.srdf})) {
    return kUsage;
  }
  if (!can_create("clearance-scene", arguments.output, arguments.force)) return kFailed;
  if (arguments.allow) return propose_allowed(arguments);
  if (arguments.robot.urdf.empty()) {
    return write(warehouse_cell(arguments.warehouse), arguments.output);
  }
  return make_robot_cell(std::move(arguments.robot), arguments.output);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) { return clearance::run(argc, argv); }
