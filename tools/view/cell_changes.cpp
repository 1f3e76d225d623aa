#include "tools/view/cell_changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace clearance::view {
namespace {

constexpr std::size_t kMostChanges = 4;  // that a text names

std::string carrier_of(const Scene& scene, const RobotBase& base) {
  switch (base.kind) {
    case RobotBase::Kind::kObject:
      return scene.objects[base.object].name;
    case RobotBase::Kind::kLink:
      return scene.robots[base.robot].links[base.link].name;
    case RobotBase::Kind::kWorld:
      break;
  }
  return "the world";
}

std::map<std::string, std::string> carriers_of(const Scene& scene) {
  std::map<std::string, std::string> carriers;
  for (const Robot& robot : scene.robots) {
    if (robot.base.kind == RobotBase::Kind::kWorld) continue;
    carriers.emplace(robot.is_attached ? robot.links.front().name : robot.name,
                     carrier_of(scene, robot.base));
  }
  return carriers;
}

template <class Named>
std::set<std::string> names_of(const std::vector<Named>& list) {
  std::set<std::string> names;
  for (const Named& each : list) names.insert(each.name);
  return names;
}

void add_names(const std::set<std::string>& before, const std::set<std::string>& after,
               const char* subject, const char* added, const char* removed,
               std::vector<std::string>& changes) {
  for (const std::string& name : after)
    if (!before.contains(name)) changes.push_back(fmt::format("{}{} {}", subject, name, added));
  for (const std::string& name : before)
    if (!after.contains(name)) changes.push_back(fmt::format("{}{} {}", subject, name, removed));
}

void add_carriers(const Scene& before, const Scene& after, std::vector<std::string>& changes) {
  const auto carried_before = carriers_of(before), carried_after = carriers_of(after);
  for (const auto& [object, carrier] : carried_after) {
    const auto known = carried_before.find(object);
    if (known == carried_before.end() || known->second != carrier)
      changes.push_back(fmt::format("{} is attached to {}", object, carrier));
  }
  for (const auto& [object, carrier] : carried_before) {
    if (!carried_after.contains(object))
      changes.push_back(fmt::format("{} is no longer attached to {}", object, carrier));
  }
}

}  // namespace

std::vector<Attached> attached_in(const Scene& scene, std::span<const Attached> before,
                                  const SceneBegin& begin) {
  std::vector<Attached> found;
  for (const Robot& robot : scene.robots) {
    if (!robot.is_attached) continue;
    Attached each{robot.links.front().name, carrier_of(scene, robot.base), begin};
    const auto known = std::ranges::find_if(before, [&](const Attached& other) {
      return other.object == each.object && other.carrier == each.carrier;
    });
    if (known != before.end()) each.since = known->since;
    found.push_back(std::move(each));
  }
  return found;
}

nlohmann::json attached_json(std::span<const Attached> attached) {
  nlohmann::json list = nlohmann::json::array();
  for (const Attached& each : attached) {
    list.push_back({{"object", each.object},
                    {"carrier", each.carrier},
                    {"cycle", each.since.cycle},
                    {"seconds", each.since.seconds},
                    {"or_before", each.since.is_first}});
  }
  return list;
}

std::string changes_text(const Scene& before, const Scene& after) {
  std::vector<std::string> changes;
  add_carriers(before, after, changes);
  add_names(names_of(before.contacts), names_of(after.contacts), "contact ", "is allowed",
            "is no longer allowed", changes);
  add_names(names_of(before.objects), names_of(after.objects), "", "is added", "is removed",
            changes);
  const std::size_t further = changes.size() - std::min(changes.size(), kMostChanges);
  changes.resize(changes.size() - further);
  if (further > 0) changes.push_back(fmt::format("{} more", further));
  return fmt::format("{}", fmt::join(changes, ", "));
}

}  // namespace clearance::view
