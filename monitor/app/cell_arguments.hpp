// The cell of a program's command line: a file, or a robot's URDF and SRDF instead of one.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config/write/single_robot_cell.hpp"

namespace clearance {

struct CellArguments {
  std::string cell;  // empty: the robot
  SingleRobotOptions robot;

  // A topic of ROS 2, "/robot_description", that has the robot's URDF; empty: none was asked for.
  // Whoever asks for it fills in robot.urdf.
  std::string description_topic;

  // CELL, or --urdf with --srdf, --package and --age-limit-ms; one of CELL and --urdf is required.
  // `from_ros`: or --robot-description.
  void add_to(CLI::App& app, bool from_ros = false);
  [[nodiscard]] CellResult read() const;
  // As a person has to be told: the cell file, or the URDF.
  [[nodiscard]] std::string name() const { return cell.empty() ? robot.urdf.string() : cell; }
  // Every file that the command line names.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

}  // namespace clearance
