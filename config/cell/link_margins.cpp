#include "config/cell/link_margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {

void read_link_margins(const YamlNode& node, const RobotList& robots, const Quantities& quantities,
                       ObjectList& list) {
  Diagnostics& diagnostics = quantities.diagnostics();
  std::map<std::string, std::uint32_t> objects;  // of links by name
  std::vector<std::string> names;
  for (const Robot& robot : robots.robots) {
    for (const RobotLink& link : robot.links) {
      objects.emplace(link.name, link.object);
      names.push_back(link.name);
    }
  }
  std::map<std::string, int> stated;  // with their lines
  for (const YamlNode& item : read_list(node, "margins of links", diagnostics)) {
    MapReader map(item, "the margin of a link", diagnostics);
    const YamlNode* name_node = map.required("name");
    const YamlNode* margin_node = map.required("margin");
    map.refuse_unknown_keys();
    if (name_node == nullptr || margin_node == nullptr) continue;
    const auto name = read_name(*name_node, "the name of a link", diagnostics);
    const auto margin = quantities.length(*margin_node, "the margin", kNotNegative);
    if (!name || !margin) continue;
    const auto link = objects.find(*name);
    if (link == objects.end()) {
      if (!list.names_known) continue;
      diagnostics.add(*name_node,
                      fmt::format("found '{}'; expected a link of a robot, since objects state "
                                  "their own margin{}",
                                  *name, did_you_mean(*name, names)));
    } else if (const auto [same, is_new] = stated.emplace(*name, item.line); !is_new) {
      diagnostics.add(*name_node, fmt::format("found the margin of '{}' again; expected it once "
                                              "(first in line {})",
                                              *name, same->second));
    } else if (link->second != RobotLink::kNoObject) {
      list.objects[link->second].margin = *margin;
    }
  }
}

}  // namespace clearance
