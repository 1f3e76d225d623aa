// Counts over a whole Scene.
#include "config/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "config/text/sentences.hpp"

namespace clearance {

SeparatedCount separated_count(const Scene& scene) noexcept {
  SeparatedCount count;
  for (const Zone& zone : scene.zones) {
    if (!zone.separation) continue;
    ++count.zones;
    count.pairs += zone.pairs.size();
  }
  for (const Robot& robot : scene.robots) count.stops += robot.stopping.is_stated();
  return count;
}

std::string summary(const Scene& scene) {
  std::size_t fixed = 0, parts = 0, facets = 0;
  for (const Object& object : scene.objects) {
    fixed += object.fixed ? 1 : 0;
    parts += object.parts.size();
    for (const Part& part : object.parts) facets += part.shape.facets.size();
  }
  const auto published = static_cast<std::size_t>(std::count_if(
      scene.pairs.begin(), scene.pairs.end(), [](const ObjectPair& pair) { return pair.publish; }));
  const auto attached =
      static_cast<std::size_t>(std::ranges::count(scene.robots, true, &Robot::is_attached));
  const std::size_t jointed = scene.robots.size() - attached;
  const std::string robots = jointed == 0 ? "" : counted(jointed, "robot") + ", ";
  const std::string contacts =
      scene.contacts.empty() ? "" : ", " + counted(scene.contacts.size(), "contact") + " allowed";
  return fmt::format("{}: {} ({} moving, {} fixed), {}{}, {}, {} ({} published), {}{}", scene.name,
                     counted(scene.objects.size(), "object"), scene.objects.size() - fixed, fixed,
                     robots, counted(parts, "part"), counted(facets, "facet"),
                     counted(scene.pairs.size(), "pair"), published,
                     counted(scene.zones.size(), "zone"), contacts);
}

}  // namespace clearance
