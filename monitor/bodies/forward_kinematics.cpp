// Works from the root outwards: each joint gives the pose and velocity of its link in the frame of
// the parent link.
#include "monitor/bodies/forward_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/scene/chain_rounding.hpp"
#include "core/convex_body.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/fixed_order.hpp"
#include "monitor/bodies/sine_cosine.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kNoStamp = std::numeric_limits<std::int64_t>::max();

// A rotation moves a point at most by the diameter of its circle.
constexpr double kAcross = 2.0;

Eigen::Quaterniond sum(double a, const Eigen::Quaterniond& p, double b,
                       const Eigen::Quaterniond& q) noexcept {
  return {a * p.w() + b * q.w(), a * p.x() + b * q.x(), a * p.y() + b * q.y(),
          a * p.z() + b * q.z()};
}

double length(const Vec3& v) noexcept { return std::sqrt(dot(v, v)); }

}  // namespace

double LinkState::may_have_moved(double radius) const noexcept {
  return rounded_up(unobserved_shift + swept(unobserved_turn, radius));
}

double LinkState::error(double radius) const noexcept {
  return rounded_up(shift_error + turn_error * radius);
}

// The pose and velocity of a joint's child link in the frame of its parent link.
struct ForwardKinematics::Placement {
  bool known = true, velocity_known = true, late = false, contradicted = false;
  std::int64_t stamp_ns = kNoStamp;
  Eigen::Quaterniond turn;
  Vec3 step = Vec3::Zero();                              // m
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();    // m/s, rad/s
  double unobserved_shift = 0.0, unobserved_turn = 0.0;  // as in LinkState
  double largest_angle = 0.0, largest_slide = 0.0;       // for rounding errors, rad, m
};

// One position of a joint after mimicry: value, velocity, unobserved motion, and the largest
// magnitude that rounding errors depend on.
struct ForwardKinematics::Position {
  double value = 0.0, speed = 0.0, unobserved = 0.0, largest = 0.0;
  bool is_rescaled = false;  // value has rounding errors
};

ForwardKinematics::Position ForwardKinematics::read(const RobotJoint& joint, std::uint32_t which,
                                                    std::span<const TrackedVariable> variables,
                                                    Placement& placed) noexcept {
  const TrackedVariable& state = variables[joint.variable + which];
  placed.known = placed.known && state.input.has_value;
  placed.velocity_known = placed.velocity_known && state.velocity_known && !state.input.late;
  placed.late = placed.late || state.input.late;
  placed.contradicted = placed.contradicted || state.input.contradicted;
  placed.stamp_ns = std::min(placed.stamp_ns, state.input.stamp_ns);
  const double scaled = joint.multiplier * state.position;
  const double factor = std::abs(joint.multiplier);
  return {.value = scaled + joint.offset,
          .speed = joint.multiplier * state.velocity,
          .unobserved = factor == 0.0 ? 0.0 : rounded_up(factor * state.may_have_moved),
          .largest = std::abs(scaled) + std::abs(joint.offset),
          .is_rescaled = joint.rescales()};
}

void ForwardKinematics::turn(const Position& angle, const JointFrame& frame,
                             Placement& placed) noexcept {
  const SineCosine half = sine_cosine(0.5 * angle.value);
  placed.turn = sum(half.cosine, frame.turn, half.sine, frame.turn_axis);
  // Mimicry can multiply the angle.
  placed.known = placed.known && angle.largest <= kLargestJoint;
  placed.angular = angle.speed * frame.axis;
  placed.unobserved_turn = std::min(angle.unobserved, kAcross);
  placed.largest_angle = angle.is_rescaled ? angle.largest : 0.0;
}

void ForwardKinematics::slide(const Position& path, const Vec3& along, Placement& placed) noexcept {
  placed.step += path.value * along;
  placed.linear += path.speed * along;
  placed.unobserved_shift = rounded_up(placed.unobserved_shift + path.unobserved);
  placed.largest_slide += path.largest;
}

// A quaternion that is not of unit length leaves the joint unknown, like an entry that was never
// sent.
void ForwardKinematics::turn_freely(const RobotJoint& joint, const JointFrame& frame,
                                    std::span<const TrackedVariable> variables,
                                    Placement& placed) noexcept {
  const Position x = read(joint, 3, variables, placed), y = read(joint, 4, variables, placed),
                 z = read(joint, 5, variables, placed), w = read(joint, 6, variables, placed);
  const Eigen::Quaterniond sent(w.value, x.value, y.value, z.value);
  const double squared =
      (sent.w() * sent.w() + sent.x() * sent.x()) + (sent.y() * sent.y() + sent.z() * sent.z());
  if (!(std::abs(squared - 1.0) <= 2.0 * kSampleUnitTolerance)) {
    placed.known = false;
    return;
  }
  const double norm = std::sqrt(squared);
  placed.turn =
      product(frame.turn, {sent.w() / norm, sent.x() / norm, sent.y() / norm, sent.z() / norm});
  // omega = 2 dq/dt q*. The real part of the product is a change of length.
  const Eigen::Quaterniond rate =
      product({w.speed, x.speed, y.speed, z.speed}, {sent.w(), -sent.x(), -sent.y(), -sent.z()});
  const double twice = 2.0 / squared;
  placed.angular = (twice * rate.x()) * frame.plane_x + (twice * rate.y()) * frame.plane_y +
                   (twice * rate.z()) * frame.axis;
  // The sent quaternion is of unit length to 1e-3. Normalisation at most doubles a change of the
  // entries, and |R2 - R1| is at most twice the change of the unit quaternion.
  const double unobserved = 4.01 * (x.unobserved + y.unobserved + z.unobserved + w.unobserved);
  placed.unobserved_turn = std::min(unobserved, kAcross);
}

ForwardKinematics::Placement ForwardKinematics::placement(
    const RobotJoint& joint, const JointFrame& frame,
    std::span<const TrackedVariable> variables) noexcept {
  Placement placed;
  placed.turn = frame.turn;
  placed.step = frame.step;
  switch (joint.type) {
    case JointType::kFixed:
      break;
    case JointType::kRevolute:
    case JointType::kContinuous:
      turn(read(joint, 0, variables, placed), frame, placed);
      break;
    case JointType::kPrismatic:
      slide(read(joint, 0, variables, placed), frame.axis, placed);
      break;
    case JointType::kPlanar:
      slide(read(joint, 0, variables, placed), frame.plane_x, placed);
      slide(read(joint, 1, variables, placed), frame.plane_y, placed);
      turn(read(joint, 2, variables, placed), frame, placed);
      break;
    case JointType::kFloating:
      slide(read(joint, 0, variables, placed), frame.plane_x, placed);
      slide(read(joint, 1, variables, placed), frame.plane_y, placed);
      slide(read(joint, 2, variables, placed), frame.axis, placed);
      turn_freely(joint, frame, variables, placed);
      break;
  }
  return placed;
}

ForwardKinematics::ForwardKinematics(std::span<const Robot> robots) : robots_(robots) {
  for (const Robot& robot : robots) {
    first_link_.push_back(static_cast<std::uint32_t>(links_.size()));
    links_.resize(links_.size() + robot.links.size());
    frames_.resize(links_.size());
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const RobotJoint& joint = robot.joints[i];
      const Eigen::Quaterniond turn = joint.parent_from_joint.orientation.normalized();
      const Mat3 rotation = rotation_matrix(turn);
      frames_[first_link_.back() + i + 1] = {
          .turn = turn,
          .turn_axis = product(turn, {0.0, joint.axis.x(), joint.axis.y(), joint.axis.z()}),
          .step = joint.parent_from_joint.position,
          .axis = times(rotation, joint.axis),
          .plane_x = times(rotation, joint.plane_x),
          .plane_y = times(rotation, joint.plane_y)};
    }
  }
}

// A link is known if its parent and its joint are. All motion of its parent is added to that of the
// joint.
void ForwardKinematics::carry(const LinkState& parent, const Placement& placed,
                              LinkState& link) noexcept {
  const Mat3 rotation = rotation_matrix(parent.pose.orientation);
  const Vec3 step = times(rotation, placed.step);
  const double far = length(step);
  link.known = parent.known && placed.known;
  link.velocity_known = parent.velocity_known && placed.velocity_known;
  link.late = parent.late || placed.late;
  link.contradicted = parent.contradicted || placed.contradicted;
  link.stamp_ns = std::min(parent.stamp_ns, placed.stamp_ns);
  link.pose.orientation = product(parent.pose.orientation, placed.turn);
  link.pose.position = parent.pose.position + step;

  link.twist = {};
  if (link.velocity_known) {
    link.twist.angular = parent.twist.angular + times(rotation, placed.angular);
    link.twist.linear =
        (parent.twist.linear + cross(parent.twist.angular, step)) + times(rotation, placed.linear);
  }

  // The joints before this one rotate the link at its displaced distance, `far` plus
  // unobserved_shift.
  link.unobserved_turn = rounded_up(parent.unobserved_turn + placed.unobserved_turn);
  link.unobserved_shift = rounded_up(parent.unobserved_shift + placed.unobserved_shift +
                                     swept(parent.unobserved_turn, far + placed.unobserved_shift));

  link.turn_error =
      rounded_up(parent.turn_error + kJointError + kPositionError * placed.largest_angle);
  link.shift_error = rounded_up(parent.shift_error + (parent.turn_error + kJointError) * far +
                                kPositionError * placed.largest_slide +
                                kPlacingError * (length(parent.pose.position) + far));
}

void ForwardKinematics::place_root(std::uint32_t robot, std::span<const LinkState> bases) noexcept {
  const RobotBase& base = robots_[robot].base;
  LinkState parent;
  parent.known = parent.velocity_known = true;
  parent.stamp_ns = kNoStamp;
  if (base.kind == RobotBase::Kind::kLink) parent = links_[first_link_[base.robot] + base.link];
  if (base.kind == RobotBase::Kind::kObject) {
    parent = bases[robot];
    if (parent.late) parent.unobserved_shift = kInfinity;
  }
  Placement placed;
  placed.turn = base.base_from_root.orientation;
  placed.step = base.base_from_root.position;
  carry(parent, placed, links_[first_link_[robot]]);
}

void ForwardKinematics::place(std::span<const TrackedVariable> variables,
                              std::span<const LinkState> bases,
                              std::span<const std::uint8_t> which) noexcept {
  for (std::uint32_t r = 0; r < robots_.size(); ++r) {
    if (!which.empty() && which[r] == 0) continue;
    place_root(r, bases);
    LinkState* links = &links_[first_link_[r]];
    const JointFrame* frames = &frames_[first_link_[r]];
    const std::vector<RobotJoint>& joints = robots_[r].joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const LinkState& parent = links[joints[i].parent];
      LinkState& link = links[i + 1];
      if (parent.known) {
        carry(parent, placement(joints[i], frames[i + 1], variables), link);
      } else {
        link = parent;
      }
    }
  }
}

}  // namespace clearance
