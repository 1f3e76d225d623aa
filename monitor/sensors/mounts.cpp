#include "monitor/sensors/mounts.hpp"

#include <algorithm>
#include <vector>

namespace clearance {

Mounts::Mounts(const Cell& cell, bool any_root) : cell_(cell), any_root_(any_root) {
  const Scene& scene = cell.scene;
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    for (std::uint32_t link = 0; link < scene.robots[robot].links.size(); ++link)
      links_.emplace(scene.robots[robot].links[link].name, std::pair(robot, link));
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.is_seen() || links_.contains(object.name)) continue;
    objects_.emplace(object.frame.empty() ? object.name : object.frame, i);
  }
}

std::optional<PastPose> Mounts::known_place(const std::string& frame,
                                            const PostureHistory& postures) const {
  if (!cell_.ros.world_frame.empty() && frame == cell_.ros.world_frame)
    return PastPose{.known = true, .world_from_body = {}};
  if (const auto link = links_.find(frame); link != links_.end())
    return postures.link(link->second.first, link->second.second);
  if (const auto object = objects_.find(frame); object != objects_.end())
    return postures.object(object->second);
  return std::nullopt;
}

// A path that is longer than the number of frames contains a cycle.
PastPose Mounts::of_frame(const std::string& frame, const FrameTime& time,
                          const FrameHistory& frames, const PostureHistory& postures) const {
  std::vector<FrameHistory::Step> path;
  std::string at = frame;
  std::optional<PastPose> place = known_place(at, postures);
  while (!place) {
    auto step = frames.step(at, time.stamp_ns, time.within_ns);
    if (!step) {
      if (any_root_ && cell_.ros.world_frame.empty() && !path.empty())
        place = PastPose{.known = true, .world_from_body = {}};
      break;
    }
    if (path.size() > FrameHistory::kMostFrames) return {};
    at = step->parent;
    path.push_back(*std::move(step));
    place = known_place(at, postures);
  }
  if (!place || !place->known) return {};
  for (auto step = path.rbegin(); step != path.rend(); ++step)
    place = carried(*place, step->parent_from_child, step->shift_error, step->turn_error);
  return *place;
}

PastPose Mounts::find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                      const FrameHistory& frames, const PostureHistory& postures) const {
  const FrameTime time{stamp_ns, sensor.stamp_error_ns};
  if (sensor.frames_by_message) return of_frame(frame, time, frames, postures);
  const RobotBase& mount = sensor.mount;
  if (!mount.frame.empty()) {
    const PastPose place = of_frame(mount.frame, time, frames, postures);
    return place.known ? carried(place, mount.frame_from_root, 0.0, 0.0) : place;
  }
  PastPose base{.known = true, .world_from_body = {}};
  switch (mount.kind) {
    case RobotBase::Kind::kWorld:
      break;
    case RobotBase::Kind::kObject:
      base = postures.object(mount.object);
      break;
    case RobotBase::Kind::kLink:
      base = postures.link(mount.robot, mount.link);
      break;
  }
  return base.known ? carried(base, mount.base_from_root, 0.0, 0.0) : base;
}

}  // namespace clearance
