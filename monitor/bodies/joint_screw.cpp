// Computes the columns of the Jacobian in the joint's frame, as ForwardKinematics places it, and
// rotates them into the world.
#include "monitor/bodies/joint_screw.hpp"

#include <limits>

#include "monitor/bodies/fixed_order.hpp"

namespace clearance {
namespace {

// The joint's axes in the world, before the joint moves.
struct WorldAxes {
  Vec3 x, y, axis;
};

// The screws of the entries of a quaternion as they were sent: omega = 2 dq q* / |q|^2. The real
// part of the product is a change of length.
void turn_freely(const RobotJoint& joint, const WorldAxes& axes,
                 std::span<const TrackedVariable> variables,
                 std::span<JointScrew> screws) noexcept {
  double sent[4];  // x, y, z, w
  for (std::uint32_t i = 0; i < 4; ++i) {
    sent[i] = joint.multiplier * variables[joint.variable + 3 + i].position + joint.offset;
  }
  const Eigen::Quaterniond conjugate(sent[3], -sent[0], -sent[1], -sent[2]);
  const double squared =
      (sent[3] * sent[3] + sent[0] * sent[0]) + (sent[1] * sent[1] + sent[2] * sent[2]);
  const double twice = 2.0 * joint.multiplier / squared;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Quaterniond grown(i == 3 ? 1.0 : 0.0, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0,
                                   i == 2 ? 1.0 : 0.0);
    const Eigen::Quaterniond rate = product(grown, conjugate);
    screws[3 + i].angular =
        (twice * rate.x()) * axes.x + (twice * rate.y()) * axes.y + (twice * rate.z()) * axes.axis;
  }
}

}  // namespace

void screws_of(const RobotJoint& joint, const LinkState& parent, const LinkState& child,
               std::span<const TrackedVariable> variables, std::span<JointScrew> screws) noexcept {
  if (!child.known) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    for (JointScrew& screw : screws) screw.linear = Vec3::Constant(kUnknown);
    return;
  }
  const Mat3 turn = rotation_matrix(
      product(parent.pose.orientation, joint.parent_from_joint.orientation.normalized()));
  const WorldAxes axes{times(turn, joint.plane_x), times(turn, joint.plane_y),
                       times(turn, joint.axis)};
  for (JointScrew& screw : screws) screw = {.origin = child.pose.position};
  switch (joint.type) {
    case JointType::kFixed:
      break;
    case JointType::kRevolute:
    case JointType::kContinuous:
      screws[0].angular = joint.multiplier * axes.axis;
      break;
    case JointType::kPrismatic:
      screws[0].linear = joint.multiplier * axes.axis;
      break;
    case JointType::kPlanar:
      screws[0].linear = joint.multiplier * axes.x;
      screws[1].linear = joint.multiplier * axes.y;
      screws[2].angular = joint.multiplier * axes.axis;
      break;
    case JointType::kFloating:
      screws[0].linear = joint.multiplier * axes.x;
      screws[1].linear = joint.multiplier * axes.y;
      screws[2].linear = joint.multiplier * axes.axis;
      turn_freely(joint, axes, variables, screws);
      break;
  }
}

}  // namespace clearance
