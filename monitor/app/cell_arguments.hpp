// The cell on a program's command line: a cell file, or a robot's URDF and SRDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "config/write/single_robot_cell.hpp"
#include "monitor/app/command_line.hpp"

namespace clearance {

struct CellArguments {
  std::string cell;  // empty: the robot is used
  SingleRobotOptions robot;

  // The ROS 2 topic with the robot's URDF, "/robot_description"; empty: not asked for. The program
  // that gets the URDF from there sets robot.urdf.
  std::string description_topic;
  std::string share;  // CellOptions::share

  // Adds CELL, and --urdf with --srdf, --package, --joint-states, --stamps and --age-limit-ms; one
  // of CELL and --urdf is required. With `from_ros`, --robot-description is a third choice.
  void add_to(CommandLine& line, bool from_ros = false);
  [[nodiscard]] CellResult read() const;
  // The options of read(), to read a changed text as the first one.
  [[nodiscard]] CellOptions reading() const;
  // The text of a cell for the URDF, as its files say now.
  [[nodiscard]] std::string robot_text() const { return single_robot_cell(robot); }
  // The name for messages: the cell file, or the URDF.
  [[nodiscard]] std::string name() const { return cell.empty() ? robot.urdf.string() : cell; }
  // Every file that the command line names.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

}  // namespace clearance
