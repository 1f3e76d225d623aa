#include "monitor/bodies/robot_inputs.hpp"

#include <algorithm>

namespace clearance {
namespace {

// Links come after all other objects.
std::uint32_t first_link_of(const Scene& scene) {
  auto first = static_cast<std::uint32_t>(scene.objects.size());
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links) first = std::min(first, link.object);
  }
  return first;
}

// No joint state is awaited of a robot without variables, which follows what it stands on, and of
// one whose joints are all held.
std::vector<bool> heard_at_the_start(const Scene& scene) {
  std::vector<bool> heard;
  for (const Robot& robot : scene.robots)
    heard.push_back(robot.base.kind != RobotBase::Kind::kWorld);
  for (const JointVariable& variable : scene.variables) heard[variable.robot] = true;
  for (const JointVariable& variable : scene.variables)
    if (!variable.is_held()) heard[variable.robot] = false;
  return heard;
}

// A held joint stands, and is known at every tick.
std::vector<TrackedVariable> variables_at_the_start(const Scene& scene) {
  std::vector<TrackedVariable> variables(scene.variables.size());
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (!scene.variables[i].is_held()) continue;
    variables[i].input.has_value = variables[i].velocity_known = true;
    variables[i].position = scene.variables[i].held;
  }
  return variables;
}

LinkState base_at(const TrackedObject& object) noexcept {
  LinkState base;
  base.known = object.input.has_value;
  base.velocity_known = object.velocity_known();
  base.late = object.input.late;
  base.contradicted = object.input.contradicted;
  base.stamp_ns = object.input.stamp_ns;
  base.pose = object.pose;
  base.twist = object.twist;
  return base;
}

// A link that a camera does not see where its joints say may be anywhere.
LinkState denied_state(const LinkState& placed) noexcept {
  LinkState state = placed;
  state.late = state.contradicted = true;
  state.unobserved_shift = kInfinity;
  return state;
}

}  // namespace

RobotInputs::RobotInputs(const Scene& scene)
    : scene_(scene),
      first_link_(first_link_of(scene)),
      robot_of_(scene.objects.size() - first_link_),
      heard_(heard_at_the_start(scene)),
      variables_(variables_at_the_start(scene)),
      bases_(scene.robots.size()),
      seen_(scene.sensors.size() * scene.robots.size()),
      kinematics_(scene.robots) {
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    for (const RobotLink& link : scene.robots[robot].links) {
      if (link.object != RobotLink::kNoObject) robot_of_[link.object - first_link_] = robot;
    }
  }
}

void RobotInputs::witness(std::uint32_t sensor, const RobotsSeen& seen,
                          std::uint32_t frames) noexcept {
  const std::size_t robots = scene_.robots.size();
  for (std::size_t r = 0; r < std::min<std::size_t>(robots, kMostRobotsSeen); ++r) {
    const std::uint64_t bit = std::uint64_t{1} << r;
    seen_[sensor * robots + r].add((seen.there & bit) != 0, (seen.not_there & bit) != 0, frames);
  }
}

bool RobotInputs::is_denied(std::uint32_t robot) const noexcept {
  const std::size_t robots = scene_.robots.size();
  for (std::size_t i = robot; i < seen_.size(); i += robots)
    if (seen_[i].denied) return true;
  const RobotBase& base = scene_.robots[robot].base;
  return base.kind == RobotBase::Kind::kLink && is_denied(base.robot);
}

bool RobotInputs::is_lost(std::uint32_t robot, std::uint32_t link,
                          std::span<const TrackedObject> objects) const noexcept {
  if (is_denied(robot)) return true;
  for (;;) {
    for (; link > 0; link = scene_.robots[robot].joints[link - 1].parent) {
      const RobotJoint& joint = scene_.robots[robot].joints[link - 1];
      for (std::uint32_t i = 0; i < variables_of(joint.type); ++i) {
        const TrackedVariable& state = variables_[joint.variable + i];
        const bool is_known = state.input.has_value && !state.input.contradicted;
        if (!is_known || !(state.may_have_moved < kInfinity)) return true;
      }
    }
    const RobotBase& base = scene_.robots[robot].base;
    if (base.kind == RobotBase::Kind::kWorld) return false;
    if (base.kind == RobotBase::Kind::kObject) return !objects[base.object].known();
    robot = base.robot;
    link = base.link;
  }
}

void RobotInputs::forget_ages(std::int64_t now_ns) noexcept {
  for (TrackedVariable& variable : variables_) {
    if (variable.input.has_value) forget_age(now_ns, variable);
  }
}

void RobotInputs::take_over(const RobotInputs& before, const SceneMap& map) noexcept {
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const JointVariable& variable = scene_.variables[i];
    if (map.variables[i] != SceneMap::kNone && variable.is_read && !variable.is_held())
      variables_[i] = before.variables_[map.variables[i]];
  }
  for (std::size_t i = 0; i < heard_.size(); ++i) {
    if (map.robots[i] != SceneMap::kNone) heard_[i] = heard_[i] || before.heard_[map.robots[i]];
  }
  // The sensors of a scene stand in the order of the cell.
  const std::size_t robots = heard_.size(), robots_before = before.heard_.size();
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const std::uint32_t old = map.robots[i % robots];
    const std::size_t at = i / robots * robots_before + old;
    if (old != SceneMap::kNone && at < before.seen_.size()) seen_[i] = before.seen_[at];
  }
}

void RobotInputs::save(StateWriter& out) const {
  out.put(std::span(variables_));
  for (const bool heard : heard_) out.put(heard);
  out.put(std::span(seen_));
}

void RobotInputs::restore(StateReader& in, std::int64_t now_ns) noexcept {
  const std::vector<TrackedVariable> own = variables_;
  in.take(std::span(variables_));
  for (std::size_t i = 0; i < own.size(); ++i) {
    in.expect(variables_[i].is_sound(own[i]));
    in.expect(scene_.variables[i].is_held() ||
              variables_[i].input.is_of_no_future(now_ns, scene_.future_limit_ns));
  }
  for (auto heard : heard_) {
    bool value = false;
    in.take(value);
    in.expect(are_flags(value));
    heard = in.good() && value;
  }
  in.take(std::span(seen_));
  for (const SeenCount& seen : seen_) in.expect(are_flags(seen.denied));
}

void RobotInputs::place(std::int64_t now_ns, std::span<TrackedObject> objects,
                        std::int64_t response_left_ns) noexcept {
  response_is_late_ = false;
  if (std::ranges::find(heard_, true) == heard_.end()) return;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    if (scene_.variables[i].is_held()) variables_[i].input.stamp_ns = now_ns;
    advance(scene_.variables[i], now_ns, variables_[i], response_left_ns);
    if (variables_[i].input.response_is_late(now_ns, scene_.variables[i].age_limit_ns))
      response_is_late_ = true;
  }
  for (std::size_t robot = 0; robot < bases_.size(); ++robot) {
    const RobotBase& base = scene_.robots[robot].base;
    if (base.kind == RobotBase::Kind::kObject) bases_[robot] = base_at(objects[base.object]);
  }
  kinematics_.place(variables_, bases_);
  for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot) {
    if (!heard_[robot]) continue;
    const bool denied = !seen_.empty() && is_denied(robot);
    const std::vector<RobotLink>& links = scene_.robots[robot].links;
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (links[link].object == RobotLink::kNoObject) continue;
      const Object& object = scene_.objects[links[link].object];
      TrackedObject& state = objects[links[link].object];
      if (object.fixed || state.absent) continue;
      const LinkState& placed = kinematics_.links(robot)[link];
      if (denied) {
        follow(denied_state(placed), object, now_ns, state, response_left_ns);
      } else {
        follow(placed, object, now_ns, state, response_left_ns);
      }
    }
  }
}

}  // namespace clearance
