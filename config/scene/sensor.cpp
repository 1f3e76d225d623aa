#include "config/scene/sensor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/scene/rigid_root.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

std::vector<std::string> notes_of(const Sensor& sensor) {
  std::vector<std::string> notes;
  if (sensor.persist_frames > 1) {
    notes.push_back(fmt::format("what comes into view is hidden until {} of {} frames have it",
                                sensor.persist_frames, sensor.persist_of));
  }
  if (!sensor.unseen) {
    notes.emplace_back(
        "places that it does not see are not looked for: glass, shadows, what is behind something "
        "(key 'unseen')");
  }
  return notes;
}

namespace {

// By object: it is a link of a robot, or what that carries.
std::vector<bool> links_of(const Scene& scene) {
  std::vector<bool> is_link(scene.objects.size());
  for (const Robot& robot : scene.robots) {
    if (!is_of_a_robot(scene.robots, robot)) continue;
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) is_link[link.object] = true;
    }
  }
  return is_link;
}

}  // namespace

std::vector<std::uint32_t> known_bodies(const Scene& scene) {
  std::vector<std::uint32_t> known;
  if (std::ranges::none_of(scene.sensors, &Sensor::knows)) return known;
  const std::vector<bool> is_link = links_of(scene);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!is_link[i] && !object.is_seen() && !object.absent) known.push_back(i);
  }
  return known;
}

std::vector<std::uint32_t> hidden_pairs(const Scene& scene) {
  const std::vector<bool> is_link = links_of(scene);
  const std::vector<std::uint32_t> known = known_bodies(scene);
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
    const ObjectPair& pair = scene.pairs[i];
    const bool is_first_seen = scene.objects[pair.first].is_seen();
    if (!pair.publish || !(is_first_seen || scene.objects[pair.second].is_seen())) continue;
    const std::uint32_t seen = is_first_seen ? pair.first : pair.second;
    const std::uint32_t other = is_first_seen ? pair.second : pair.first;
    if (is_link[other] || (scene.sensors[scene.objects[seen].sensor].knows &&
                           std::ranges::binary_search(known, other))) {
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace clearance
