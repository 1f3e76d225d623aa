#include "monitor/ask/stops.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/pairs/kept_near.hpp"

namespace clearance {
namespace {

// The motion of a question lasts this long, s, whatever the stop takes: others are counted as if
// all of its time had passed at each of its places.
constexpr double kDuration = 1e-6;
// Waypoints while joints brake by themselves.
constexpr std::size_t kBraking = 4;
constexpr double kTolerance = 4e-3;  // m
constexpr double kRounding = 1e-9;   // m: of the places of joints on their way
// Pairs that stay certainly farther than their margin by this are not examined more closely, m.
constexpr double kFarBeyondMargin = 0.1;
constexpr double kShare = 1e-3;           // of the way to the stop: where it is not clear any more
constexpr std::uint32_t kMostWork = 400;  // queries and placements of a robot in a tick
constexpr std::uint32_t kHalvings = 4;    // of a share of the speed

// What has been decided so far, where joints brake by themselves: at a time since the brakes act, a
// joint that stops in `time` after `distance` has gone at least `least` and at most `most` of it.
struct Braking {
  double distance = 0.0, time = 0.0, speed = 0.0;

  [[nodiscard]] double least(double t) const noexcept {
    return time > 0.0 ? distance * std::min(1.0, t / time) : distance;
  }
  [[nodiscard]] double most(double t) const noexcept { return std::min(distance, speed * t); }
  [[nodiscard]] double middle(double t) const noexcept { return 0.5 * (least(t) + most(t)); }
};

// The joint's speed does not grow while it brakes, so its way is concave in time.
Braking braking_of(const JointStop& stop, double speed) noexcept {
  const double distance = stop.distance(speed), time = stop.time(speed);
  return {distance, time, time > 0.0 ? std::max(speed, distance / time) : kInfinity};
}

// No farther is the joint from the straight lines between its middles at these times.
double deviation_of(const Braking& braking, double step) noexcept {
  double most = 0.0;
  for (std::size_t k = 0; k < kBraking; ++k) {
    const double from = static_cast<double>(k) * step, to = from + step;
    const double at_from = braking.middle(from), at_to = braking.middle(to);
    // Both bounds are straight between these times.
    for (const double t : {from, to, braking.time, braking.distance / braking.speed}) {
      if (!(t >= from && t <= to)) continue;
      const double line = step > 0.0 ? at_from + (at_to - at_from) * ((t - from) / step) : at_to;
      most = std::max({most, braking.most(t) - line, line - braking.least(t)});
    }
  }
  return rounded_up(most);
}

}  // namespace

Stops::Stops(const Scene& scene)
    : scene_(scene), period_(1.0 / scene.rate_hz), stopping_of_robot_(scene.robots.size(), kNone) {
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    if (!scene.robots[r].stopping.is_stated()) continue;
    stopping_of_robot_[r] = static_cast<std::uint32_t>(robots_.size());
    robots_.emplace_back();
    robots_.back().robot = r;
    robots_.back().stops = &scene.robots[r].stopping;
  }
  if (robots_.empty()) return;
  search_ = std::make_unique<MotionSearch>(scene);
  robot_of_object_.assign(scene.objects.size(), kNone);
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    for (const RobotLink& link : scene.robots[r].links)
      if (link.object != RobotLink::kNoObject) robot_of_object_[link.object] = r;
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].fixed && robot_of_object_[i] == kNone) tracked_.push_back(i);
  }
  kept_near_ = kept_nearer(scene, 0.0);
  for (StoppingRobot& robot : robots_) {
    add_joints(robot);
    add_pairs(robot);
    add_others(robot);
  }
}
Stops::~Stops() = default;

void Stops::add_joints(StoppingRobot& robot) const {
  const Robot& of = scene_.robots[robot.robot];
  JointTrajectory& motion = robot.question.motion;
  for (std::size_t i = 0; i < of.joints.size(); ++i) {
    const RobotJoint& joint = of.joints[i];
    if (variables_of(joint.type) != 1) continue;
    const JointVariable& variable = scene_.variables[joint.variable];
    if (variable.name != joint.name) continue;  // it mimics another
    Joint added{.variable = joint.variable,
                .stop = &robot.stops->joints[i],
                .full_speed = variable.max_speed};
    if (!robot.stops->max_accelerations.empty())
      added.acceleration = robot.stops->max_accelerations[i];
    if (joint.type == JointType::kPrismatic) {
      added.lower = variable.lower;
      added.upper = variable.upper;
    }
    robot.joints.push_back(added);
    motion.joints.push_back(variable.name);
  }
  const std::size_t rows = robot.stops->keeps_path ? 2 : 2 + kBraking;
  motion.times.resize(rows);
  motion.positions.resize(rows * robot.joints.size());
  motion.deviations.resize(robot.joints.size());
  robot.question.tolerance = kTolerance;
  robot.question.instant = kShare;
  robot.question.contacts.emplace();  // a contact in force has no margin here
}

// The robot's own links, and those of what stands on it.
void Stops::add_pairs(StoppingRobot& robot) const {
  std::vector<bool> is_moved(scene_.objects.size(), false);
  const auto root = [&](std::uint32_t r) {
    while (r != robot.robot && scene_.robots[r].base.kind == RobotBase::Kind::kLink)
      r = scene_.robots[r].base.robot;
    return r;
  };
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (root(r) != robot.robot) continue;
    for (const RobotLink& link : scene_.robots[r].links) {
      if (link.object != RobotLink::kNoObject && !scene_.objects[link.object].fixed)
        is_moved[link.object] = true;
    }
  }
  std::vector<double> stated(scene_.pairs.size(), -kInfinity);
  for (const Zone& zone : scene_.zones) {
    if (!zone.stop_margin) continue;
    for (const std::uint32_t pair : zone.pairs) {
      const ObjectPair& of = scene_.pairs[pair];
      const double both = scene_.objects[of.first].margin + scene_.objects[of.second].margin;
      stated[pair] = std::max(stated[pair], rounded_up(*zone.stop_margin + both));
    }
  }
  robot.margins.assign(scene_.pairs.size(), -kInfinity);
  std::uint32_t published = 0;
  double largest = 0.0;
  for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
    const ObjectPair& pair = scene_.pairs[p];
    const std::uint32_t place = pair.publish ? published++ : kNone;
    if (!is_moved[pair.first] && !is_moved[pair.second]) continue;
    const bool is_near = std::ranges::binary_search(kept_near_, p);
    robot.pairs.push_back({.pair = p,
                           .other = is_moved[pair.first] ? pair.second : pair.first,
                           .published = place,
                           .margin = stated[p] > -kInfinity ? stated[p]
                                     : is_near              ? -kInfinity
                                                            : 0.0});
    largest = std::max(largest, robot.pairs.back().margin);
    for (const std::uint32_t object : {pair.first, pair.second})
      if (robot_of_object_[object] != kNone) robot.beside.push_back(robot_of_object_[object]);
  }
  std::ranges::sort(robot.beside);
  robot.beside.erase(std::ranges::unique(robot.beside).begin(), robot.beside.end());
  robot.question.far_enough = largest + kFarBeyondMargin;
  robot.question.margins_by_pair = robot.margins;
}

// Room for what write() states in each tick, in an order that stays.
void Stops::add_others(StoppingRobot& robot) const {
  const auto is_own = [&](std::uint32_t variable) {
    return std::ranges::find(robot.joints, variable, &Joint::variable) != robot.joints.end();
  };
  for (std::uint32_t v = 0; v < scene_.variables.size(); ++v)
    if (!is_own(v)) robot.question.joints.push_back({.name = scene_.variables[v].name});
  for (const std::uint32_t i : tracked_) {
    const Object& object = scene_.objects[i];
    if (object.is_seen()) {
      robot.question.seen.emplace_back().sensor = object.name;
    } else {
      robot.question.poses.emplace_back().object = object.name;
    }
  }
}

void Stops::prepare(Report& report) const {
  for (const StoppingRobot& robot : robots_) {
    report.stops.push_back({.robot = robot.robot,
                            .clearance = -kInfinity,
                            .pair = robot.pairs.empty() ? 0 : robot.pairs.front().pair,
                            .time = kNan});
  }
}

void Stops::write(const Inputs& inputs, const CloudPairs* clouds, const Contacts& contacts,
                  Report& report) noexcept {
  for (StoppingRobot& robot : robots_) {
    read(inputs, robot);
    for (const WatchedPair& pair : robot.pairs) {
      if (pair.published == kNone) continue;
      PairReport& out = report.pairs[pair.published];
      out.stop_lower = out.status == PairStatus::kAbsent ? kNan : -kInfinity;
    }
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    StoppingRobot& robot = robots_[i];
    RobotStop& out = report.stops[i];
    out = {.robot = robot.robot,
           .clearance = -kInfinity,
           .pair = robot.pairs.empty() ? 0 : robot.pairs.front().pair,
           .time = robot.is_usable ? time_of(robot) : kNan};
    if (!robot.is_usable || !knows_pairs(inputs, contacts, robot)) continue;
    state_others(inputs, clouds, out.time, robot);
    write(inputs, robot, report, out);
  }
}

// A robot that is late stops: its present velocity is not known.
void Stops::read(const Inputs& inputs, StoppingRobot& robot) const noexcept {
  robot.is_usable = !inputs.robots.is_denied(robot.robot);
  robot.is_assumed = false;
  robot.age = 0.0;
  for (Joint& joint : robot.joints) {
    const TrackedVariable& state = inputs.robots.variables()[joint.variable];
    joint.is_known = state.input.has_value && !state.input.late && !state.input.contradicted;
    joint.any_direction = !state.velocity_known;
    joint.position = state.position;
    joint.velocity = state.velocity_known ? state.velocity : 0.0;
    joint.speed = state.velocity_known ? std::abs(state.velocity) : joint.full_speed;
    if (state.velocities_contradict && state.velocity_known && joint.velocity != 0.0) {
      joint.speed = std::max(joint.speed, state.sent_speed);
      joint.velocity = std::copysign(joint.speed, joint.velocity);
    }
    robot.is_assumed = robot.is_assumed || joint.any_direction;
    robot.is_usable = robot.is_usable && joint.is_known && joint.speed < kInfinity;
    joint.age = joint.is_known ? rounded_up(seconds(state.input.age_ns(inputs.time.now_ns))) : 0.0;
    robot.age = std::max(robot.age, joint.age);
  }
  robot.may_turn = false;
  for (Joint& joint : robot.joints) {
    const bool gains = joint.acceleration < kInfinity && !joint.any_direction;
    joint.gained = gains ? rounded_up(joint.acceleration * reaction_of(robot)) : 0.0;
    robot.may_turn = robot.may_turn || joint.gained > 0.0 || joint.any_direction;
  }
}

// Absent objects limit nothing, and neither do contacts that are allowed now.
bool Stops::knows_pairs(const Inputs& inputs, const Contacts& contacts,
                        StoppingRobot& robot) const noexcept {
  bool all_known = true;
  for (const WatchedPair& pair : robot.pairs) {
    const TrackedObject& other = inputs.objects[pair.other];
    const bool is_allowed = contacts.least_allowed(pair.pair) < kInfinity;
    double& margin = robot.margins[pair.pair];
    margin = other.absent || is_allowed ? -kInfinity : pair.margin;
    all_known = all_known && (margin == -kInfinity || other.known());
  }
  return all_known;
}

double Stops::reaction_of(const StoppingRobot& robot) const noexcept {
  return rounded_up(robot.stops->reaction + period_ + robot.age);
}

double Stops::time_of(const StoppingRobot& robot) const noexcept {
  double braking = 0.0;
  for (const Joint& joint : robot.joints)
    braking = std::max(braking, joint.stop->time(rounded_up(joint.speed + joint.gained)));
  return rounded_up(reaction_of(robot) - robot.age + braking);
}

void Stops::state_others(const Inputs& inputs, const CloudPairs* clouds, double time,
                         StoppingRobot& robot) const noexcept {
  const auto age = [&](const InputRecord& input) {
    return rounded_up(seconds(std::max<std::int64_t>(0, input.age_ns(inputs.time.now_ns))) + time);
  };
  std::size_t next = 0;
  const auto is_own = [&](std::uint32_t variable) {
    return std::ranges::find(robot.joints, variable, &Joint::variable) != robot.joints.end();
  };
  for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
    if (is_own(v)) continue;
    StatedJoint& stated = robot.question.joints[next++];
    const TrackedVariable& state = inputs.robots.variables()[v];
    stated.position = state.input.has_value ? state.position : 0.0;
    stated.age = state.input.has_value ? age(state.input) : time;
    stated.most = kInfinity;
    const std::uint32_t stopping = stopping_of_robot_[scene_.variables[v].robot];
    if (!std::ranges::binary_search(robot.beside, scene_.variables[v].robot)) {
      stated.most = 0.0;  // no pair of this robot has one of its links
      continue;
    }
    if (stopping == kNone || !robots_[stopping].is_usable) continue;
    // Another robot that stops as well: it may be anywhere on its way to its stop.
    const StoppingRobot& other = robots_[stopping];
    const auto joint = std::ranges::find(other.joints, v, &Joint::variable);
    if (joint == other.joints.end()) continue;
    const double faster = joint->speed + joint->gained;
    const double braking = other.stops->keeps_path
                               ? faster * std::max(longest_braking(1.0, false, other),
                                                   longest_braking(1.0, true, other))
                               : joint->stop->distance(faster);
    const double way = rounded_up(faster * reaction_of(other) + braking);
    if (joint->any_direction || joint->gained > 0.0) {
      stated.most = way;
    } else {
      stated.position = joint->position + std::copysign(0.5 * way, joint->velocity);
      stated.most = rounded_up(0.5 * way);
    }
  }
  std::size_t pose = 0, frame = 0;
  for (const std::uint32_t i : tracked_) {
    const TrackedObject& object = inputs.objects[i];
    const bool is_known = object.input.has_value && !object.absent;
    if (scene_.objects[i].is_seen()) {
      SeenFrame& stated = robot.question.seen[frame++];
      const CloudPairs::Content& content = clouds->content(scene_.objects[i].sensor);
      stated.is_known = is_known && content.cloud != nullptr;
      if (!stated.is_known) continue;
      stated.cloud = {std::shared_ptr<const SeenCloud>(), content.cloud};
      stated.world_from_sensor = object.pose;
      stated.pose_error = content.pose_error;
      stated.age = age(object.input);
    } else {
      StatedPose& stated = robot.question.poses[pose++];
      stated.is_known = is_known;
      stated.world_from_object = object.pose;
      stated.age = age(object.input);
    }
  }
}

// The longest of distance / speed of all joints, s: in proportion, all of them brake for as long.
// The speed of each joint is at most `scaling` times its present one, or `gained` more.
double Stops::longest_braking(double scaling, bool with_gain,
                              const StoppingRobot& robot) const noexcept {
  double longest = 0.0;
  for (const Joint& joint : robot.joints) {
    const double speed = rounded_up(scaling * (joint.speed + (with_gain ? joint.gained : 0.0)));
    if (with_gain) {
      longest = std::max(longest, joint.stop->longest(speed));
    } else if (joint.speed > 0.0) {
      longest = std::max(longest, joint.stop->distance(speed) / (scaling * joint.speed));
    }
  }
  return longest;
}

// First the joints go on as they do. Then they brake: in proportion, if the path is kept, so that
// they stay on a line; else each by itself. STOPS.md has the deviations from that.
void Stops::write_motion(double scaling, StoppingRobot& robot) const noexcept {
  JointTrajectory& motion = robot.question.motion;
  const std::size_t rows = motion.times.size(), joints = robot.joints.size();
  for (std::size_t row = 0; row < rows; ++row)
    motion.times[row] = kDuration * static_cast<double>(row) / static_cast<double>(rows - 1);
  const bool keeps_path = robot.stops->keeps_path;
  const double reaction = reaction_of(robot);
  const double on_line = scaling > 0.0 ? longest_braking(scaling, false, robot) : 0.0;
  const double at_most =
      std::max(on_line, robot.may_turn ? longest_braking(scaling, true, robot) : 0.0);
  double longest = 0.0;  // s: until all stand
  for (const Joint& joint : robot.joints)
    longest =
        std::max(longest, joint.stop->time(rounded_up(scaling * (joint.speed + joint.gained))));
  const double step = longest / static_cast<double>(kBraking);
  for (std::size_t j = 0; j < joints; ++j) {
    const Joint& joint = robot.joints[j];
    const double speed = rounded_up(scaling * joint.speed);
    const double faster = rounded_up(scaling * (joint.speed + joint.gained));
    const double way = joint.speed * reaction;
    const double side = joint.velocity < 0.0 ? -1.0 : 1.0;
    double deviation = joint.speed * (robot.age - joint.age) + 0.5 * joint.gained * reaction;
    const auto at = [&](std::size_t row) -> double& { return motion.positions[row * joints + j]; };
    at(0) = joint.position;
    if (joint.any_direction) {
      deviation += way + (keeps_path ? faster * at_most : joint.stop->distance(faster));
      for (std::size_t row = 1; row < rows; ++row) at(row) = joint.position;
    } else if (keeps_path) {
      at(1) = joint.position + side * (way + speed * on_line);
      deviation += scaling * joint.gained * at_most + speed * (at_most - on_line);
      if (joint.gained > 0.0) deviation += 0.5 * joint.acceleration * longest * longest;
    } else {
      const Braking braking = braking_of(*joint.stop, speed);
      for (std::size_t k = 0; k <= kBraking; ++k)
        at(1 + k) = joint.position + side * (way + braking.middle(static_cast<double>(k) * step));
      deviation += deviation_of(braking, step);
      if (joint.gained > 0.0) {
        const double back = rounded_up(std::max(0.0, joint.gained - joint.speed));
        deviation += std::max(joint.stop->distance(faster) - braking.distance,
                              braking.distance + joint.stop->distance(scaling * back));
      }
    }
    // What slides stops at its limits at the latest, and there it leaves the lines.
    double beyond = 0.0;
    for (std::size_t row = 1; row < rows; ++row) {
      const double within = std::clamp(at(row), std::min(joint.lower, joint.position),
                                       std::max(joint.upper, joint.position));
      beyond = std::max(beyond, std::abs(at(row) - within));
      at(row) = within;
    }
    deviation += beyond;
    motion.deviations[j] = deviation > 0.0 ? rounded_up(deviation) : 0.0;
  }
}

void Stops::write(const Inputs& inputs, StoppingRobot& robot, Report& report,
                  RobotStop& out) noexcept {
  Question& question = robot.question;
  question.only_margins = question.only_verdicts = false;
  question.work_limit = std::min(scene_.budget, kMostWork);
  write_motion(1.0, robot);
  if (search_->ask(question, robot.answer)) return;
  out.validity = robot.is_assumed ? SeparationValidity::kAssumed : SeparationValidity::kMeasured;
  out.clearance = kInfinity;
  for (const WatchedPair& pair : robot.pairs) {
    const double lower = std::max(0.0, robot.answer.lower_by_pair[pair.pair] - kRounding);
    if (pair.published != kNone && inputs.objects[pair.other].known()) {
      PairReport& of = report.pairs[pair.published];
      of.stop_lower = std::max(of.stop_lower, std::min(lower, std::max(0.0, of.lower)));
    }
    const double margin = robot.margins[pair.pair];
    if (margin == -kInfinity) continue;
    const double left = margin > 0.0 ? rounded_down(lower - margin) : lower;
    if (left < out.clearance) {
      out.clearance = left;
      out.pair = pair.pair;
    }
  }
  const MarginAnswer& decided = robot.answer.margins.front();
  out.scaling = out.share = 1.0;
  if (decided.verdict == Verdict::kFree) return;
  for (const WatchedPair& pair : robot.pairs) {
    const ObjectPair& of = scene_.pairs[pair.pair];
    if (std::minmax(of.first, of.second) == std::minmax(decided.first, decided.second))
      out.pair = pair.pair;
  }
  out.share = std::clamp(decided.above_until / kDuration, 0.0, 1.0);
  out.scaling = largest_scaling(out.share, robot);
}

// On one line, a lower speed ends on a part of it. Else a share of the speed has to be proven.
double Stops::largest_scaling(double clear_share, StoppingRobot& robot) noexcept {
  double least = 0.0, most = 1.0;
  if (robot.stops->keeps_path && !robot.may_turn && !robot.is_assumed) {
    const double reaction = reaction_of(robot);
    // Of the way, as a time at the present speed.
    const auto length = [&](double scaling) {
      return reaction + (scaling > 0.0 ? scaling * longest_braking(scaling, false, robot) : 0.0);
    };
    const double clear = rounded_down(clear_share * length(1.0));
    if (length(0.0) >= clear) return 0.0;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (least + most);
      (length(middle) < clear ? least : most) = middle;
    }
    return least;
  }
  Question& question = robot.question;
  question.only_margins = question.only_verdicts = true;
  question.work_limit = std::min(scene_.budget, kMostWork) / kHalvings;
  for (std::uint32_t i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (least + most);
    write_motion(middle, robot);
    const bool is_free = !search_->ask(question, robot.answer) &&
                         robot.answer.margins.front().verdict == Verdict::kFree;
    (is_free ? least : most) = middle;
  }
  return least;
}

}  // namespace clearance
