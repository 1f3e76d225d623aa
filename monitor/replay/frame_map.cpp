#include "monitor/replay/frame_map.hpp"

#include <algorithm>

namespace clearance {
namespace {

template <class Thing>
std::uint32_t index_of(const std::string& name, const std::vector<Thing>& things) {
  const auto found = std::ranges::find(things, name, &Thing::name);
  return found == things.end() ? SceneMap::kNone
                               : static_cast<std::uint32_t>(found - things.begin());
}

template <class Thing>
std::vector<std::uint32_t> by_name(const std::vector<Thing>& recorded,
                                   const std::vector<Thing>& now) {
  std::vector<std::uint32_t> found;
  for (const Thing& thing : now) found.push_back(index_of(thing.name, recorded));
  return found;
}

// Leaves out indices, which differ between scenes, and the crop, which follows from robots.
bool same_entry(const Sensor& recorded, const Sensor& now) {
  const auto of_itself = [](Sensor sensor) {
    sensor.object = sensor.mount.object = sensor.mount.robot = sensor.mount.link = 0;
    sensor.mount.resting_on = {};
    sensor.crop.clear();
    return sensor;
  };
  return of_itself(recorded) == of_itself(now);
}

}  // namespace

FrameMap::FrameMap(const Scene& recorded, const Scene& now)
    : recorded_(recorded),
      now_(now),
      map_(scene_map(recorded, now)),
      variables_(by_name(recorded.variables, now.variables)),
      objects_(by_name(recorded.objects, now.objects)) {}

std::optional<BuiltFrame> FrameMap::translate(const BuiltFrame& frame) const {
  if (frame.sensor >= recorded_.sensors.size() || !has(recorded_, frame.carrier) ||
      frame.postures.joints.size() != recorded_.variables.size() ||
      frame.postures.objects.size() != recorded_.objects.size()) {
    return std::nullopt;
  }
  const Sensor& sensor = recorded_.sensors[frame.sensor];
  const std::uint32_t found = index_of(sensor.name, now_.sensors);
  if (found == SceneMap::kNone || !same_entry(sensor, now_.sensors[found])) return std::nullopt;
  BuiltFrame out = frame;
  if (!translate(out.carrier)) return std::nullopt;
  out.sensor = found;
  out.scene_revision = now_.revision;
  out.postures = translate(frame.postures);
  return out;
}

bool FrameMap::translate(Carrier& carrier) const {
  if (carrier.kind == RobotBase::Kind::kWorld) return true;
  if (carrier.kind == RobotBase::Kind::kObject) {
    carrier.object = index_of(recorded_.objects[carrier.object].name, now_.objects);
    return carrier.object != SceneMap::kNone && !now_.objects[carrier.object].fixed;
  }
  carrier.robot = index_of(recorded_.robots[carrier.robot].name, now_.robots);
  if (carrier.robot == SceneMap::kNone) return false;
  // Links of a robot that is placed otherwise have no counterpart.
  return std::ranges::any_of(now_.robots[carrier.robot].links, [&](const RobotLink& link) {
    return link.object != RobotLink::kNoObject && map_.objects[link.object] != SceneMap::kNone;
  });
}

PlacedPostures FrameMap::translate(const PlacedPostures& recorded) const {
  PlacedPostures placed{.joints = std::vector<PlacedPostures::Joint>(now_.variables.size()),
                        .objects = std::vector<PastPose>(now_.objects.size())};
  for (std::size_t i = 0; i < placed.joints.size(); ++i)
    if (variables_[i] != SceneMap::kNone) placed.joints[i] = recorded.joints[variables_[i]];
  for (std::size_t i = 0; i < placed.objects.size(); ++i) {
    const Object& object = now_.objects[i];
    if (object.fixed) {
      placed.objects[i] = {.known = true, .world_from_body = object.world_from_object};
    } else if (objects_[i] != SceneMap::kNone) {
      placed.objects[i] = recorded.objects[objects_[i]];
    }
  }
  return placed;
}

}  // namespace clearance
