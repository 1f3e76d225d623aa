#include "monitor/ask/chains.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/chain_rounding.hpp"
#include "monitor/ask/vectors.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/fixed_order.hpp"

namespace clearance {
namespace {

constexpr double kChainRounding = 0x1p-44;  // of sums over a chain, relative

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
        node.largest_slide = largest_slide(*node.joint, scene.variables);
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
    if (is_carried(nodes_[n])) return true;
    if (nodes_[n].joint != nullptr && nodes_[n].joint->type != JointType::kFixed) return true;
  }
  return false;
}

std::uint32_t Chains::carrier_of(std::uint32_t object) const noexcept {
  std::uint32_t root = node_of_object_[object];
  while (root != kNoNode && nodes_[root].parent != kNoNode) root = nodes_[root].parent;
  if (root == kNoNode || !is_carried(nodes_[root])) return Chain::kNone;
  return scene_.robots[nodes_[root].robot].base.object;
}

// Every link between is a body with two places: those of the joints on both sides. The distances of
// these places, added up from the tip, bound the reach.
Chain Chains::between(std::uint32_t base, std::uint32_t tip) {
  std::vector<std::uint32_t> up, down;  // from base to the common ancestor, from tip to it
  for (std::uint32_t n = node_of_object_[base]; n != kNoNode; n = nodes_[n].parent) up.push_back(n);
  for (std::uint32_t n = node_of_object_[tip]; n != kNoNode; n = nodes_[n].parent)
    down.push_back(n);
  Chain chain{.begin = static_cast<std::uint32_t>(joints_.size())};
  while (!up.empty() && !down.empty() && up.back() == down.back()) {
    chain.common = up.back();
    up.pop_back();
    down.pop_back();
  }
  const std::uint32_t carrier = carrier_of(tip);
  chain.shares_carrier = chain.common == kNoNode && carrier != Chain::kNone &&
                         (carrier == base || (is_link(base) && carrier == carrier_of(base)));
  double reach = radii_[tip];
  Vec3 last = Vec3::Zero();  // the place nearer to the tip, in the present link
  const auto add_carrier = [&](std::uint32_t n, bool is_up) {
    const Node& node = nodes_[n];
    ChainJoint slide{.link = n, .variable = of_carrier(node.robot), .rotates = false};
    ChainJoint turn{
        .link = n, .variable = of_carrier(node.robot) + 1, .rotates = true, .about_any_axis = true};
    if (is_up) {
      joints_.push_back(slide);
      reach += node.largest_slide;
    }
    turn.largest_reach = (1.0 + kChainRounding) * (reach + length(node.place_in_parent));
    joints_.push_back(turn);
    if (is_up) return;
    joints_.push_back(slide);
    reach += node.largest_slide;
  };
  const auto add = [&](std::uint32_t n, const Vec3& here, const Vec3& beyond, bool is_up) {
    const Node& node = nodes_[n];
    reach = (1.0 + kChainRounding) * (reach + length(here - last));
    last = beyond;
    if (is_carried(node) && !chain.shares_carrier) add_carrier(n, is_up);
    if (node.joint == nullptr || node.joint->type == JointType::kFixed) return;
    joints_.push_back({.link = n,
                       .variable = node.joint->variable,
                       .factor = std::abs(node.joint->multiplier),
                       .rotates = node.joint->type != JointType::kPrismatic,
                       .largest_reach = reach + node.largest_slide});
    reach += node.largest_slide;
  };
  // The chain is found from the tip inwards, and reversed at the end.
  for (const std::uint32_t n : down) add(n, Vec3::Zero(), nodes_[n].place_in_parent, false);
  std::reverse(up.begin(), up.end());
  for (const std::uint32_t n : up) add(n, nodes_[n].place_in_parent, Vec3::Zero(), true);
  std::reverse(joints_.begin() + chain.begin, joints_.end());
  chain.end = static_cast<std::uint32_t>(joints_.size());
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

void Chains::place(const ForwardKinematics& kinematics, std::span<const LinkState> bases) noexcept {
  for (const std::uint32_t n : moving_) {
    if (nodes_[n].joint == nullptr) {
      axes_[n].origin = bases[nodes_[n].robot].pose.position;
      continue;
    }
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
    const Vec3 to_centre = sphere.centre - axis.origin;
    const Vec3 arm = joint.about_any_axis ? to_centre : cross(to_centre, axis.direction);
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

// Joints are taken from the tip inwards: a joint moves all that the joints behind it have moved.
Nearing Chains::nearing(const Chain& chain, std::uint32_t object, const Sphere& sphere,
                        std::span<const VariableBounds> bounds,
                        std::span<const Nearing> free) const noexcept {
  Nearing sum;
  double stated = 0.0;  // m: by the stated motion of the joints behind, within the stretch
  const auto slide = [&](std::uint32_t variable, double factor) {
    const Nearing& by = free[variable];
    sum.until_end += factor * by.until_end;
    sum.until_middle += factor * by.until_middle;
    sum.until_begin += factor * by.until_begin;
    stated += factor * bounds[variable].deviation;
  };
  const auto turn = [&](const Nearing& by, double deviation, double arm) {
    const double reach = arm + sphere.radius;
    sum.until_end += swept(std::min(by.until_end, 2.0), reach + stated + sum.until_end);
    sum.until_middle += swept(std::min(by.until_middle, 2.0), reach + sum.until_middle);
    sum.until_begin +=
        swept(std::min(by.until_begin, 2.0), std::max(0.0, reach - stated) + sum.until_begin);
    stated += swept(std::min(deviation, 2.0), reach + stated);
  };
  for (std::uint32_t n = node_of_object_[object]; n != chain.common; n = nodes_[n].parent) {
    const Node& node = nodes_[n];
    const Vec3 to_centre = sphere.centre - axes_[n].origin;
    if (node.joint == nullptr) {
      if (!is_carried(node) || chain.shares_carrier) continue;
      const std::uint32_t v = of_carrier(node.robot);
      turn(free[v + 1], bounds[v + 1].deviation, length(to_centre));
      slide(v, 1.0);
      continue;
    }
    const std::uint32_t v = node.joint->variable;
    const double factor = std::abs(node.joint->multiplier);
    const double arm = length(cross(to_centre, axes_[n].direction));
    switch (node.joint->type) {
      case JointType::kFixed:
        break;
      case JointType::kRevolute:
      case JointType::kContinuous:
        turn({factor * free[v].until_end, factor * free[v].until_middle,
              factor * free[v].until_begin},
             factor * bounds[v].deviation, arm);
        break;
      case JointType::kPrismatic:
        slide(v, factor);
        break;
      case JointType::kPlanar:
        turn(free[v + 2], 0.0, arm);
        slide(v, 1.0);
        slide(v + 1, 1.0);
        break;
      case JointType::kFloating: {
        // The rotation is at most twice the change of the unit quaternion, whose entries are sent
        // within 1e-3 of unit length.
        Nearing by;
        for (std::uint32_t i = 3; i < 7; ++i) {
          by.until_end += 2.01 * free[v + i].until_end;
          by.until_middle += 2.01 * free[v + i].until_middle;
          by.until_begin += 2.01 * free[v + i].until_begin;
        }
        turn(by, 0.0, length(to_centre));
        for (std::uint32_t i = 0; i < 3; ++i) slide(v + i, 1.0);
        break;
      }
    }
  }
  return {(1.0 + kChainRounding) * sum.until_end, (1.0 - kChainRounding) * sum.until_middle,
          (1.0 - kChainRounding) * sum.until_begin};
}

}  // namespace clearance
