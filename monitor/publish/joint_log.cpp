#include "monitor/publish/joint_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/interface/age_text.hpp"

namespace clearance {
void JointLog::change(const Scene& scene) {
  scene_ = &scene;
  std::erase_if(joints_, [&](const auto& joint) {
    return std::ranges::find(scene.variables, joint.first, &JointVariable::name) ==
           scene.variables.end();
  });
  std::erase_if(robots_, [&](const auto& robot) {
    return std::ranges::find(scene.robots, robot.first, &Robot::name) == scene.robots.end();
  });
}

void JointLog::update(const decltype(clearance_msg_Health::joints)& joints,
                      const std::function<std::string()>& senders) {
  for (std::uint32_t robot = 0; robot < scene_->robots.size(); ++robot) {
    update_robot(robot, joints, senders);
  }
}

void JointLog::update_robot(std::uint32_t robot,
                            const decltype(clearance_msg_Health::joints)& joints,
                            const std::function<std::string()>& senders) {
  const std::string& name = scene_->robots[robot].name;
  std::map<std::pair<State, State>, std::pair<Names, std::int64_t>> changes;
  std::map<std::pair<std::string, std::string>, Names> rivals;
  Names unheard;
  for (std::uint32_t i = 0; i < joints._length; ++i) {
    const clearance_msg_JointAge& joint = joints._buffer[i];
    if (scene_->variables[joint.variable].robot != robot) continue;
    const State now = joint.age_ns < 0     ? State::kUnseen
                      : joint.contradicted ? State::kContradicted
                      : joint.stale        ? State::kLate
                                           : State::kFine;
    auto& [before, other_source] = joints_[joint.name];
    // The intake reports which frame of a base is missing.
    if (now == State::kUnseen && !scene_->robots[robot].is_of_base(joint.variable))
      unheard.emplace_back(joint.name);
    if (now != before) {
      auto& [names, age_ns] = changes[{before, now}];
      names.emplace_back(joint.name);
      age_ns = std::max(age_ns, joint.age_ns);
    }
    before = now;
    const std::string other = joint.other_source;
    if (!other.empty() && other != other_source)
      rivals[{joint.source, other}].emplace_back(joint.name);
    other_source = other;
  }
  for (const auto& [change, joined] : changes) {
    log_change(name, change.first, change.second, joined.first, joined.second);
  }
  for (const auto& [sources, names] : rivals) {
    log_line(lines::kTwoJointSources, name, sources.first, sources.second,
             listed(names, kNamesALine));
  }
  auto& [samples, silence_said] = robots_[name];
  if (++samples < kSilentSamples || unheard.empty() || std::exchange(silence_said, true)) return;
  log_line(lines::kJointsSilent, counted(unheard.size(), "joint"), name,
           listed(unheard, kNamesALine), senders());
}

void JointLog::log_change(const std::string& robot, State before, State now, const Names& names,
                          std::int64_t age_ns) const {
  const std::string joints = counted(names.size(), "joint");
  switch (now) {
    case State::kUnseen:
      return;
    case State::kFine:
      log_line(before == State::kUnseen ? lines::kJointsHeard : lines::kJointsBack, joints, robot,
               listed(names, kNamesALine));
      return;
    case State::kLate:
      log_line(lines::kJointsLate, joints, robot, age_text(age_ns), listed(names, kNamesALine));
      return;
    case State::kContradicted:
      log_line(lines::kJointsContradict, joints, robot, listed(names, kNamesALine));
      return;
  }
}

}  // namespace clearance
