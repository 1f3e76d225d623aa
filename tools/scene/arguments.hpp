// The arguments of clearance-scene's subcommands.
#pragma once

#include <string>
#include <vector>

#include "config/write/robot_cell.hpp"
#include "config/write/warehouse_cell.hpp"
#include "monitor/app/command_line.hpp"
#include "tools/scene/sampled_contacts.hpp"

namespace clearance {

struct ImportArguments {
  RobotCellOptions robot;
  std::string output;
  bool force = false;
};

struct NewArguments {
  std::string robots;  // URDF or xacro files, each with its SRDF behind it or none; commas between
  std::string bodies;  // of table, machine, person; commas between
  std::vector<std::string> xacro;  // NAME:=VALUE
  Packages packages;
  std::string output = "cell.yaml";
  bool force = false;
};

struct AllowArguments {
  RobotCellOptions robot;  // the URDF, its packages and perhaps an SRDF
  SamplingOptions sampling;
  double never_margin = 0.05;  // m
  std::string form = "srdf";
  std::string output;  // empty: stdout
  bool force = false;
};

struct WarehouseArguments {
  WarehouseOptions warehouse;
  std::string output;
  bool force = false;
};

struct ReportArguments {
  std::string cell;
  bool json = false;
};

struct ErrorsArguments {
  std::string cell;
  std::vector<std::string> joints;  // NAME=POSITION
  std::string measured, link;       // a table of places, and the link whose they are
};

struct StopsArguments {
  std::string cell;
  std::string plot;  // an SVG; empty: none
};

// Each carries out one subcommand and returns the exit code.
[[nodiscard]] int import_robot(ImportArguments arguments);
[[nodiscard]] int new_cell(const NewArguments& arguments);
[[nodiscard]] int allow_collisions(const AllowArguments& arguments);
[[nodiscard]] int make_warehouse(const WarehouseArguments& arguments);
[[nodiscard]] int report_errors(const ErrorsArguments& arguments);
[[nodiscard]] int report_stops(const StopsArguments& arguments);
[[nodiscard]] int report_models(const ReportArguments& arguments);

}  // namespace clearance
