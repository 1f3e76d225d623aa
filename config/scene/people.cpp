#include "config/scene/people.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance {

std::string no_contact_with_people(const Object& a, const Object& b, const Zone& zone) {
  return fmt::format(
      "found '{}' against '{}' in the zone '{}' with separation; expected no contact between a "
      "person and a robot",
      a.name, b.name, zone.name);
}

std::optional<std::string> contact_with_people(std::span<const Object> objects,
                                               std::span<const ObjectPair> pairs,
                                               std::span<const Zone> zones, std::uint32_t a,
                                               std::uint32_t b) {
  const auto [first, second] = std::minmax(a, b);
  for (const Zone& zone : zones) {
    if (!zone.separation) continue;
    for (const std::uint32_t pair : zone.pairs) {
      if (pairs[pair].first == first && pairs[pair].second == second)
        return no_contact_with_people(objects[first], objects[second], zone);
    }
  }
  return std::nullopt;
}

}  // namespace clearance
