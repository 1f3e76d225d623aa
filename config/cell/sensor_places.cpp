#include "config/cell/sensor_places.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>
#include <vector>

#include "config/cell/robot_base_reader.hpp"
#include "config/cell/ros_reader.hpp"
#include "config/scene/robot_reach.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

void read_speed(const YamlNode& node, const Quantities& quantities, MapReader& map,
                MountSpeed& speed) {
  const YamlNode* shift = map.optional("max_speed");
  const YamlNode* turn = map.optional("max_turn_speed");
  if (shift == nullptr && turn == nullptr) return;
  if (shift == nullptr || turn == nullptr) {
    quantities.diagnostics().add(
        node,
        fmt::format("found {} of a mount alone; expected both 'max_speed' and 'max_turn_speed'",
                    shift == nullptr ? "'max_turn_speed'" : "'max_speed'"));
    return;
  }
  speed.shift = quantities.speed(*shift, "the largest speed of the mount").value_or(0.0);
  speed.turn = quantities.turn_speed(*turn, "the largest turning speed of the mount").value_or(0.0);
}

void mount(const YamlNode& node, const RobotList& robots, const ObjectList& objects,
           const Quantities& quantities, Sensor& sensor) {
  Diagnostics& diagnostics = quantities.diagnostics();
  RobotBase& base = sensor.mount;
  MapReader map(node, "a sensor's mount", diagnostics);
  const YamlNode* given = map.optional("pose");
  const Pose pose = given == nullptr ? Pose{} : quantities.pose(*given).value_or(Pose{});
  const YamlNode* on = map.optional("on");
  const YamlNode* frame = map.optional("frame");
  if (frame != nullptr) read_speed(node, quantities, map, sensor.mount_speed);
  map.refuse_unknown_keys();
  sensor.frames_by_message = false;
  if (frame != nullptr) {
    base.frame = read_frame(*frame, diagnostics).value_or("");
    base.frame_from_root = pose;
    if (on != nullptr)
      diagnostics.add(*on, "found 'on' of a sensor in a frame of tf; expected one of the two");
    return;
  }
  base.base_from_root = pose;
  if (on != nullptr) {
    read_what_carries(*on, robots.robots, robots.at_rest, objects,
                      "an object, or a link of a robot", diagnostics, base);
  } else if (given == nullptr) {
    diagnostics.add(node,
                    "found a mount without 'pose', 'on' and 'frame'; expected one of these, "
                    "or no mount: the frame of tf that each message names");
  }
}

}  // namespace

void mount_sensors(const RobotList& robots, const ObjectList& objects, const Quantities& quantities,
                   SensorList& list) {
  for (std::size_t i = 0; i < list.sensors.size(); ++i) {
    if (list.mounts[i] != nullptr)
      mount(*list.mounts[i], robots, objects, quantities, list.sensors[i]);
  }
}

void crop_sensors(const SensorList& list, Diagnostics& diagnostics, Scene& scene) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    Sensor& sensor = scene.sensors[i];
    if (list.reaches[i] == nullptr) continue;
    const auto reach = robots_reach(scene);
    if (const auto* const reason = std::get_if<std::string>(&reach)) {
      diagnostics.add(
          *list.reaches[i],
          fmt::format("found 'reach', but {}; expected robots of limited reach", *reason));
      return;
    }
    const Object& object = scene.objects[sensor.object];
    const double moves = object.max_speed < kInfinity
                             ? object.max_speed * 1e-9 * static_cast<double>(object.age_limit_ns)
                             : 0.0;
    sensor.crop = std::get<std::vector<ReachBall>>(reach);
    for (ReachBall& ball : sensor.crop) ball.radius += sensor.reach + moves;
  }
}

}  // namespace clearance
