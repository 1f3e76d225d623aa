#include <cstdio>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "config/write/single_robot_cell.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/recording/given_joints.hpp"
#include "tools/plot/gnuplot.hpp"
#include "tools/scene/allowed_collisions.hpp"
#include "tools/scene/arguments.hpp"
#include "tools/scene/error_report.hpp"
#include "tools/scene/model_report.hpp"
#include "tools/scene/stop_report.hpp"
#include "tools/scene/written_cell.hpp"

namespace clearance {
namespace {

int print_faults(const UrdfFaults& faults) {
  for (const UrdfFault& fault : faults) print(stderr, "{}\n", fault.text);
  return kFailed;
}

// kOk, or the exit code after the reason has gone to stderr.
int check_output(const RobotCellOptions& robot, const std::string& output, bool force) {
  if (!output_is_not_an_input(kProgram, output, {robot.urdf, robot.srdf})) return kUsage;
  return can_create(kProgram, output, force) ? kOk : kFailed;
}

}  // namespace

int import_robot(ImportArguments arguments) {
  const int refused = check_output(arguments.robot, arguments.output, arguments.force);
  if (refused != kOk) return refused;
  arguments.robot.directory = std::filesystem::absolute(arguments.output).parent_path();
  const auto result = robot_cell(arguments.robot);
  if (const auto* faults = std::get_if<UrdfFaults>(&result)) return print_faults(*faults);
  const RobotCell& cell = std::get<RobotCell>(result);
  for (const std::string& note : cell.notes) print(stderr, "note: {}\n", note);
  return write_cell(cell.yaml, arguments.output);
}

// Given an SRDF, it also prints where the samples and the SRDF agree.
int allow_collisions(const AllowArguments& arguments) {
  const RobotCellOptions& robot = arguments.robot;
  if (!arguments.output.empty()) {
    const int refused = check_output(robot, arguments.output, arguments.force);
    if (refused != kOk) return refused;
  }
  const auto cell =
      cell_or_errors(read_single_robot({.urdf = robot.urdf, .packages = robot.packages}));
  if (!cell) return kBadCell;
  const Scene& scene = cell->scene;
  const std::vector<SampledPair> pairs = sample_with_progress(scene, arguments.sampling);
  const AllowRule rule{arguments.sampling.samples, arguments.never_margin};
  if (!robot.srdf.empty()) {
    const auto srdf = read_srdf(robot.srdf);
    if (const auto* faults = std::get_if<UrdfFaults>(&srdf)) return print_faults(*faults);
    print(stderr, "{}", agreement(scene, pairs, rule, std::get<Srdf>(srdf)));
  }
  print(stderr, "{}", near_misses(scene, pairs, rule));
  const std::string text =
      arguments.form == "srdf" ? as_srdf(scene, pairs, rule) : as_cell(scene, pairs, rule);
  if (!arguments.output.empty()) return write_text(text, arguments.output);
  print(stdout, "{}", text);
  return kOk;
}

int make_warehouse(const WarehouseArguments& arguments) {
  if (!can_create(kProgram, arguments.output, arguments.force)) return kFailed;
  return write_cell(warehouse_cell(arguments.warehouse), arguments.output);
}

int report_errors(const ErrorsArguments& arguments) {
  const auto refuse = [](const std::string& fault) {
    print(stderr, "clearance-scene: {}\n", fault);
    return kFailed;
  };
  std::map<std::string, double> joints;
  if (const std::string fault = read_joint_positions(arguments.joints, joints); !fault.empty())
    return refuse(fault);
  const auto cell = cell_or_errors(read_cell(arguments.cell, told_on_stderr()));
  if (!cell) return kBadCell;
  if (!arguments.measured.empty()) {
    const auto report = measured_report(cell->scene, arguments.measured, arguments.link);
    if (const auto* fault = std::get_if<ErrorReportFault>(&report)) return refuse(fault->text);
    const MeasuredReport& found = std::get<MeasuredReport>(report);
    print(stdout, "{}", found.text);
    return found.explained ? kOk : kFailed;
  }
  const auto table = error_table(cell->scene, joints);
  if (const auto* fault = std::get_if<ErrorReportFault>(&table)) return refuse(fault->text);
  print(stdout, "{}", std::get<std::string>(table));
  return kOk;
}

int report_stops(const StopsArguments& arguments) {
  const auto cell = cell_or_errors(read_cell(arguments.cell, told_on_stderr()));
  if (!cell) return kBadCell;
  const std::string table = stop_table(cell->scene);
  std::string fault =
      table.empty() ? "the cell states no stops; expected `stopping` of a robot (config/KEYS.md)"
                    : "";
  print(stdout, "{}", table);
  if (fault.empty() && !arguments.plot.empty())
    fault = plot_svg(arguments.plot, 900, 500, stop_plot(cell->scene));
  if (fault.empty()) return kOk;
  print(stderr, "clearance-scene: {}\n", fault);
  return kFailed;
}

int report_models(const ReportArguments& arguments) {
  MeshErrors mesh_errors;
  CellOptions options = told_on_stderr();
  options.mesh_errors = &mesh_errors;
  const auto cell = cell_or_errors(read_cell(arguments.cell, options));
  if (!cell) return kBadCell;
  print(stdout, "{}",
        arguments.json ? model_json(cell->scene, mesh_errors)
                       : model_table(cell->scene, mesh_errors));
  return kOk;
}

}  // namespace clearance
