#include "monitor/ask/stopping_joints.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

constexpr double kMeasured = 1e-9;  // the largest relative error of an extension

// A statement that lasts longer than the stop is not believed of a joint that still moves.
bool is_braking(const TrackedVariable& state, const JointVariable& variable,
                const JointStop& stop) noexcept {
  return state.is_stopping && (state.slowest_braking <= still_speed(variable) ||
                               seconds(elapsed(state.braking_since_ns, state.input.stamp_ns)) <=
                                   stop.time(rounded_up(state.braking_from)));
}

}  // namespace

StoppingJoints::StoppingJoints(const Scene& scene, std::uint32_t robot, JointTrajectory& motion)
    : of_(scene.robots[robot]),
      stops_(of_.stopping),
      robot_(robot),
      period_(scene.longest_period()) {
  for (std::size_t i = 0; i < of_.joints.size(); ++i) {
    const RobotJoint& joint = of_.joints[i];
    if (variables_of(joint.type) != 1) continue;
    const JointVariable& variable = scene.variables[joint.variable];
    if (variable.name != joint.name) continue;  // it mimics another
    Joint added{.variable = joint.variable,
                .of = &variable,
                .index = i,
                .stop = &stops_.joints[i],
                .acceleration = stops_.max_accelerations[i],
                .full_speed = variable.max_speed};
    if (joint.type == JointType::kPrismatic) {
      added.lower = variable.lower;
      added.upper = variable.upper;
    }
    joints_.push_back(added);
    motion.joints.push_back(variable.name);
  }
  motion.times = {0.0, kDuration};
  motion.positions.resize(kRows * joints_.size());
  motion.deviations.resize(joints_.size());
}

const StoppingJoints::Joint* StoppingJoints::find(std::uint32_t variable) const noexcept {
  const auto found = std::ranges::find(joints_, variable, &Joint::variable);
  return found == joints_.end() ? nullptr : &*found;
}

// A robot that is late has to stop: its present velocity is not known.
void StoppingJoints::read(const Inputs& inputs) noexcept {
  is_usable_ = !inputs.robots.is_denied(robot_);
  is_assumed_ = may_turn_ = false;
  is_stopping_ = true;
  age_ = 0.0;
  for (Joint& joint : joints_) read(inputs, joint);
  for (Joint& joint : joints_) {
    joint.may_curve = joint.acceleration < kInfinity && !joint.any_direction;
    joint.gained = joint.may_curve ? rounded_up(joint.acceleration * reaction()) : 0.0;
    may_turn_ = may_turn_ || joint.may_curve || joint.any_direction;
  }
  if (is_usable_ && !stops_.steps.empty()) choose_step(inputs);
}

// The distance of the link from the axis, m.
double StoppingJoints::extension(const Inputs& inputs) const noexcept {
  const auto links = inputs.robots.links(robot_);
  const Extension& of = stops_.extension;
  const RobotJoint& joint = of_.joints[of.joint];
  const LinkState& parent = links[joint.parent];
  const LinkState& link = links[of.link];
  if (!link.known) return kInfinity;
  const Pose at = compose(parent.pose, joint.parent_from_joint);
  return (link.pose.position - at.position).cross(at.orientation * joint.axis).norm();
}

// The lowest step counts that the posture does not leave in a stop of this step. The highest one
// has all extensions.
void StoppingJoints::choose_step(const Inputs& inputs) noexcept {
  const double now = extension(inputs);
  for (const StopStep& step : stops_.steps) {
    for (Joint& joint : joints_) joint.stop = &step.joints[joint.index];
    double farthest = now;
    for (const Joint& joint : joints_)
      farthest += swept(covered(joint), stops_.extension.levers[joint.index]);
    if ((1.0 + kMeasured) * farthest <= step.extension * stops_.extension.reach) return;
  }
}

void StoppingJoints::read(const Inputs& inputs, Joint& joint) noexcept {
  const TrackedVariable& state = inputs.robots.variables()[joint.variable];
  joint.any_direction = !state.velocity_known;
  joint.position = state.position;
  joint.velocity = state.velocity_known ? state.velocity : 0.0;
  joint.speed = state.velocity_known ? std::abs(state.velocity) : joint.full_speed;
  if (state.velocities_contradict) {
    joint.any_direction |= joint.velocity == 0.0 && state.sent_speed > 0.0;
    joint.speed = std::max(joint.speed, state.sent_speed);
    joint.velocity = std::copysign(joint.speed, joint.velocity);
  }
  const bool is_known = state.input.has_value && !state.input.late;
  joint.age = is_known ? rounded_up(seconds(state.input.age_ns(inputs.time.now_ns))) : 0.0;
  age_ = std::max(age_, joint.age);
  is_assumed_ = is_assumed_ || joint.any_direction;
  is_stopping_ = is_stopping_ && is_braking(state, *joint.of, stops_.joints[joint.index]);
  is_usable_ = is_usable_ && is_known && joint.speed < kInfinity;
}

// The longest time from the oldest position in use until the brakes act, s. Those of a stop in
// progress act already.
double StoppingJoints::reaction() const noexcept {
  if (is_stopping_) return age_;
  return rounded_up(stops_.reaction + period_ + age_);
}

double StoppingJoints::longest_time(double scaling) const noexcept {
  double longest = 0.0;
  for (const Joint& joint : joints_)
    longest =
        std::max(longest, joint.stop->time(rounded_up(scaling * (joint.speed + joint.gained))));
  return longest;
}

double StoppingJoints::time() const noexcept {
  return rounded_up(reaction() - age_ + longest_time(1.0));
}

// The longest distance / speed of all joints, s: in proportion, all of them brake for as long.
double StoppingJoints::in_proportion(double scaling) const noexcept {
  double longest = 0.0;
  for (const Joint& joint : joints_) {
    const double speed = scaling * joint.speed;
    if (speed > 0.0) longest = std::max(longest, joint.stop->distance(rounded_up(speed)) / speed);
  }
  return rounded_up(longest);
}

// The same for all speeds that the joints may have by then.
double StoppingJoints::at_most_in_proportion(double scaling) const noexcept {
  double longest = in_proportion(scaling);
  if (!may_turn_) return longest;
  for (const Joint& joint : joints_)
    longest =
        std::max(longest, joint.stop->longest(rounded_up(scaling * (joint.speed + joint.gained))));
  return longest;
}

double StoppingJoints::covered(std::uint32_t variable) const noexcept {
  return covered(*find(variable));
}

double StoppingJoints::farthest() const noexcept {
  double farthest = 0.0;
  for (const Joint& joint : joints_) farthest = std::max(farthest, covered(joint));
  return farthest;
}

double StoppingJoints::covered(const Joint& joint) const noexcept {
  const double faster = rounded_up(joint.speed + joint.gained);
  double braking = joint.stop->distance(faster);
  if (stops_.keeps_path) {
    braking = faster * at_most_in_proportion(1.0);
    const double longest = longest_time(1.0);
    if (joint.may_curve) braking += 0.5 * joint.acceleration * longest * longest;
  }
  return rounded_up(faster * reaction() + braking);
}

double StoppingJoints::standstill(std::uint32_t variable) const noexcept {
  const Joint& joint = *find(variable);
  const double braking =
      stops_.keeps_path ? joint.speed * in_proportion(1.0) : joint.stop->distance(joint.speed);
  double at = joint.position + std::copysign(joint.speed * reaction() + braking, joint.velocity);
  joint.hold_within_limits(at);
  return at;
}

void StoppingJoints::state(StatedJoint& out, std::uint32_t variable) const noexcept {
  const Joint& joint = *find(variable);
  const double covered = this->covered(joint);
  const bool either = joint.any_direction || joint.may_curve;
  out.position = joint.position;
  if (!either) out.position += std::copysign(0.5 * covered, joint.velocity);
  const double beyond = joint.hold_within_limits(out.position);
  out.most = rounded_up((either ? covered : 0.5 * covered) + beyond);
  out.speed = kInfinity;
  out.age = std::max(out.age, kDuration);  // also if the other stop takes no time
}

// First the joints go on as they do. Then they brake: in proportion, if the path is kept, so that
// they stay on a line; else each by itself, so that they stay in a box that goes on with them.
void StoppingJoints::write_motion(double scaling, JointTrajectory& motion) const noexcept {
  const std::size_t joints = joints_.size();
  const double on_line = in_proportion(scaling), at_most = at_most_in_proportion(scaling);
  const double longest = longest_time(scaling);
  for (std::size_t j = 0; j < joints; ++j) {
    const Joint& joint = joints_[j];
    const double speed = rounded_up(scaling * joint.speed);
    const double faster = rounded_up(scaling * (joint.speed + joint.gained));
    const double before = joint.speed * reaction();  // until the brakes act
    const double side = joint.velocity < 0.0 ? -1.0 : 1.0;
    double deviation = joint.speed * (age_ - joint.age) + 0.5 * joint.gained * reaction();
    const auto at = [&](std::size_t row) -> double& { return motion.positions[row * joints + j]; };
    at(0) = joint.position;
    if (joint.any_direction) {
      deviation += before + (stops_.keeps_path ? faster * at_most : joint.stop->distance(faster));
      at(1) = joint.position;
    } else if (stops_.keeps_path) {
      at(1) = joint.position + side * (before + speed * on_line);
      deviation += scaling * joint.gained * at_most + speed * (at_most - on_line);
      if (joint.may_curve) deviation += 0.5 * joint.acceleration * longest * longest;
    } else {
      const double back = rounded_up(scaling * std::max(0.0, joint.gained - joint.speed));
      const double on = joint.stop->distance(faster), reverse = joint.stop->distance(back);
      at(0) += side * 0.5 * (on - reverse);
      at(1) = at(0) + side * before;
      deviation += 0.5 * (on + reverse);
    }
    double beyond = 0.0;
    for (std::size_t row = 0; row < kRows; ++row)
      beyond = std::max(beyond, joint.hold_within_limits(at(row)));
    deviation += beyond;
    motion.deviations[j] = deviation > 0.0 ? rounded_up(deviation) : 0.0;
  }
}

// What slides stops at its limits at the latest, and there it leaves the lines.
double StoppingJoints::Joint::hold_within_limits(double& at) const noexcept {
  const double within = std::clamp(at, std::min(lower, position), std::max(upper, position));
  return std::abs(std::exchange(at, within) - within);
}

// As a time at the present speed, s.
double StoppingJoints::length_of_line(double scaling) const noexcept {
  return reaction() + scaling * in_proportion(scaling);
}

double StoppingJoints::scaling_within(double share) const noexcept {
  const double clear = rounded_down(share * length_of_line(1.0));
  if (length_of_line(0.0) >= clear) return 0.0;
  double least = 0.0, most = 1.0;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (least + most);
    (length_of_line(middle) < clear ? least : most) = middle;
  }
  return least;
}

}  // namespace clearance
