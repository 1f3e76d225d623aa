#include "monitor/ask/posture.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/chain_rounding.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/clouds/seen_cloud.hpp"

namespace clearance {
namespace {

std::string sensor_named(const std::string& name) { return "sensor \"" + name + "\": "; }

std::vector<double> radii_of(const Scene& scene, const std::vector<PosedPart>& parts) {
  std::vector<double> radii(scene.objects.size(), 0.0);
  for (const PosedPart& part : parts) {
    radii[part.object] = std::max(radii[part.object], part.bounding_radius);
  }
  return radii;
}

}  // namespace

Posture::Posture(const Scene& scene)
    : scene_(scene),
      parts_(parts_of(scene)),
      swept_(parts_.size()),
      first_part_(first_parts(scene)),
      placed_at_(parts_.size(), 0),
      chains_(scene, radii_of(scene, parts_)),
      trajectory_(scene.variables.size()),
      stops_(scene),
      variables_(scene.variables.size()),
      bounds_(scene.variables.size() + 2 * scene.robots.size()),
      kinematics_(scene.robots),
      moves_(scene.robots.size(), 0),
      bases_(scene.robots.size()),
      robot_of_object_(scene.objects.size(), kNoLink),
      link_of_object_(scene.objects.size(), kNoLink),
      carries_(scene.objects.size(), 0),
      radii_(radii_of(scene, parts_)),
      pose_(scene.objects.size()),
      present_(scene.objects.size(), 0),
      left_out_(scene.objects.size(), 0),
      absent_robots_(scene),
      speed_(scene.objects.size(), 0.0),
      age_(scene.objects.size(), 0.0),
      turn_speed_(scene.objects.size(), 0.0),
      approaches_(scene.objects.size()),
      freedom_(bounds_.size()),
      is_of_question_(scene.objects.size(), 1),
      may_deviate_(scene.objects.size(), Deviates::kNot),
      contents_(scene.sensors.size()) {
  free_variables_.reserve(bounds_.size());
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    const Robot& robot = scene.robots[r];
    if (robot.base.kind == RobotBase::Kind::kObject) carries_[robot.base.object] = 1;
    for (std::uint32_t i = 0; i < robot.links.size(); ++i) {
      const std::uint32_t object = robot.links[i].object;
      if (object == RobotLink::kNoObject) continue;
      robot_of_object_[object] = r;
      link_of_object_[object] = i;
    }
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    object_named_.emplace(scene.objects[i].name, i);
    present_[i] = (scene.objects[i].fixed && !scene.objects[i].absent) || is_link(i);
    if (scene.objects[i].fixed) {
      pose_[i] = scene.objects[i].world_from_object;
      place_resting(i);
    } else if (!is_link(i)) {
      free_.push_back(i);
    }
  }
}

std::optional<std::string> Posture::take(const Question& question) {
  if (auto text = trajectory_.take(question, scene_)) return text;
  if (auto text = stops_.take(question, trajectory_)) return text;
  if (auto text = take_joints(question)) return text;
  if (auto text = take_poses(question)) return text;
  if (auto text = take_motions(question)) return text;
  if (auto text = open_object(question)) return text;
  leave_out_absent_robots();
  if (auto text = open_joint()) return text;
  if (auto text = beyond_limits(question)) return text;
  free_carriers(question);
  note_free();
  place_bases();
  note_moving();
  return std::nullopt;
}

std::optional<std::string> Posture::find_free(const std::string& name,
                                              std::uint32_t& object) const {
  const auto at = object_named_.find(name);
  if (at == object_named_.end()) return "the cell has no object \"" + name + "\"";
  object = at->second;
  if (scene_.objects[object].fixed || is_link(object)) {
    return "object \"" + name + "\" is fixed, attached or part of a robot: leave its pose out";
  }
  if (present_[object] != 0) return "the pose of object \"" + name + "\" is stated twice";
  return std::nullopt;
}

std::optional<std::string> Posture::take_poses(const Question& question) {
  const bool within_speed = question.others == OthersMove::kWithinMaxSpeed;
  for (const std::uint32_t i : free_) {
    present_[i] = left_out_[i] = 0;
    age_[i] = turn_speed_[i] = 0.0;
    speed_[i] = within_speed ? scene_.objects[i].max_speed : 0.0;
    approaches_[i] = {};
  }
  for (const StatedPose& stated : question.poses) {
    std::uint32_t i = 0;
    if (auto text = find_free(stated.object, i)) return text;
    if (is_seen(i)) return sensor_named(stated.object) + "its pose comes with a frame";
    if (!stated.is_known) {
      left_out_[i] = 1;
      continue;
    }
    if (!(stated.turn_speed >= 0.0))
      return "the turn_speed of object \"" + stated.object + "\" is not a number from 0 on";
    if (auto text = take_pose(stated.object, i, stated.world_from_object, stated.age)) return text;
    turn_speed_[i] = within_speed ? stated.turn_speed : 0.0;
  }
  std::fill(contents_.begin(), contents_.end(), CloudPairs::Content());
  for (const SeenFrame& frame : question.seen) {
    if (auto text = take_frame(frame)) return text;
  }
  return std::nullopt;
}

std::optional<std::string> Posture::take_frame(const SeenFrame& frame) {
  std::uint32_t i = 0;
  if (auto text = find_free(frame.sensor, i)) return text;
  if (!is_seen(i)) return "object \"" + frame.sensor + "\" is no sensor, so it has no frame";
  if (!frame.is_known) {
    left_out_[i] = 1;
    return std::nullopt;
  }
  if (frame.cloud == nullptr || !frame.cloud->shows_place())
    return sensor_named(frame.sensor) + "its frame is empty, which is not known to be clear";
  if (!(frame.pose_error >= 0.0) || !std::isfinite(frame.pose_error))
    return sensor_named(frame.sensor) + "its pose_error is not a number from 0 on";
  contents_[scene_.objects[i].sensor] = {frame.cloud.get(), frame.pose_error,
                                         scene_.sensors[scene_.objects[i].sensor].greatest_depth};
  return take_pose(frame.sensor, i, frame.world_from_sensor, frame.age);
}

std::optional<std::string> Posture::take_pose(const std::string& name, std::uint32_t object,
                                              const Pose& pose, double age) {
  if (!is_unit(pose.orientation) || !pose.position.allFinite())
    return "the pose of object \"" + name + "\" is not finite, or its quaternion has not length 1";
  if (!(age >= 0.0) || !std::isfinite(age))
    return "the age of the pose of object \"" + name + "\" is not a number from 0 on";
  pose_[object] = pose;
  age_[object] = age;
  present_[object] = 1;
  place_resting(object);
  return std::nullopt;
}

std::optional<std::string> Posture::take_motions(const Question& question) {
  moving_objects_.clear();
  carrier_extent_ = 0.0;
  for (const ObjectMotion& motion : question.moving) {
    std::uint32_t i = 0;
    if (auto text = find_free(motion.object, i)) return text;
    if (is_seen(i)) return sensor_named(motion.object) + "what it sees has no stated motion";
    moving_objects_.push_back(i);
    if (carries_[i] != 0) {
      double farthest = 1.0;
      for (const Pose& pose : motion.world_from_object)
        farthest = std::max(farthest, pose.position.norm());
      carrier_extent_ += farthest;
    }
    present_[i] = 1;
    speed_[i] = 0.0;
  }
  return moving_.take(question, moving_objects_, trajectory_.times());
}

std::optional<std::string> Posture::open_object(const Question& question) {
  for (const std::uint32_t i : free_) {
    const Object& object = scene_.objects[i];
    if (left_out_[i] != 0) continue;
    if (present_[i] == 0 && !object.absent && object.is_seen())
      return sensor_named(object.name) +
             "it has no frame, so that nothing is known of what it sees; 'without' leaves it out";
    if (present_[i] == 0 && !object.absent) {
      return "object \"" + object.name +
             "\" has no pose: it is not fixed, so the question states it";
    }
    if (present_[i] != 0 && question.others == OthersMove::kWithinMaxSpeed &&
        !std::isfinite(speed_[i])) {
      return "object \"" + object.name +
             "\" has no max_speed in the cell: state one, or that other objects do not move";
    }
  }
  return std::nullopt;
}

void Posture::place_resting(std::uint32_t object) noexcept {
  for (std::uint32_t i = first_part_[object]; i < first_part_[object + 1]; ++i) {
    place_at(pose_[object], parts_[i]);
    placed_at_[i] = ~std::uint64_t{0};
  }
  sweep(object);
}

void Posture::sweep(std::uint32_t object) noexcept {
  const ObjectApproach& approach = approaches_[object];
  for (std::uint32_t i = first_part_[object]; i < first_part_[object + 1]; ++i) {
    swept_[i] = parts_[i].sphere_in_world;
    swept_[i].radius += approach.moved + approach.nearing.until_end;
  }
}

// The robots whose links are elsewhere at other instants.
void Posture::note_moving() noexcept {
  is_placed_ = false;
  std::ranges::fill(moves_, std::uint8_t{0});
  for (const std::uint32_t moved : trajectory_.moved()) moves_[scene_.variables[moved].robot] = 1;
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    if (base.kind == RobotBase::Kind::kObject && !moving_objects_.empty()) moves_[r] = 1;
    if (base.kind == RobotBase::Kind::kLink && moves_[base.robot] != 0) moves_[r] = 1;
  }
}

void Posture::place_bases() noexcept {
  for (std::size_t r = 0; r < bases_.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    if (base.kind != RobotBase::Kind::kObject) continue;
    bases_[r] = {};
    bases_[r].known = bases_[r].velocity_known = true;
    bases_[r].pose = pose_[base.object];
  }
}

void Posture::place(const Stretch& stretch, double at) noexcept {
  trajectory_.place(stretch, at, variables_, bounds_);
  if (stops_.counts()) stops_.place(stretch, at, variables_);
  if (!free_.empty()) place_free_objects(stretch, at);
  if (!moving_objects_.empty()) place_carriers();
  kinematics_.place(variables_, bases_, is_placed_ ? moves_ : std::span<const std::uint8_t>());
  is_placed_ = true;
  chains_.place(kinematics_, bases_);
  if (any_free_) note_freedom(stretch, at);
  ++instant_;
}

Instants Posture::elapsed(const Stretch& stretch, double at) const noexcept {
  if (stops_.counts()) return stops_.elapsed();
  const double begin = trajectory_.begin();
  return {stretch.to - begin, at - begin, stretch.from - begin};
}

void Posture::place_free_objects(const Stretch& stretch, double at) noexcept {
  const Instants since = elapsed(stretch, at);
  for (const std::uint32_t i : free_) {
    if (speed_[i] == 0.0) continue;
    ObjectApproach& approach = approaches_[i];
    approach.nearing = {rounded_up(swept(since.end + age_[i], speed_[i])),
                        rounded_down_if_finite(swept(since.middle + age_[i], speed_[i])),
                        rounded_down_if_finite(swept(since.begin + age_[i], speed_[i]))};
    sweep(i);
  }
  moving_.place(stretch, at);
  for (const ObjectState& state : moving_.states()) {
    pose_[state.object] = state.pose;
    place_resting(state.object);
    ObjectApproach& approach = approaches_[state.object];
    const double turning = swept(std::min(state.turn, 2.0), radii_[state.object]);
    approach.moved = rounded_up(state.shift + turning);
    approach.turned = rounded_up(turning + kPlacingError * state.pose.position.norm());
    approach.velocity = state.velocity;
    sweep(state.object);
  }
}

const LinkState& Posture::link_state(std::uint32_t object) const noexcept {
  return kinematics_.links(robot_of_object_[object])[link_of_object_[object]];
}

double Posture::age(std::uint32_t object) const noexcept {
  if (!is_link(object)) return age_[object];
  double oldest = 0.0;
  for (std::uint32_t robot = robot_of_object_[object];;) {
    for (const FreeVariable& free : free_variables_) {
      const bool is_joint = free.variable < scene_.variables.size();
      if (is_joint && scene_.variables[free.variable].robot == robot)
        oldest = std::max(oldest, free.age);
    }
    const RobotBase& base = scene_.robots[robot].base;
    if (base.kind == RobotBase::Kind::kObject) return std::max(oldest, age_[base.object]);
    if (base.kind != RobotBase::Kind::kLink) return oldest;
    robot = base.robot;
  }
}

void Posture::place_link_part(std::uint32_t index) noexcept {
  PosedPart& part = parts_[index];
  place_at(link_state(part.object).pose, part);
  placed_at_[index] = instant_;
}

Twist Posture::twist(std::uint32_t object, Vec3& origin) const noexcept {
  origin = Vec3::Zero();
  if (!is_link(object) || scene_.objects[object].fixed) return {};
  const LinkState& link = link_state(object);
  origin = link.pose.position;
  return link.twist;
}

}  // namespace clearance
