#include "tests/monitor/tick/true_bodies.hpp"

#include <cmath>

namespace clearance::test {
namespace {

double drawn(double most, Random& random) {
  return random.sign() * most * (random.chance(0.8) ? 1.0 : random.unit());
}

DrawnErrors::Place drawn(const PlaceError& most, Random& random) {
  return {.shift = std::abs(drawn(most.translation, random)) * random.direction(),
          .turn = std::abs(drawn(most.rotation, random)) * random.direction()};
}

Pose inverse(const Pose& pose) {
  const Eigen::Quaterniond back = pose.orientation.conjugate();
  return {.position = -(back * pose.position), .orientation = back};
}

Pose turned(const Vec3& by) {
  const double angle = by.norm();
  if (!(angle > 0.0)) return {};
  return {.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, by / angle))};
}

Pose displaced(const DrawnErrors::Place& by) {
  Pose pose = turned(by.turn);
  pose.position = by.shift;
  return pose;
}

// `errors`: of the variables.
Pose moved_by(const RobotJoint& joint, std::span<const double> positions,
              std::span<const double> errors) {
  if (variables_of(joint.type) != 1) return {};
  const double true_position = positions[joint.variable] + errors[joint.variable];
  const double at = joint.multiplier * true_position + joint.offset;
  switch (joint.type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return turned(at * joint.axis);
    case JointType::kPrismatic:
      return {.position = at * joint.axis};
    default:
      return {};
  }
}

}  // namespace

DrawnErrors drawn_errors(const Scene& scene, Random& random) {
  DrawnErrors errors;
  for (const Object& object : scene.objects)
    errors.objects.push_back(drawn(object.place_error, random));
  for (const Robot& robot : scene.robots) {
    errors.bases.push_back(drawn(robot.base_error, random));
    auto& frames = errors.frames.emplace_back();
    auto& positions = errors.positions.emplace_back();
    for (const RobotJoint& joint : robot.joints) {
      frames.push_back(drawn(joint.error.frame, random));
      const bool slides = joint.type == JointType::kPrismatic;
      positions.push_back(drawn(slides ? joint.error.slide : joint.error.position, random));
    }
  }
  return errors;
}

std::vector<Pose> true_poses(const Scene& scene, std::span<const double> positions,
                             std::span<const Pose> sent, const DrawnErrors& errors) {
  std::vector<Pose> nominal(scene.objects.size()), poses(scene.objects.size());
  std::vector<std::vector<Pose>> links, nominal_links;
  // What stands on something fixed is displaced with it.
  const auto on_resting = [&](const RestingOn& on, const Pose& place) {
    if (on.kind == RestingOn::Kind::kObject)
      return compose(poses[on.object], compose(inverse(nominal[on.object]), place));
    if (on.kind == RestingOn::Kind::kLink)
      return compose(links[on.robot][on.link],
                     compose(inverse(nominal_links[on.robot][on.link]), place));
    return place;
  };
  // One error for each variable: that of the joint that has its name, if others mimic it.
  const std::vector<double> exact(positions.size(), 0.0);
  std::vector<double> off = exact;
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    for (std::size_t j = 0; j < scene.robots[r].joints.size(); ++j) {
      const RobotJoint& joint = scene.robots[r].joints[j];
      if (variables_of(joint.type) == 1 && scene.variables[joint.variable].name == joint.name)
        off[joint.variable] = errors.positions[r][j];
    }
  }
  const auto place_object = [&](std::uint32_t i) {
    const Object& object = scene.objects[i];
    nominal[i] = object.fixed ? object.world_from_object : sent[i];
    poses[i] = compose(on_resting(object.resting_on, nominal[i]), displaced(errors.objects[i]));
  };
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].resting_on.kind == RestingOn::Kind::kWorld) place_object(i);
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    const Robot& robot = scene.robots[r];
    const auto place_root = [&](bool is_true) {
      const RobotBase& base = robot.base;
      const Pose& step = base.base_from_root;
      if (base.kind == RobotBase::Kind::kObject)
        return compose((is_true ? poses : nominal)[base.object], step);
      if (base.kind == RobotBase::Kind::kLink)
        return compose((is_true ? links : nominal_links)[base.robot][base.link], step);
      return is_true ? on_resting(base.resting_on, step) : step;
    };
    const Pose root = compose(place_root(true), displaced(errors.bases[r]));
    const Pose nominal_root = place_root(false);
    links.push_back({root});
    nominal_links.push_back({nominal_root});
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const RobotJoint& joint = robot.joints[j];
      const Pose frame = compose(links[r][joint.parent], joint.parent_from_joint);
      links[r].push_back(
          compose(compose(frame, displaced(errors.frames[r][j])), moved_by(joint, positions, off)));
      nominal_links[r].push_back(
          compose(compose(nominal_links[r][joint.parent], joint.parent_from_joint),
                  moved_by(joint, positions, exact)));
    }
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      if (robot.links[link].object != RobotLink::kNoObject)
        poses[robot.links[link].object] = links[r][link];
    }
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].resting_on.kind != RestingOn::Kind::kWorld) place_object(i);
  return poses;
}

}  // namespace clearance::test
