#include "monitor/dds/joint_log.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <utility>

namespace clearance {
namespace {

// "a, b, c and 4 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kListed = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kListed); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  return names.size() > kListed ? fmt::format("{} and {} more", text, names.size() - kListed)
                                : text;
}

}  // namespace

JointLog::JointLog(const Scene& scene)
    : scene_(scene),
      states_(scene.variables.size()),
      others_(scene.variables.size()),
      silence_said_(scene.robots.size()) {}

void JointLog::update(const decltype(clearance_msg_Health::joints)& joints,
                      const std::function<std::string()>& senders) {
  ++samples_;
  for (std::uint32_t robot = 0; robot < scene_.robots.size(); ++robot) {
    update_robot(robot, joints, senders);
  }
}

void JointLog::update_robot(std::uint32_t robot,
                            const decltype(clearance_msg_Health::joints)& joints,
                            const std::function<std::string()>& senders) {
  const std::string& name = scene_.robots[robot].name;
  std::map<std::pair<State, State>, std::pair<Names, std::int64_t>> changes;
  std::map<std::pair<std::string, std::string>, Names> rivals;
  Names unseen;
  for (std::uint32_t i = 0; i < joints._length; ++i) {
    const clearance_msg_JointAge& joint = joints._buffer[i];
    if (scene_.variables[joint.variable].robot != robot) continue;
    const State now = joint.age_ns < 0     ? State::kUnseen
                      : joint.contradicted ? State::kContradicted
                      : joint.stale        ? State::kLate
                                           : State::kFine;
    State& before = states_[joint.variable];
    // The intake tells which frame of a base is missing.
    if (now == State::kUnseen && !scene_.robots[robot].is_of_base(joint.variable))
      unseen.emplace_back(joint.name);
    if (now != before) {
      auto& [names, age_ns] = changes[{before, now}];
      names.emplace_back(joint.name);
      age_ns = std::max(age_ns, joint.age_ns);
    }
    before = now;
    const std::string other = joint.other_source;
    if (!other.empty() && other != others_[joint.variable])
      rivals[{joint.source, other}].emplace_back(joint.name);
    others_[joint.variable] = other;
  }
  for (const auto& [change, joined] : changes) {
    log_change(name, change.first, change.second, joined.first, joined.second);
  }
  for (const auto& [sources, names] : rivals) {
    spdlog::warn(
        "joints of {} are sent by '{}' and by '{}': positions of the latter are not used ({})",
        name, sources.first, sources.second, listed(names));
  }
  if (unseen.empty() || silence_said_[robot] || samples_ < kSilentSamples) return;
  silence_said_[robot] = true;
  spdlog::warn("nothing that could be used has come of {} joints of {} ({}): {}", unseen.size(),
               name, listed(unseen), senders());
}

void JointLog::log_change(const std::string& robot, State before, State now, const Names& names,
                          std::int64_t age_ns) const {
  switch (now) {
    case State::kUnseen:
      return;
    case State::kFine:
      spdlog::info("{} joints of {} are {}: {}", names.size(), robot,
                   before == State::kUnseen ? "heard" : "back", listed(names));
      return;
    case State::kLate:
      spdlog::warn(
          "the last positions of {} joints of {} that could be used are {} ms old: what hangs on "
          "them is stale ({})",
          names.size(), robot, age_ns / 1'000'000, listed(names));
      return;
    case State::kContradicted:
      spdlog::warn(
          "positions of {} joints of {} contradict each other or the limits of the joints: what "
          "hangs on them is unknown ({})",
          names.size(), robot, listed(names));
      return;
  }
}

}  // namespace clearance
