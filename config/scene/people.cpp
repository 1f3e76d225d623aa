#include "config/scene/people.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "config/scene/rigid_root.hpp"

namespace clearance {

namespace {

// Tells it of a link of a person, and of what is attached to one.
bool is_of_a_person(std::span<const Robot> robots, std::uint32_t object) {
  return std::ranges::any_of(robots, [&](const Robot& robot) {
    return carrier_of(robots, robot).person.has_value() &&
           std::ranges::find(robot.links, object, &RobotLink::object) != robot.links.end();
  });
}

std::string refusal(const Object& a, const Object& b, const std::string& where) {
  return fmt::format(
      "found '{}' against '{}' {}; expected no contact between a person and what moves", a.name,
      b.name, where);
}

}  // namespace

std::string no_contact_with_people(const Object& a, const Object& b, const Zone& zone) {
  return refusal(a, b, fmt::format("in the zone '{}' with separation", zone.name));
}

std::optional<std::string> contact_with_people(std::span<const Object> objects,
                                               std::span<const Robot> robots,
                                               std::span<const ObjectPair> pairs,
                                               std::span<const Zone> zones, std::uint32_t a,
                                               std::uint32_t b) {
  const auto [first, second] = std::minmax(a, b);
  for (const Zone& zone : zones) {
    if (!zone.separation) continue;
    const std::vector<std::uint8_t>& human_is_first = zone.separation->human_is_first;
    for (std::size_t i = 0; i < human_is_first.size(); ++i) {
      const ObjectPair& pair = pairs[zone.pairs[i]];
      const std::uint32_t robot = human_is_first[i] != 0 ? pair.second : pair.first;
      if (pair.first == first && pair.second == second && !objects[robot].fixed)
        return no_contact_with_people(objects[first], objects[second], zone);
    }
  }
  const bool first_is_human = is_of_a_person(robots, first);
  if (first_is_human == is_of_a_person(robots, second)) return std::nullopt;
  const auto& [human, other] = first_is_human ? std::tie(first, second) : std::tie(second, first);
  if (objects[other].fixed) return std::nullopt;
  return refusal(objects[human], objects[other], "where the former is of a person of the cell");
}

}  // namespace clearance
