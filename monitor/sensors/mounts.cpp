#include "monitor/sensors/mounts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "config/scene/plausible_joints.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// A path that stands still seems to move by less, m and rad.
constexpr double kRounding = 1e-9;

const PastPose kOrigin{.known = true, .world_from_body = {}};

// A mount without stated speeds leaps if it is faster than this. It bounds nothing else.
constexpr MountSpeed kUnstated{.shift = kFastestBase, .turn = kFastestBaseTurn};

// Calibration and rounding change a robot's base by less than this, m and rad. A larger difference
// means another base or another world.
constexpr double kSameBase = 0.01;

}  // namespace

Mounts::Mounts(const Cell& cell) : cell_(cell), world_(cell.ros.world()) {
  const Scene& scene = cell.scene;
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const Robot& of = scene.robots[robot];
    for (std::uint32_t link = 0; link < of.links.size(); ++link)
      links_.emplace(of.links[link].name, std::pair(robot, link));
    if (of.base.kind == RobotBase::Kind::kWorld && of.base.frame.empty() && !of.is_attached)
      fixed_roots_.push_back({of.links[0].name, of.base.base_from_root});
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!object.frame.empty()) objects_.emplace(object.frame, i);
  }
}

void Mounts::find_base(const std::string& frame, const PostureHistory& postures, Path& path) const {
  if (frame == world_) {
    path.base = kOrigin;
  } else if (const auto link = links_.find(frame); link != links_.end()) {
    const auto [robot, number] = link->second;
    path.base = postures.link(robot, number);
    path.carrier = {.kind = RobotBase::Kind::kLink, .robot = robot, .link = number};
  } else if (const auto object = objects_.find(frame); object != objects_.end()) {
    path.base = postures.object(object->second);
    path.carrier = {.kind = RobotBase::Kind::kObject, .object = object->second};
  }
}

// A path that is longer than the number of frames contains a cycle.
void Mounts::climb(std::string at, std::int64_t stamp_ns, const FrameHistory& frames,
                   const PostureHistory& postures, Path& path) const {
  while (!path.base && path.frames.size() <= FrameHistory::kMostFrames) {
    const auto parent = frames.parent(at, stamp_ns);
    if (!parent) break;
    path.known_until_ns = std::min(path.known_until_ns, parent->known_until_ns);
    path.frames.push_back(std::exchange(at, *parent->name));
    find_base(at, postures, path);
  }
}

Mounts::Path Mounts::path_of(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                             const FrameHistory& frames, const PostureHistory& postures) const {
  Path path;
  const std::string& at = sensor.frames_by_message ? frame : sensor.mount.frame;
  find_base(at, postures, path);
  climb(at, stamp_ns, frames, postures, path);
  return path;
}

std::string Mounts::robot_elsewhere(const Sensor& sensor, const std::string& frame,
                                    std::int64_t stamp_ns, const FrameHistory& frames,
                                    const PostureHistory& postures, PastPose& place) const {
  if (!sensor.is_on_tf()) return {};
  const auto kind = path_of(sensor, frame, stamp_ns, frames, postures).carrier.kind;
  if (kind == RobotBase::Kind::kLink) return {};
  Excess most;
  for (const FixedRoot& root : fixed_roots_) {
    Path path;
    if (root.frame == world_) path.base = kOrigin;
    climb(root.frame, stamp_ns, frames, postures, path);
    if (!path.base || path.carrier.kind != RobotBase::Kind::kWorld) continue;
    const auto found = along(path, kOrigin, std::min(stamp_ns, path.known_until_ns), 0, frames);
    if (!found) continue;
    const Pose& by_tf = found->place.world_from_body;
    const Pose& by_cell = root.world_from_root;
    const double shift = way_between(by_tf, by_cell), turned = angle_between(by_tf, by_cell);
    if (shift > kSameBase + found->place.shift_error ||
        turned > kSameBase + found->place.turn_error) {
      return fmt::format("tf has '{}' {:.1f} mm and {:.1f} mrad from where the cell has it",
                         root.frame, 1e3 * shift, 1e3 * turned);
    }
    // The sensor's pose after the motion that takes the robot from its place in tf to its place in
    // the cell.
    const Pose& at = place.world_from_body;
    const Eigen::Quaterniond turn =
        by_cell.orientation.normalized() * by_tf.orientation.conjugate();
    const Pose moved{by_cell.position + turn * (at.position - by_tf.position),
                     turn * at.orientation};
    most.shift = std::max(most.shift, way_between(moved, at));
    most.turn = std::max(most.turn, angle_between(moved, at));
  }
  place.shift_error = rounded_up(place.shift_error + most.shift);
  place.turn_error = rounded_up(place.turn_error + most.turn);
  return {};
}

bool Mounts::awaits_transforms(const Sensor& sensor, const std::string& frame,
                               std::int64_t stamp_ns, const FrameHistory& frames,
                               const PostureHistory& postures) const {
  if (!sensor.is_on_tf()) return false;
  const Path path = path_of(sensor, frame, stamp_ns, frames, postures);
  return path.base && path.known_until_ns < stamp_ns + sensor.stamp_error_ns &&
         elapsed(path.known_until_ns, stamp_ns) <= FrameHistory::kLostNs;
}

std::optional<Mounts::PathPlace> Mounts::along(const Path& path, PastPose place,
                                               std::int64_t stamp_ns, std::int64_t within_ns,
                                               const FrameHistory& frames) {
  PathPlace found{.place = std::move(place)};
  for (auto child = path.frames.rbegin(); child != path.frames.rend(); ++child) {
    const auto step = frames.step(*child, stamp_ns, within_ns);
    if (!step) return std::nullopt;
    found.place =
        carried(found.place, step->parent_from_child, step->shift_error, step->turn_error);
    found.longest_ns = std::max(found.longest_ns, step->longest_ns);
  }
  return found;
}

// The speeds are those of the whole path, so the ends of the gap must be times at which no frame of
// it is within one, and both are off by their own errors. Other frames may not be heard yet at the
// second end: then the first one alone counts.
std::optional<Mounts::Excess> Mounts::deviation_in_gap(const MountSpeed& speed, const Path& path,
                                                       std::int64_t stamp_ns,
                                                       const FrameHistory& frames) {
  std::int64_t before_ns = stamp_ns, after_ns = stamp_ns;
  std::vector<std::int64_t> stamps;
  for (const std::string& child : path.frames) {
    stamps.clear();
    frames.append_stamps(child, stamp_ns, stamp_ns, stamps);
    const auto next = std::ranges::lower_bound(stamps, stamp_ns);
    if (next == stamps.end() || *next == stamp_ns) continue;
    after_ns = std::max(after_ns, *next);
    if (next != stamps.begin()) before_ns = std::min(before_ns, *std::prev(next));
  }
  const auto at = along(path, kOrigin, stamp_ns, 0, frames);
  const auto before = along(path, kOrigin, before_ns, 0, frames);
  const auto after = along(path, kOrigin, after_ns, 0, frames);
  if (!at || !before) return std::nullopt;
  // Another frame of the path may have such a gap around an end.
  if (before->longest_ns > kLongGapNs || (after && after->longest_ns > kLongGapNs))
    return std::nullopt;
  if (before_ns == after_ns) return Excess{};
  const Pose& pose = at->place.world_from_body;
  const double since = seconds(elapsed(before_ns, stamp_ns)),
               until = seconds(elapsed(stamp_ns, after_ns));
  const PastPose& a = before->place;
  if (!after) {
    return Excess{
        .shift =
            rounded_up(way_between(a.world_from_body, pose) + a.shift_error + speed.shift * since),
        .turn =
            rounded_up(angle_between(a.world_from_body, pose) + a.turn_error + speed.turn * since)};
  }
  const PastPose& b = after->place;
  const Pose line = pose_between(a.world_from_body, b.world_from_body, since / (since + until));
  const double ends_shift = std::max(a.shift_error, b.shift_error);
  const double way = way_between(a.world_from_body, b.world_from_body);
  const double angle = angle_between(a.world_from_body, b.world_from_body);
  const double shift = deviation_in_space(since, until, speed.shift,
                                          std::max(0.0, way - 2.0 * ends_shift) / (since + until));
  const double turn = deviation_of_turn(since, until, speed.turn, angle / (since + until));
  return Excess{
      .shift = rounded_up(shift + 2.0 * ends_shift + way_between(line, pose)),
      .turn = rounded_up(turn + std::max(a.turn_error, b.turn_error) + angle_between(line, pose))};
}

// Frames of a path may leap and correct each other, as those of a localisation and its odometry do.
// So the path is compared as a whole. Timing errors are those that the tick allows of an input.
std::optional<Mounts::Excess> Mounts::excess(const Sensor& sensor, const Path& path,
                                             std::int64_t last_ns,
                                             const FrameHistory& frames) const {
  std::vector<std::int64_t> stamps;
  for (const std::string& child : path.frames)
    frames.append_stamps(child, less(last_ns, FrameHistory::kLostNs), last_ns, stamps);
  std::ranges::sort(stamps);
  Excess found;
  std::optional<Pose> before;
  std::int64_t before_ns = 0;
  const double age_s = seconds(cell_.scene.objects[sensor.object].age_limit_ns);
  const bool is_stated = sensor.mount_speed.is_stated();
  const MountSpeed& speed = is_stated ? sensor.mount_speed : kUnstated;
  for (const std::int64_t stamp_ns : stamps) {
    if (before && stamp_ns == before_ns) continue;
    const auto at = along(path, kOrigin, stamp_ns, 0, frames);
    const std::optional<Pose> pose = at ? std::optional(at->place.world_from_body) : std::nullopt;
    if (pose && before) {
      const double time_s = seconds(elapsed(before_ns, stamp_ns));
      const double way = way_between(*before, *pose), angle = angle_between(*before, *pose);
      const double shift = way - speed.shift * time_s, turn = angle - speed.turn * time_s;
      if (shift > speed.shift * age_s + kRounding || turn > speed.turn * age_s + kRounding)
        return std::nullopt;
      if (is_stated) {
        found.shift = std::max(found.shift, shift);
        found.turn = std::max(found.turn, turn);
      } else {
        // The frame may have moved the other way meanwhile.
        if (shift > kRounding) found.shift = rounded_up(found.shift + way + speed.shift * time_s);
        if (turn > kRounding) found.turn = rounded_up(found.turn + angle + speed.turn * time_s);
      }
    }
    before = pose;
    before_ns = stamp_ns;
  }
  return found;
}

// If the transforms end before the stamp, the frame moves on from the last place that is known at
// no more than the stated speeds. They are those of the whole path, and not of each of its frames.
PastPose Mounts::of_frame(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                          const FrameHistory& frames, const PostureHistory& postures) const {
  const Path path = path_of(sensor, frame, stamp_ns, frames, postures);
  if (!path.base || !path.base->known) return {};
  const std::int64_t until_ns = path.known_until_ns, within_ns = sensor.stamp_error_ns;
  const bool is_late = until_ns < stamp_ns + within_ns;
  const std::int64_t late_ns = elapsed(until_ns, stamp_ns);
  if (is_late && (!sensor.mount_speed.is_stated() || late_ns > FrameHistory::kLostNs)) return {};
  const std::int64_t at_ns = is_late ? until_ns : stamp_ns;
  const auto found = along(path, *path.base, at_ns, is_late ? 0 : within_ns, frames);
  if (!found) return {};
  PastPose place = found->place;
  if (sensor.mount_speed.is_stated() && found->longest_ns > kLongGapNs) {
    const auto off = deviation_in_gap(sensor.mount_speed, path, at_ns, frames);
    if (!off) return {};
    const double within_s = is_late ? 0.0 : seconds(within_ns);
    place.shift_error =
        rounded_up(place.shift_error + off->shift + sensor.mount_speed.shift * within_s);
    place.turn_error =
        rounded_up(place.turn_error + off->turn + sensor.mount_speed.turn * within_s);
  }
  const auto beyond = excess(sensor, path, is_late ? until_ns : stamp_ns + within_ns, frames);
  if (!beyond) return {};
  place.shift_error = rounded_up(place.shift_error + beyond->shift);
  place.turn_error = rounded_up(place.turn_error + beyond->turn);
  if (is_late) {
    const double late_s = seconds(late_ns + elapsed(stamp_ns, until_ns) + within_ns);
    place.shift_error =
        rounded_up(place.shift_error + rounded_up(sensor.mount_speed.shift * late_s));
    place.turn_error = rounded_up(place.turn_error + rounded_up(sensor.mount_speed.turn * late_s));
  }
  return place;
}

Carrier Mounts::carrier(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                        const FrameHistory& frames, const PostureHistory& postures) const {
  const RobotBase& mount = sensor.mount;
  return sensor.is_on_tf() ? path_of(sensor, frame, stamp_ns, frames, postures).carrier
                           : Carrier{mount.kind, mount.object, mount.robot, mount.link};
}

PastPose Mounts::find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                      const FrameHistory& frames, const PostureHistory& postures) const {
  const RobotBase& mount = sensor.mount;
  if (sensor.is_on_tf()) {
    const PastPose place = of_frame(sensor, frame, stamp_ns, frames, postures);
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
