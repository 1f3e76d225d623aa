#include "monitor/ask/posture.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/chain_rounding.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kNoLink = ~0u;

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
      first_part_(first_parts(scene)),
      placed_at_(parts_.size(), 0),
      chains_(scene, radii_of(scene, parts_)),
      trajectory_(scene.variables.size()),
      variables_(scene.variables.size()),
      bounds_(scene.variables.size()),
      kinematics_(scene.robots),
      bases_(scene.robots.size()),
      robot_of_object_(scene.objects.size(), kNoLink),
      link_of_object_(scene.objects.size(), kNoLink),
      pose_(scene.objects.size()),
      present_(scene.objects.size(), 0),
      age_(scene.objects.size(), 0.0) {
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    for (std::uint32_t i = 0; i < scene.robots[r].links.size(); ++i) {
      const std::uint32_t object = scene.robots[r].links[i].object;
      if (object == RobotLink::kNoObject) continue;
      robot_of_object_[object] = r;
      link_of_object_[object] = i;
    }
  }
}

std::optional<std::string> Posture::take(const Question& question) {
  if (auto text = trajectory_.take(question.motion, scene_)) return text;
  if (auto text = take_joints(question)) return text;
  if (auto text = take_poses(question)) return text;
  place_resting();
  return std::nullopt;
}

std::optional<std::string> Posture::take_joints(const Question& question) {
  for (TrackedVariable& variable : variables_) {
    variable.input.has_value = false;
    variable.velocity_known = true;
    variable.velocity = 0.0;
  }
  std::fill(bounds_.begin(), bounds_.end(), VariableBounds());
  for (const std::uint32_t moved : trajectory_.moved()) variables_[moved].input.has_value = true;
  for (const HeldJoint& held : question.held) {
    const auto variable = variable_named(scene_, held.name);
    if (!variable) return "the cell has no joint \"" + held.name + "\"";
    if (variables_[*variable].input.has_value) {
      return "joint \"" + held.name + "\" is held, and has a position already";
    }
    if (!(std::abs(held.position) <= kLargestJoint)) {
      return "the position of joint \"" + held.name + "\" is not finite, or larger than 1e6";
    }
    variables_[*variable].input.has_value = true;
    variables_[*variable].position = held.position;
  }
  for (const Robot& robot : scene_.robots) {
    for (const RobotJoint& joint : robot.joints) {
      const std::uint32_t count = variables_of(joint.type);
      for (std::uint32_t v = joint.variable; v < joint.variable + count; ++v) {
        if (!variables_[v].input.has_value) {
          return "joint \"" + scene_.variables[v].name +
                 "\" has no position: the motion moves it, or it is held";
        }
        const auto moved = trajectory_.moved();
        const bool moves = std::find(moved.begin(), moved.end(), v) != moved.end();
        if (moves && count > 1) {
          return "joint \"" + joint.name + "\" is planar or floating: it can only be held";
        }
      }
    }
  }
  return slide_out_of_limits();
}

// The reaches of chains include the limits of sliding joints.
std::optional<std::string> Posture::slide_out_of_limits() const {
  const auto is_outside = [&](std::uint32_t v, double position) {
    const JointVariable& limits = scene_.variables[v];
    return std::abs(position) > kLargestLength ||
           position < limits.lower - limits.limit_tolerance ||
           position > limits.upper + limits.limit_tolerance;
  };
  for (const Robot& robot : scene_.robots) {
    for (const RobotJoint& joint : robot.joints) {
      if (joint.type != JointType::kPrismatic) continue;
      if (trajectory_.leaves(
              joint.variable, [&](double p) { return is_outside(joint.variable, p); },
              variables_[joint.variable].position)) {
        return "joint \"" + scene_.variables[joint.variable].name + "\" slides out of its limits";
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> Posture::take_poses(const Question& question) {
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    const Object& object = scene_.objects[i];
    present_[i] = object.fixed || robot_of_object_[i] != kNoLink;
    if (object.fixed) pose_[i] = object.world_from_object;
    age_[i] = 0.0;
  }
  for (const StatedPose& stated : question.poses) {
    const auto at =
        std::find_if(scene_.objects.begin(), scene_.objects.end(),
                     [&](const Object& object) { return object.name == stated.object; });
    if (at == scene_.objects.end()) return "the cell has no object \"" + stated.object + "\"";
    const std::size_t i = static_cast<std::size_t>(at - scene_.objects.begin());
    if (at->fixed || robot_of_object_[i] != kNoLink) {
      return "object \"" + stated.object + "\" is fixed or part of a robot: its pose is known";
    }
    if (!is_unit(stated.world_from_object.orientation) ||
        !stated.world_from_object.position.allFinite()) {
      return "the pose of object \"" + stated.object +
             "\" is not finite, or its quaternion has not length 1";
    }
    if (!(stated.age >= 0.0) || !std::isfinite(stated.age))
      return "the age of the pose of object \"" + stated.object + "\" is not a number from 0 on";
    pose_[i] = stated.world_from_object;
    age_[i] = stated.age;
    present_[i] = 1;
  }
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    const Object& object = scene_.objects[i];
    if (present_[i] == 0 && !object.absent) {
      return "object \"" + object.name +
             "\" has no pose: it is not fixed, so the question states it";
    }
    if (present_[i] != 0 && robot_of_object_[i] == kNoLink && !object.fixed &&
        question.others == OthersMove::kWithinMaxSpeed && !std::isfinite(object.max_speed)) {
      return "object \"" + object.name +
             "\" has no max_speed in the cell: state one, or that other objects do not move";
    }
  }
  return std::nullopt;
}

void Posture::place_resting() noexcept {
  for (std::size_t r = 0; r < bases_.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    if (base.kind != RobotBase::Kind::kObject) continue;
    bases_[r] = {};
    bases_[r].known = bases_[r].velocity_known = true;
    bases_[r].pose = pose_[base.object];
  }
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    placed_at_[i] = 0;
    const std::uint32_t object = parts_[i].object;
    const bool rests = robot_of_object_[object] == kNoLink || scene_.objects[object].fixed;
    if (!rests || present_[object] == 0) continue;
    place_at(pose_[object], parts_[i]);
    placed_at_[i] = ~std::uint64_t{0};
  }
  instant_ = 0;
}

void Posture::place(const Stretch& stretch, double at) noexcept {
  trajectory_.place(stretch, at, variables_, bounds_);
  kinematics_.place(variables_, bases_);
  chains_.place(kinematics_);
  ++instant_;
}

const LinkState& Posture::link_state(std::uint32_t object) const noexcept {
  return kinematics_.links(robot_of_object_[object])[link_of_object_[object]];
}

const PosedPart& Posture::part(std::uint32_t index) noexcept {
  PosedPart& part = parts_[index];
  if (placed_at_[index] < instant_) {
    place_at(link_state(part.object).pose, part);
    placed_at_[index] = instant_;
  }
  return part;
}

Twist Posture::twist(std::uint32_t object, Vec3& origin) const noexcept {
  origin = Vec3::Zero();
  if (robot_of_object_[object] == kNoLink || scene_.objects[object].fixed) return {};
  const LinkState& link = link_state(object);
  origin = link.pose.position;
  return link.twist;
}

}  // namespace clearance
