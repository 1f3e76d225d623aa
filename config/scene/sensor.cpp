#include "config/scene/sensor.hpp"

#include <fmt/format.h>

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

std::vector<std::uint32_t> hidden_pairs(const Scene& scene) {
  std::vector<bool> is_left_out(scene.objects.size());
  for (const Robot& robot : scene.robots) {
    if (!is_of_a_robot(scene.robots, robot)) continue;
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) is_left_out[link.object] = true;
    }
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
    const ObjectPair& pair = scene.pairs[i];
    const bool of_a_sensor =
        scene.objects[pair.first].is_seen() || scene.objects[pair.second].is_seen();
    if (pair.publish && of_a_sensor && (is_left_out[pair.first] || is_left_out[pair.second]))
      found.push_back(i);
  }
  return found;
}

}  // namespace clearance
