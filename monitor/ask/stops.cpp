#include "monitor/ask/stops.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

constexpr double kTolerance = 4e-3;    // m
constexpr double kRounding = 1e-9;     // m: of the places of joints until they stand
constexpr double kRelative = 0x1p-44;  // of sums over levers
// Pairs that stay certainly farther than their margin by this are not examined more closely, m.
constexpr double kFarBeyondMargin = 0.1;
constexpr double kShare = 1e-3;           // of the motion: where it is not clear any more
constexpr std::uint32_t kMostWork = 800;  // queries and placements of a robot in a tick
constexpr std::uint32_t kHalvings = 4;    // of a share of the speed

bool keeps(double lower, double margin) noexcept {
  return MotionSearch::proves(lower - kRounding, margin);
}

// A position that a variable may have: of a quaternion, no rotation.
double neutral_position(const Scene& scene, std::uint32_t variable) {
  const JointVariable& of = scene.variables[variable];
  for (const RobotJoint& joint : scene.robots[of.robot].joints)
    if (joint.type == JointType::kFloating && variable == joint.variable + 6) return 1.0;
  return std::max(of.lower, std::min(0.0, of.upper));
}

}  // namespace

Stops::Stops(const Scene& scene) : scene_(scene), stopping_of_robot_(scene.robots.size(), kNone) {
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    if (!scene.robots[r].stopping.is_stated()) continue;
    stopping_of_robot_[r] = static_cast<std::uint32_t>(robots_.size());
    order_.push_back(stopping_of_robot_[r]);
    robots_.emplace_back(scene, r);
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
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v)
    neutral_.push_back(neutral_position(scene, v));
  changes_.resize(scene.variables.size() + 2 * scene.robots.size());
  approaches_.resize(scene.objects.size());
  for (StoppingRobot& robot : robots_) {
    add_pairs(robot);
    add_others(robot);
    make_room(robot);
  }
}

Stops::~Stops() = default;

Stops::StoppingRobot::StoppingRobot(const Scene& scene, std::uint32_t of)
    : robot(of), joints(scene, of, question.motion) {
  question.tolerance = kTolerance;
  question.instant = kShare;
  question.contacts.emplace();  // a contact in force has no margin here
}

// The pairs of what its joints move: its own links, and those of what stands on it.
void Stops::add_pairs(StoppingRobot& robot) const {
  std::vector<bool> is_moved(scene_.objects.size(), false);
  robot.counts.resize(scene_.variables.size() + 2 * scene_.robots.size());
  const auto root = [&](std::uint32_t r) {
    while (r != robot.robot && scene_.robots[r].base.kind == RobotBase::Kind::kLink)
      r = scene_.robots[r].base.robot;
    return r;
  };
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (root(r) != robot.robot) continue;
    for (const RobotLink& link : scene_.robots[r].links) {
      if (link.object == RobotLink::kNoObject || scene_.objects[link.object].fixed) continue;
      robot.links.push_back(link.object);
      search_->for_each_variable(link.object, [&](std::uint32_t v) {
        if (robot.joints.has(v)) is_moved[link.object] = true;
      });
    }
  }
  std::vector<double> stated(scene_.pairs.size(), 0.0);
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
    const std::uint32_t other = is_moved[pair.first] ? pair.second : pair.first;
    const bool is_tracked = robot_of_object_[other] == kNone && !scene_.objects[other].fixed;
    WatchedPair added{.pair = p,
                      .published = place,
                      .margin = stated[p],
                      .first_lever = static_cast<std::uint32_t>(robot.levers.size()),
                      .tracked = is_tracked ? other : kNone};
    added.model_error = search_->add_levers(p, robot.levers);
    added.end_lever = static_cast<std::uint32_t>(robot.levers.size());
    added.is_of_stops =
        !is_tracked && std::all_of(robot.levers.begin() + added.first_lever, robot.levers.end(),
                                   [&](const Lever& lever) { return stops(lever.variable); });
    robot.pairs.push_back(added);
    largest = std::max(largest, added.margin);
    for (const std::uint32_t object : {pair.first, pair.second})
      search_->for_each_variable(object, [&](std::uint32_t v) { robot.counts[v] = true; });
  }
  robot.question.far_enough = largest + kFarBeyondMargin;
  robot.question.margins_by_pair = robot.margins;
  robot.known.resize(scene_.pairs.size());
  robot.question.known_by_pair = robot.known;
}

// Whether a robot that stops moves this variable, and its stop says where to.
bool Stops::stops(std::uint32_t variable) const noexcept {
  if (variable >= scene_.variables.size()) return false;  // what carries a robot
  const std::uint32_t of = stopping_of_robot_[scene_.variables[variable].robot];
  return of != kNone && robots_[of].joints.has(variable);
}

// Room for what write() states in each tick, in an order that stays.
void Stops::add_others(StoppingRobot& robot) const {
  for (std::uint32_t v = 0; v < scene_.variables.size(); ++v)
    if (!robot.joints.has(v)) robot.question.joints.push_back({.name = scene_.variables[v].name});
  for (const std::uint32_t i : tracked_) {
    const Object& object = scene_.objects[i];
    if (object.is_seen()) {
      robot.question.seen.emplace_back().sensor = object.name;
    } else {
      robot.question.poses.emplace_back().object = object.name;
    }
  }
}

// A question of this size, so that those of ticks do not allocate.
void Stops::make_room(StoppingRobot& robot) {
  const auto neutral = [&](const std::string& name) {
    return neutral_[variable_named(scene_, name).value()];
  };
  Question& question = robot.question;
  JointTrajectory& motion = question.motion;
  for (std::size_t i = 0; i < motion.positions.size(); ++i)
    motion.positions[i] = neutral(motion.joints[i % motion.joints.size()]);
  std::ranges::fill(motion.deviations, 1.0);
  for (StatedJoint& stated : question.joints) {
    stated.position = neutral(stated.name);
    stated.most = 1.0;
  }
  for (SeenFrame& frame : question.seen) frame.is_known = false;
  question.work_limit = 1;
  (void)search_->ask(question, robot.answer);
}

void Stops::prepare(Report& report) const {
  for (const StoppingRobot& robot : robots_) report.stops.push_back(unknown_stop(robot));
}

void Stops::write(const Inputs& inputs, const CloudPairs* clouds, const Contacts& contacts,
                  Report& report) noexcept {
  all_usable_ = true;
  for (StoppingRobot& robot : robots_) {
    robot.joints.read(inputs);
    all_usable_ = all_usable_ && (robot.joints.is_usable() || is_absent(inputs, robot));
    for (const WatchedPair& pair : robot.pairs)
      if (pair.published != kNone) report.pairs[pair.published].stop_lower = kNan;
  }
  // One that hardly moves has a better bound by the line of the other than by its own.
  std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
    const double first = robots_[a].joints.farthest(), second = robots_[b].joints.farthest();
    return first != second ? first > second : a < b;
  });
  for (const std::uint32_t i : order_) {
    StoppingRobot& robot = robots_[i];
    RobotStop& out = report.stops[i];
    out = unknown_stop(robot);
    if (robot.joints.is_usable()) out.time = robot.joints.time();
    if (is_absent(inputs, robot)) {
      out.validity = SeparationValidity::kAbsent;
      out.clearance = kInfinity;
      out.scaling = out.share = 1.0;
      continue;
    }
    const std::optional<std::uint32_t> unknown = unknown_pair(inputs, contacts, robot);
    if (unknown) out.pair = *unknown;
    if (unknown || !robot.joints.is_usable() || !write(inputs, clouds, robot, report, out))
      for (const WatchedPair& pair : robot.pairs) publish(pair, -kInfinity, report);
  }
}

bool Stops::is_absent(const Inputs& inputs, const StoppingRobot& robot) noexcept {
  return !robot.links.empty() && std::ranges::all_of(robot.links, [&](std::uint32_t link) {
    return inputs.objects[link].absent;
  });
}

// Absent objects limit nothing, and neither do contacts that are as allowed.
std::optional<std::uint32_t> Stops::unknown_pair(const Inputs& inputs, const Contacts& contacts,
                                                 StoppingRobot& robot) const noexcept {
  std::optional<std::uint32_t> unknown;
  for (WatchedPair& pair : robot.pairs) {
    const ObjectPair& of = scene_.pairs[pair.pair];
    const TrackedObject &first = inputs.objects[of.first], &second = inputs.objects[of.second];
    pair.is_absent = first.absent || second.absent;
    double& margin = robot.margins[pair.pair];
    margin = pair.is_absent || contacts.allow(pair.pair) ? -kInfinity : pair.margin;
    if (!unknown && !pair.is_absent && !(first.is_trusted() && second.is_trusted()))
      unknown = pair.pair;
  }
  return unknown;
}

void Stops::state_others(const Inputs& inputs, const CloudPairs* clouds, double time,
                         StoppingRobot& robot) const noexcept {
  const auto age = [&](const InputRecord& input) {
    return rounded_up(seconds(std::max<std::int64_t>(0, input.age_ns(inputs.time.now_ns))) + time);
  };
  std::size_t next = 0;
  for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
    if (robot.joints.has(v)) continue;
    StatedJoint& stated = robot.question.joints[next++];
    const TrackedVariable& state = inputs.robots.variables()[v];
    stated.position = state.input.has_value ? state.position : neutral_[v];
    stated.age = state.input.has_value ? age(state.input) : time;
    stated.speed = state.input.has_value ? std::abs(state.velocity) : 0.0;
    stated.most = robot.counts[v] ? kInfinity : 0.0;  // no pair of this robot depends on others
    if (!robot.counts[v] || !stops(v)) continue;
    const StoppingJoints& of = robots_[stopping_of_robot_[scene_.variables[v].robot]].joints;
    if (of.is_usable()) of.state(stated, v);
  }
  std::size_t pose = 0, frame = 0;
  for (const std::uint32_t i : tracked_) {
    const TrackedObject& object = inputs.objects[i];
    const bool is_known = object.input.has_value;
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

// By how much each body may come nearer to others from the places that are in use. What is stated
// for a search counts, so that this admits no less.
void Stops::note_changes(const Inputs& inputs, const StoppingRobot& robot) noexcept {
  const Question& question = robot.question;
  std::ranges::fill(changes_, kInfinity);  // of what carries a robot
  std::size_t next = 0;
  for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
    if (robot.joints.has(v)) {
      changes_[v] = robot.joints.covered(v);
      continue;
    }
    const StatedJoint& stated = question.joints[next++];
    const double offset = std::abs(stated.position - inputs.robots.variables()[v].position);
    const double by_speed =
        swept(stated.age, std::max(scene_.variables[v].max_speed, stated.speed));
    changes_[v] = offset == 0.0 ? std::min(stated.most, by_speed) : stated.most + offset;
  }
  std::size_t pose = 0, frame = 0;
  for (const std::uint32_t i : tracked_) {
    const double age =
        scene_.objects[i].is_seen() ? question.seen[frame++].age : question.poses[pose++].age;
    approaches_[i] = swept(age, scene_.objects[i].max_speed);
  }
}

// A bound of this tick falls by what the levers and the other body's motion admit. It is enough if
// the pair keeps its margin, and either is far or was hardly farther before the stop.
bool Stops::bound_by_levers(const Inputs& inputs, const Report& report,
                            StoppingRobot& robot) noexcept {
  note_changes(inputs, robot);
  bool is_enough = true;
  for (const WatchedPair& pair : robot.pairs) {
    KnownBound& known = robot.known[pair.pair];
    known = {};
    if (pair.is_absent) continue;
    const double margin = robot.margins[pair.pair];
    if (pair.published != kNone) {
      double nearer = pair.model_error + (pair.tracked == kNone ? 0.0 : approaches_[pair.tracked]);
      for (std::uint32_t i = pair.first_lever; i < pair.end_lever; ++i)
        nearer += swept(changes_[robot.levers[i].variable], robot.levers[i].factor);
      const PairReport& now = report.pairs[pair.published];
      const double lower = now.lower - (1.0 + kRelative) * nearer;
      known.lower = lower > 0.0 ? rounded_down(lower) : 0.0;
      if (holds_for_all(pair) && now.stop_lower > known.lower) known.lower = now.stop_lower;
      const double enough = std::min(robot.question.far_enough, now.upper - kTolerance);
      known.is_enough = keeps(known.lower, margin) && known.lower >= enough;
    }
    is_enough = is_enough && known.is_enough;
  }
  return is_enough;
}

void Stops::publish(const WatchedPair& pair, double lower, Report& report) const noexcept {
  if (pair.published == kNone || pair.is_absent) return;
  PairReport& of = report.pairs[pair.published];
  lower = std::min(lower, std::max(0.0, of.lower));
  const bool replaces = holds_for_all(pair) ? lower > of.stop_lower : lower < of.stop_lower;
  if (replaces || std::isnan(of.stop_lower)) of.stop_lower = lower;
}

template <class Bound>
void Stops::write_bounds(const StoppingRobot& robot, const Bound& bound, Report& report,
                         RobotStop& out) const noexcept {
  out.clearance = kInfinity;
  for (const WatchedPair& pair : robot.pairs) {
    const double lower = std::max(0.0, bound(pair.pair) - kRounding);
    publish(pair, lower, report);
    const double margin = robot.margins[pair.pair];
    if (margin == -kInfinity) continue;
    const double left = margin > 0.0 ? rounded_down(lower - margin) : lower;
    if (left < out.clearance) {
      out.clearance = left;
      out.pair = pair.pair;
    }
  }
}

bool Stops::write(const Inputs& inputs, const CloudPairs* clouds, StoppingRobot& robot,
                  Report& report, RobotStop& out) noexcept {
  state_others(inputs, clouds, out.time, robot);
  const SeparationValidity validity =
      robot.joints.is_assumed() ? SeparationValidity::kAssumed : SeparationValidity::kMeasured;
  if (bound_by_levers(inputs, report, robot)) {
    write_bounds(
        robot, [&](std::uint32_t p) { return robot.known[p].lower; }, report, out);
    out.validity = validity;
    out.scaling = out.share = 1.0;
    return true;
  }
  Question& question = robot.question;
  question.only_verdicts = false;
  question.work_limit = std::min(scene_.budget, kMostWork);
  question.instant = robot.joints.is_on_line() ? kShare : 1.0;
  robot.joints.write_motion(1.0, question.motion);
  if (search_->ask(question, robot.answer)) return false;
  write_bounds(
      robot, [&](std::uint32_t p) { return robot.answer.lower_by_pair[p]; }, report, out);
  const MarginAnswer& decided = robot.answer.margins.front();
  out.validity = validity;
  out.scaling = out.share = 1.0;
  if (decided.verdict == Verdict::kFree) return true;
  out.share = std::clamp(decided.above_until / StoppingJoints::kDuration, 0.0, 1.0);
  out.scaling = largest_scaling(out.share, robot);
  return true;
}

// On one line, a lower speed ends on a part of it. Else a share of the speed has to be proven: for
// the pairs that are not clear of full speed, since its region has those of all lower ones.
double Stops::largest_scaling(double clear_share, StoppingRobot& robot) noexcept {
  if (robot.joints.is_on_line()) return robot.joints.scaling_within(clear_share);
  double least = 0.0, most = 1.0;
  Question& question = robot.question;
  question.only_verdicts = true;
  for (const WatchedPair& pair : robot.pairs)
    if (keeps(robot.answer.lower_by_pair[pair.pair], robot.margins[pair.pair]))
      robot.margins[pair.pair] = -kInfinity;
  question.work_limit = std::min(scene_.budget, kMostWork) / kHalvings;
  for (std::uint32_t i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (least + most);
    robot.joints.write_motion(middle, question.motion);
    const bool is_free = !search_->ask(question, robot.answer) &&
                         robot.answer.margins.front().verdict == Verdict::kFree;
    (is_free ? least : most) = middle;
  }
  return least;
}

}  // namespace clearance
