#include "monitor/sensors/attach_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {
namespace {

// A length of the text of the cell, m.
double unit_of(const Cell& cell) {
  const auto read = parse_yaml(cell.yaml);
  const auto* const tree = std::get_if<YamlNode>(&read);
  return tree == nullptr ? 1.0 : to_metres(1.0, length_unit_of(*tree));
}

std::vector<std::string> links_on(const Scene& scene, const UnknownPayload& payload) {
  const Robot& robot = scene.robots[payload.robot];
  std::vector<bool> hangs(robot.links.size());
  hangs[payload.link] = true;
  std::vector<std::string> names;
  for (std::uint32_t link = payload.link + 1; link < robot.links.size(); ++link) {
    hangs[link] = hangs[robot.joints[link - 1].parent];
    if (hangs[link] && robot.links[link].object != RobotLink::kNoObject)
      names.push_back(robot.links[link].name);
  }
  return names;
}

std::string listed(const Vec3& v, double unit) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

}  // namespace

std::string attach_command(const Cell& cell, const UnknownPayload& payload) {
  const std::string& link = cell.scene.robots[payload.robot].links[payload.link].name;
  std::string name = "carried_by_" + link;
  while (std::ranges::any_of(cell.scene.objects,
                             [&](const Object& object) { return object.name == name; }))
    name += "_too";
  const std::vector<std::string> touched = links_on(cell.scene, payload);
  return fmt::format(
      "clearance-scene send --change 'add_object: {{name: {0}, fixed: true, box: {{size: {1}}}}}' "
      "--change 'attach: {{object: {0}, to: {2}, touch: [{3}], pose: {{xyz: {4}}}, overlap: {5}}}'",
      name, listed(payload.box.size, unit_of(cell)), link, fmt::join(touched, ", "),
      listed(payload.box.centre, 1.0), PayloadGrid::kCell);
}

}  // namespace clearance
