#include "monitor/sensors/mounts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "config/scene/plausible_joints.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

const PastPose kOrigin{.known = true, .world_from_body = {}};

// Calibration and rounding change a robot's base by less than this, m and rad. A larger difference
// means another base or another world.
constexpr double kSameBase = 0.01;

MountTrack::Limits limits_of(const Scene& scene, const Sensor& sensor) noexcept {
  return {.speed = sensor.mount_speed,
          .age_ns = scene.objects[sensor.object].age_limit_ns,
          .future_ns = scene.future_limit_ns};
}

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
  for (const Sensor& sensor : scene.sensors) {
    Tracks& tracks = tracks_.emplace_back();
    if (sensor.is_on_tf() && !sensor.frames_by_message)
      tracks.try_emplace(sensor.mount.frame, limits_of(scene, sensor));
  }
}

void Mounts::take_over(Mounts& before) {
  if (world_ != before.world_) return;
  const std::vector<Sensor>& sensors = cell_.scene.sensors;
  for (std::size_t old = 0; old < before.tracks_.size(); ++old) {
    const std::string& name = before.cell_.scene.sensors[old].name;
    const auto found = std::ranges::find(sensors, name, &Sensor::name);
    if (found == sensors.end() || !found->is_on_tf()) continue;
    for (auto& [frame, track] : before.tracks_[old]) {
      const bool is_same = found->frames_by_message || frame == found->mount.frame;
      if (!is_same || !track.has_value() || track.value().carrier != Carrier{}) continue;
      track.limit(limits_of(cell_.scene, *found));
      tracks_[static_cast<std::size_t>(found - sensors.begin())].insert_or_assign(frame,
                                                                                  std::move(track));
    }
  }
}

void Mounts::find_carrier(const std::string& frame, Path& path) const {
  path.leads = true;
  if (frame == world_) return;
  if (const auto link = links_.find(frame); link != links_.end()) {
    const auto [robot, number] = link->second;
    path.carrier = {.kind = RobotBase::Kind::kLink, .robot = robot, .link = number};
  } else if (const auto object = objects_.find(frame); object != objects_.end()) {
    path.carrier = {.kind = RobotBase::Kind::kObject, .object = object->second};
  } else {
    path.leads = false;
  }
}

PastPose Mounts::base_of(const Carrier& carrier, const PostureHistory& postures) {
  switch (carrier.kind) {
    case RobotBase::Kind::kWorld:
      break;
    case RobotBase::Kind::kObject:
      return postures.object(carrier.object);
    case RobotBase::Kind::kLink:
      return postures.link(carrier.robot, carrier.link);
  }
  return kOrigin;
}

// A path that is longer than the number of frames contains a cycle.
void Mounts::climb(std::string at, std::int64_t stamp_ns, const TfFrames& frames,
                   const Instead* instead, Path& path) const {
  while (!path.leads && path.claims.size() <= frames.tree().links().size()) {
    const bool is_instead = instead != nullptr && instead->child == at;
    const TfFrames::Claim* const claim = is_instead ? &instead->claim : frames.used(at);
    const auto parent = claim != nullptr ? TfFrames::parent(*claim, stamp_ns) : std::nullopt;
    if (!parent) break;
    path.known_until_ns = std::min(path.known_until_ns, parent->known_until_ns);
    path.claims.push_back(claim);
    path.children.push_back(std::exchange(at, *parent->name));
    find_carrier(at, path);
  }
}

Mounts::Path Mounts::path_of(const std::string& frame, std::int64_t stamp_ns,
                             const TfFrames& frames, const Instead* instead) const {
  Path path;
  find_carrier(frame, path);
  climb(frame, stamp_ns, frames, instead, path);
  return path;
}

std::string Mounts::robot_elsewhere(const Sensor& sensor, const std::string& frame,
                                    std::int64_t stamp_ns, const TfFrames& frames,
                                    PastPose& place) const {
  if (!sensor.is_on_tf()) return {};
  const auto kind = path_of(frame_of(sensor, frame), stamp_ns, frames).carrier.kind;
  if (kind == RobotBase::Kind::kLink) return {};
  MountTrack::Excess most;
  for (const FixedRoot& root : fixed_roots_) {
    Path path;
    path.leads = root.frame == world_;
    climb(root.frame, stamp_ns, frames, nullptr, path);
    if (!path.leads || path.carrier.kind != RobotBase::Kind::kWorld) continue;
    const auto found = along(path, kOrigin, std::min(stamp_ns, path.known_until_ns), 0);
    if (!found) continue;
    const Pose& by_tf = found->place.world_from_body;
    const Pose& by_cell = root.world_from_root;
    const double shift = distance_between(by_tf, by_cell), turned = angle_between(by_tf, by_cell);
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
    most.shift = std::max(most.shift, distance_between(moved, at));
    most.turn = std::max(most.turn, angle_between(moved, at));
  }
  place.shift_error = rounded_up(place.shift_error + most.shift);
  place.turn_error = rounded_up(place.turn_error + most.turn);
  return {};
}

bool Mounts::awaits_transforms(const Sensor& sensor, const std::string& frame,
                               std::int64_t stamp_ns, const TfFrames& frames) const {
  if (!sensor.is_on_tf()) return false;
  const Path path = path_of(frame_of(sensor, frame), stamp_ns, frames);
  return path.leads && path.known_until_ns < stamp_ns + sensor.stamp_error_ns &&
         elapsed(path.known_until_ns, stamp_ns) <= kSourceSilentNs;
}

void Mounts::forget() {
  for (Tracks& tracks : tracks_) {
    for (auto& [frame, track] : tracks) track.forget();
  }
}

void Mounts::judge(const TfFrames& frames, const Now& now) {
  for (Tracks& tracks : tracks_) {
    for (auto& [frame, track] : tracks) judge(frame, frames, now, track);
  }
}

void Mounts::judge(const Sensor& sensor, const std::string& frame, const TfFrames& frames,
                   const Now& now) {
  if (!sensor.is_on_tf()) return;
  const std::string& of = frame_of(sensor, frame);
  Tracks& tracks = tracks_[cell_.scene.objects[sensor.object].sensor];
  judge(of, frames, now, tracks.try_emplace(of, limits_of(cell_.scene, sensor)).first->second);
}

// Every transform of the path since the last time counts, also one that others have followed. A
// static transform that has changed shows at the time that was judged last.
void Mounts::judge(const std::string& frame, const TfFrames& frames, const Now& now,
                   MountTrack& track) const {
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  const Path path = path_of(frame, kLast, frames);
  const std::int64_t until_ns = path.is_static() ? now.realtime_ns : path.known_until_ns;
  std::int64_t from_ns = track.has_value() ? track.judged_until() : 0;
  if (elapsed(until_ns, from_ns) > kSetBackNs) from_ns = 0;
  std::vector<std::int64_t> stamps;
  if (path.leads) stamps.push_back(until_ns);
  for (const TfFrames::Claim* const claim : path.claims)
    TfFrames::append_stamps(*claim, from_ns, until_ns, stamps);
  std::ranges::sort(stamps);
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  for (const std::int64_t stamp_ns : stamps) {
    if (stamp_ns >= from_ns && stamp_ns <= until_ns)
      judge_at(stamp_ns, frame, frames, now.realtime_ns, track);
  }
  judge_rivals(frame, path, frames, now, track);
}

void Mounts::judge_at(std::int64_t stamp_ns, const std::string& frame, const TfFrames& frames,
                      std::int64_t now_ns, MountTrack& track) const {
  const Path path = path_of(frame, stamp_ns, frames);
  const auto found = path.leads ? along(path, kOrigin, stamp_ns, 0) : std::nullopt;
  if (!found) return;
  const CarriedPose pose{path.carrier, found->place.world_from_body};
  // Nothing is new of this time.
  if (track.has_value() && stamp_ns == track.judged_until() &&
      pose.carrier == track.value().carrier && same_pose(pose.pose, track.value().pose)) {
    return;
  }
  std::string source;
  for (const std::string& child : path.children) {
    const auto claims = frames.claims(child);
    if (source.empty() && !claims.empty()) source = claims.front().suffix;
  }
  track.add(source, pose, stamp_ns, now_ns);
}

// Where the path would lead by each claim that is not used.
void Mounts::judge_rivals(const std::string& frame, const Path& used, const TfFrames& frames,
                          const Now& now, MountTrack& track) const {
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  for (const std::string& child : used.children) {
    const auto claims = frames.claims(child);
    for (std::size_t i = 1; i < claims.size(); ++i) {
      if (!TfFrames::is_live(claims[i], now.monotonic_ns)) continue;
      const Instead instead{child, claims[i]};
      const std::int64_t until_ns = path_of(frame, kLast, frames, &instead).known_until_ns;
      const std::int64_t at_ns = std::min(until_ns, now.realtime_ns);
      const Path path = path_of(frame, at_ns, frames, &instead);
      const auto found = path.leads ? along(path, kOrigin, at_ns, 0) : std::nullopt;
      std::optional<CarriedPose> pose;
      if (found) pose = CarriedPose{path.carrier, found->place.world_from_body};
      track.add_rival(claims[i].suffix, pose, at_ns, now.realtime_ns);
    }
  }
}

const MountTrack* Mounts::track_of(const Sensor& sensor, const std::string& frame) const {
  const Tracks& tracks = tracks_[cell_.scene.objects[sensor.object].sensor];
  const auto found = tracks.find(frame_of(sensor, frame));
  return found == tracks.end() ? nullptr : &found->second;
}

std::optional<Mounts::PathPlace> Mounts::along(const Path& path, PastPose place,
                                               std::int64_t stamp_ns, std::int64_t within_ns) {
  PathPlace found{.place = std::move(place)};
  for (auto claim = path.claims.rbegin(); claim != path.claims.rend(); ++claim) {
    const auto step = TfFrames::step(**claim, stamp_ns, within_ns);
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
std::optional<MountTrack::Excess> Mounts::deviation_in_gap(const MountSpeed& speed,
                                                           const Path& path,
                                                           std::int64_t stamp_ns) {
  std::int64_t before_ns = stamp_ns, after_ns = stamp_ns;
  std::vector<std::int64_t> stamps;
  for (const TfFrames::Claim* const claim : path.claims) {
    stamps.clear();
    TfFrames::append_stamps(*claim, stamp_ns, stamp_ns, stamps);
    const auto next = std::ranges::lower_bound(stamps, stamp_ns);
    if (next == stamps.end() || *next == stamp_ns) continue;
    after_ns = std::max(after_ns, *next);
    if (next != stamps.begin()) before_ns = std::min(before_ns, *std::prev(next));
  }
  const auto at = along(path, kOrigin, stamp_ns, 0);
  const auto before = along(path, kOrigin, before_ns, 0);
  const auto after = along(path, kOrigin, after_ns, 0);
  if (!at || !before) return std::nullopt;
  // Another frame of the path may have such a gap around an end.
  if (before->longest_ns > kLongGapNs || (after && after->longest_ns > kLongGapNs))
    return std::nullopt;
  if (before_ns == after_ns) return MountTrack::Excess{};
  const Pose& pose = at->place.world_from_body;
  const double since = seconds(elapsed(before_ns, stamp_ns)),
               until = seconds(elapsed(stamp_ns, after_ns));
  const PastPose& a = before->place;
  if (!after) {
    return MountTrack::Excess{.shift = rounded_up(distance_between(a.world_from_body, pose) +
                                                  a.shift_error + speed.shift * since),
                              .turn = rounded_up(angle_between(a.world_from_body, pose) +
                                                 a.turn_error + speed.turn * since)};
  }
  const PastPose& b = after->place;
  const Pose line = pose_between(a.world_from_body, b.world_from_body, since / (since + until));
  const double ends_shift = std::max(a.shift_error, b.shift_error);
  const double apart = distance_between(a.world_from_body, b.world_from_body);
  const double angle = angle_between(a.world_from_body, b.world_from_body);
  const double shift = deviation_in_space(
      since, until, speed.shift, std::max(0.0, apart - 2.0 * ends_shift) / (since + until));
  const double turn = deviation_of_turn(since, until, speed.turn, angle / (since + until));
  return MountTrack::Excess{
      .shift = rounded_up(shift + 2.0 * ends_shift + distance_between(line, pose)),
      .turn = rounded_up(turn + std::max(a.turn_error, b.turn_error) + angle_between(line, pose))};
}

// If the transforms end before the stamp, the frame moves on from the last place that is known at
// no more than the stated speeds. They are those of the whole path, and not of each of its frames.
PastPose Mounts::of_frame(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                          const TfFrames& frames, const PostureHistory& postures) const {
  const Path path = path_of(frame_of(sensor, frame), stamp_ns, frames);
  const PastPose base = path.leads ? base_of(path.carrier, postures) : PastPose{};
  const MountTrack* const track = track_of(sensor, frame);
  if (!base.known || track == nullptr) return {};
  const std::int64_t until_ns = path.known_until_ns, within_ns = sensor.stamp_error_ns;
  const bool is_late = until_ns < stamp_ns + within_ns;
  const std::int64_t late_ns = elapsed(until_ns, stamp_ns);
  if (is_late && (!sensor.mount_speed.is_stated() || late_ns > kSourceSilentNs)) return {};
  const std::int64_t at_ns = is_late ? until_ns : stamp_ns;
  if (track->is_contradicted(std::min(at_ns, stamp_ns - within_ns), stamp_ns + within_ns))
    return {};
  const auto found = along(path, base, at_ns, is_late ? 0 : within_ns);
  if (!found) return {};
  PastPose place = found->place;
  if (sensor.mount_speed.is_stated() && found->longest_ns > kLongGapNs) {
    const auto off = deviation_in_gap(sensor.mount_speed, path, at_ns);
    if (!off) return {};
    const double within_s = is_late ? 0.0 : seconds(within_ns);
    place.shift_error =
        rounded_up(place.shift_error + off->shift + sensor.mount_speed.shift * within_s);
    place.turn_error =
        rounded_up(place.turn_error + off->turn + sensor.mount_speed.turn * within_s);
  }
  const MountTrack::Excess beyond = track->excess(is_late ? until_ns : stamp_ns + within_ns);
  place.shift_error = rounded_up(place.shift_error + beyond.shift);
  place.turn_error = rounded_up(place.turn_error + beyond.turn);
  if (is_late) {
    const double late_s = seconds(late_ns + elapsed(stamp_ns, until_ns) + within_ns);
    place.shift_error =
        rounded_up(place.shift_error + rounded_up(sensor.mount_speed.shift * late_s));
    place.turn_error = rounded_up(place.turn_error + rounded_up(sensor.mount_speed.turn * late_s));
  }
  return place;
}

Carrier Mounts::carrier(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                        const TfFrames& frames) const {
  const RobotBase& mount = sensor.mount;
  return sensor.is_on_tf() ? path_of(frame_of(sensor, frame), stamp_ns, frames).carrier
                           : Carrier{mount.kind, mount.object, mount.robot, mount.link};
}

PastPose Mounts::find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                      const TfFrames& frames, const PostureHistory& postures) const {
  if (sensor.is_on_tf()) {
    const PastPose place = of_frame(sensor, frame, stamp_ns, frames, postures);
    return place.known ? carried(place, sensor.mount.frame_from_root, 0.0, 0.0) : place;
  }
  const PastPose base = base_of(carrier(sensor, frame, stamp_ns, frames), postures);
  return base.known ? carried(base, sensor.mount.base_from_root, 0.0, 0.0) : base;
}

}  // namespace clearance
