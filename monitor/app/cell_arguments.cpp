#include "monitor/app/cell_arguments.hpp"

#include "monitor/app/options.hpp"
#include "monitor/app/program.hpp"

namespace clearance {

namespace {

Check topic_like(const std::string& example) {
  return expecting("a topic with its namespace: " + example, [](const std::string& topic) {
    return topic.starts_with('/') && topic.size() > 1;
  });
}

}  // namespace

// Options of the robot are keys of the robot in a cell file.
void CellArguments::add_to(CommandLine& line, bool from_ros) {
  line.one_of = {
      {"CELL", &cell, "The cell file (YAML)"},
      {"--urdf", &robot.urdf, "A robot's URDF, xacro expanded, instead of a cell file"},
  };
  if (from_ros) {
    line.one_of.push_back(
        {"--robot-description", &description_topic,
         "The topic of ROS 2 that has the URDF, /robot_description, instead of a file",
         topic_like("/robot_description")});
  }
  line.add({
      {"--srdf", &robot.srdf,
       "The robot's SRDF, which disables pairs; without it, a link and the next above it that has "
       "shapes may touch",
       excluding("CELL")},
      packages_option(robot.packages, {"CELL"}),
      {"--joint-states", &robot.joint_states,
       "The topic of ROS 2 that has the robot's joints; otherwise each topic joint_states, in any "
       "namespace",
       topic_like("/arm/joints"), excluding("CELL")},
      {"--stamps", &robot.stamps,
       "The time of a joint state that counts: message, the stamp in it, or sent, when it was sent",
       expecting("message or sent",
                 [](const std::string& text) { return text == "message" || text == "sent"; }),
       excluding("CELL")},
      {"--age-limit-ms",
       &robot.age_limit_ms,
       "An older position makes what hangs on the joint stale",
       number_in(0.001, 86'400'000.0),
       {.shows_default = true, .excludes = {"CELL"}}},
  });
}

CellResult CellArguments::read() const {
  CellOptions options = told_on_stderr();
  options.share = share;
  return cell.empty() ? read_single_robot(robot, options) : read_cell(cell, options);
}

CellOptions CellArguments::reading() const {
  CellOptions options = told_on_stderr();
  options.is_of_urdf = cell.empty();
  options.share = share;
  return options;
}

std::vector<std::filesystem::path> CellArguments::files() const {
  if (!cell.empty()) return {cell};
  std::vector<std::filesystem::path> files = {robot.urdf};
  if (!robot.srdf.empty()) files.push_back(robot.srdf);
  return files;
}

}  // namespace clearance
