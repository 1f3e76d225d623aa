#include "monitor/ask/chains.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/chain_rounding.hpp"
#include "monitor/ask/vectors.hpp"
#include "monitor/kinematics/fixed_order.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

constexpr double kChainRounding = 0x1p-44;  // of sums over a chain, relative

double largest_slide(const RobotJoint& joint, const Scene& scene) noexcept {
  switch (joint.type) {
    case JointType::kPrismatic: {
      const JointVariable& variable = scene.variables[joint.variable];
      const double limit = std::max(std::abs(variable.lower), std::abs(variable.upper));
      const double size = std::isfinite(limit) ? limit + variable.limit_tolerance : kLargestLength;
      return std::abs(joint.multiplier) * size + std::abs(joint.offset);
    }
    case JointType::kPlanar:
    case JointType::kFloating:
      return 3.0 * kLargestLength;
    default:
      return 0.0;
  }
}

}  // namespace

Chains::Chains(const Scene& scene, std::span<const double> radii)
    : scene_(scene),
      radii_(radii.begin(), radii.end()),
      node_of_object_(scene.objects.size(), kNoNode) {
  std::vector<std::uint32_t> first;
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    const Robot& robot = scene.robots[r];
    first.push_back(static_cast<std::uint32_t>(nodes_.size()));
    for (std::uint32_t i = 0; i < robot.links.size(); ++i) {
      Node node{.robot = r, .link = i};
      if (i > 0) {
        node.joint = &robot.joints[i - 1];
        node.parent = first[r] + node.joint->parent;
        node.place_in_parent = node.joint->parent_from_joint.position;
        node.largest_slide = largest_slide(*node.joint, scene);
      } else {
        if (robot.base.kind == RobotBase::Kind::kLink) {
          node.parent = first[robot.base.robot] + robot.base.link;
        }
        node.place_in_parent = robot.base.base_from_root.position;
        // A question states the place of that object.
        if (robot.base.kind == RobotBase::Kind::kObject) node.largest_slide = kLargestLength;
      }
      const std::uint32_t object = robot.links[i].object;
      if (object != RobotLink::kNoObject) {
        node_of_object_[object] = static_cast<std::uint32_t>(nodes_.size());
      }
      nodes_.push_back(node);
    }
  }
  axes_.resize(nodes_.size());
}

bool Chains::can_move(std::uint32_t object) const noexcept {
  for (std::uint32_t n = node_of_object_[object]; n != kNoNode; n = nodes_[n].parent) {
    if (nodes_[n].joint != nullptr && nodes_[n].joint->type != JointType::kFixed) return true;
  }
  return false;
}

// Every link between is a body with two places: those of the joints on both sides. The distances of
// these places, added up from the tip, bound the reach.
Chain Chains::between(std::uint32_t base, std::uint32_t tip) {
  std::vector<std::uint32_t> up, down;  // from base to the common ancestor, from tip to it
  for (std::uint32_t n = node_of_object_[base]; n != kNoNode; n = nodes_[n].parent) up.push_back(n);
  for (std::uint32_t n = node_of_object_[tip]; n != kNoNode; n = nodes_[n].parent)
    down.push_back(n);
  while (!up.empty() && !down.empty() && up.back() == down.back()) {
    up.pop_back();
    down.pop_back();
  }
  Chain chain{.begin = static_cast<std::uint32_t>(joints_.size())};
  double reach = radii_[tip];
  Vec3 last = Vec3::Zero();  // the place nearer to the tip, in the present link
  const auto add = [&](std::uint32_t n, const Vec3& here, const Vec3& beyond) {
    const Node& node = nodes_[n];
    reach = (1.0 + kChainRounding) * (reach + length(here - last));
    last = beyond;
    if (node.joint == nullptr) reach += node.largest_slide;
    if (node.joint == nullptr || node.joint->type == JointType::kFixed) return;
    joints_.push_back({.link = n,
                       .variable = node.joint->variable,
                       .factor = std::abs(node.joint->multiplier),
                       .rotates = node.joint->type != JointType::kPrismatic,
                       .largest_reach = reach + node.largest_slide});
    reach += node.largest_slide;
  };
  // The chain is found from the tip inwards, and reversed at the end.
  for (const std::uint32_t n : down) add(n, Vec3::Zero(), nodes_[n].place_in_parent);
  std::reverse(up.begin(), up.end());
  for (const std::uint32_t n : up) add(n, nodes_[n].place_in_parent, Vec3::Zero());
  std::reverse(joints_.begin() + chain.begin, joints_.end());
  chain.end = static_cast<std::uint32_t>(joints_.size());
  chain.base_rests = node_of_object_[base] == kNoNode || !can_move(base);
  return chain;
}

void Chains::finish() {
  reaches_.resize(joints_.size());
  std::vector<std::uint8_t> used(nodes_.size());
  for (const ChainJoint& joint : joints_) used[joint.link] = 1;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (used[n] != 0) moving_.push_back(n);
  }
}

void Chains::place(const ForwardKinematics& kinematics) noexcept {
  for (const std::uint32_t n : moving_) {
    const Pose& pose = kinematics.links(nodes_[n].robot)[nodes_[n].link].pose;
    axes_[n] = {pose.position, times(rotation_matrix(pose.orientation), nodes_[n].joint->axis)};
  }
}

double Chains::displacement(const Chain& chain, const Sphere& sphere,
                            std::span<const VariableBounds> bounds) noexcept {
  double sum = 0.0;
  for (std::uint32_t i = chain.end; i-- > chain.begin;) {
    const ChainJoint& joint = joints_[i];
    const double deviation = joint.factor * bounds[joint.variable].deviation;
    if (deviation == 0.0) {
      reaches_[i] = 0.0;
      continue;
    }
    if (!joint.rotates) {
      reaches_[i] = 1.0;
      sum += deviation;
      continue;
    }
    const PlacedAxis& axis = axes_[joint.link];
    const Vec3 arm = cross(sphere.centre - axis.origin, axis.direction);
    reaches_[i] =
        (1.0 + kChainRounding) * std::min(joint.largest_reach, length(arm) + sphere.radius + sum);
    sum += std::min(deviation, 2.0) * reaches_[i];
  }
  return (1.0 + kChainRounding) * sum;
}

double Chains::sum_of_reaches(const Chain& chain) const noexcept {
  double sum = 0.0;
  for (std::uint32_t i = chain.begin; i < chain.end; ++i) {
    sum += joints_[i].factor * (joints_[i].rotates ? joints_[i].largest_reach : 1.0);
  }
  return (1.0 + kChainRounding) * sum;
}

double Chains::acceleration(const Chain& chain,
                            std::span<const VariableBounds> bounds) const noexcept {
  double sum = 0.0, turning = 0.0;  // `turning`: rad/s of the joints nearer to the base
  for (std::uint32_t i = chain.begin; i < chain.end; ++i) {
    const ChainJoint& joint = joints_[i];
    const double speed = joint.factor * bounds[joint.variable].speed;
    const double own = joint.rotates ? speed : 0.0;
    sum += reaches_[i] *
           (speed * (own + 2.0 * turning) + joint.factor * bounds[joint.variable].acceleration);
    turning += own;
  }
  return (1.0 + kChainRounding) * sum;
}

}  // namespace clearance
