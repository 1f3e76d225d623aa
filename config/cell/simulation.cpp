// Positions and velocities along a chain follow from the forward kinematics of its joints, link by
// link from the base. All is in closed form in the time, without a state.
#include "config/cell/simulation.hpp"

#include <cmath>
#include <numbers>

namespace clearance {
namespace {

// A value and its derivative.
struct Motion {
  double value;  // rad or m
  double speed;  // its derivative, per second
};

// centre + amplitude * sin(2 pi f t + phase), and its derivative.
Motion swing_at(const Swing& swing, double t_s) {
  const double rate = 2.0 * std::numbers::pi * swing.frequency_hz;
  const double angle = rate * t_s + swing.phase;
  return {swing.centre + swing.amplitude * std::sin(angle),
          swing.amplitude * rate * std::cos(angle)};
}

// A moving frame of a chain.
struct MovingFrame {
  Pose pose;
  Twist twist;
};

// Returns the frame of the link that `joint` carries; `parent` is the frame of the link before.
MovingFrame link_frame(const MovingFrame& parent, const SimulatedJoint& joint, double t_s) {
  const Pose joint_pose = compose(parent.pose, joint.parent_from_joint);
  const Vec3 axis = joint_pose.orientation * joint.axis;
  const Motion motion = swing_at(joint.motion, t_s);

  MovingFrame link{joint_pose, parent.twist};
  if (joint.kind == JointKind::kRevolute) {
    link.pose.orientation =
        (joint_pose.orientation * Eigen::AngleAxisd(motion.value, joint.axis)).normalized();
    link.twist.angular += motion.speed * axis;
  } else {
    link.pose.position += motion.value * axis;
    link.twist.linear += motion.speed * axis;
  }
  link.twist.linear += parent.twist.angular.cross(link.pose.position - parent.pose.position);
  return link;
}

// The twist is the derivative of the pose in closed form, not a difference of two poses.
PoseAt mover_at(const SimulatedMover& mover, double t_s) {
  const Motion motion = swing_at({0.0, 1.0, mover.frequency_hz, mover.phase}, t_s);
  PoseAt at{mover.object, mover.centre, {motion.speed * mover.amplitude, mover.spin}};
  at.world_from_object.position += motion.value * mover.amplitude;
  if (const double rate = mover.spin.norm(); rate > 0.0) {
    const Eigen::AngleAxisd turn(rate * t_s, mover.spin / rate);
    at.world_from_object.orientation = turn * mover.centre.orientation;
  }
  at.world_from_object.orientation.normalize();
  return at;
}

}  // namespace

// Chains are evaluated from the base outwards, so each link needs only the frame of the link
// before.
void poses_at(const Simulation& simulation, double t_s, std::vector<PoseAt>& poses) {
  poses.clear();
  for (const SimulatedChain& chain : simulation.chains) {
    MovingFrame frame{chain.world_from_base, {}};
    for (const SimulatedJoint& joint : chain.joints) {
      frame = link_frame(frame, joint, t_s);
      for (const std::uint32_t object : joint.objects) {
        poses.push_back({object, frame.pose, frame.twist});
      }
    }
  }
  for (const SimulatedMover& mover : simulation.movers) poses.push_back(mover_at(mover, t_s));
}

Pose frame_at(const SimulatedFrame& frame, double t_s) {
  return mover_at(frame.motion, t_s).world_from_object;
}

}  // namespace clearance
