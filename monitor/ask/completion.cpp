#include "monitor/ask/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "config/scene/absent_robots.hpp"
#include "monitor/ask/robots_of_question.hpp"
#include "monitor/zones/contact_end.hpp"

namespace clearance {
namespace {

// More of them are not named.
constexpr std::size_t kMostNamed = 4;

std::string_view what_is_wrong(PresentPose::State state) noexcept {
  switch (state) {
    case PresentPose::State::kUsable:
    case PresentPose::State::kAbsent:
      break;
    case PresentPose::State::kUnknown:
      return "unknown";
    case PresentPose::State::kLate:
      return "older than its age limit";
    case PresentPose::State::kContradicted:
      return "contradicted";
  }
  return "absent";
}

// The inputs that a question needs and that are not usable.
class Missing {
 public:
  void add(std::string text) {
    ++count_;
    if (names_.size() < kMostNamed) names_.push_back(std::move(text));
  }
  [[nodiscard]] std::optional<std::string> text() const {
    if (count_ == 0) return std::nullopt;
    std::string text = "found ";
    for (std::size_t i = 0; i < names_.size(); ++i) text += (i == 0 ? "" : ", ") + names_[i];
    if (count_ > names_.size()) text += fmt::format(" and {} more", count_ - names_.size());
    return text + "; expected present inputs, or positions and poses that the question states";
  }

 private:
  std::vector<std::string> names_;
  std::size_t count_ = 0;
};

bool moves(const Question& question, const std::string& joint) {
  const auto has = [&](const JointTrajectory& motion) {
    return std::ranges::find(motion.joints, joint) != motion.joints.end();
  };
  return has(question.motion) || std::ranges::any_of(question.beside, has);
}

// The question says where the object is.
bool places(const Question& question, const std::string& object) {
  return std::ranges::find(question.poses, object, &StatedPose::object) != question.poses.end() ||
         std::ranges::find(question.moving, object, &ObjectMotion::object) !=
             question.moving.end() ||
         std::ranges::find(question.payloads, object, &Payload::name) != question.payloads.end() ||
         std::ranges::find(question.seen, object, &SeenFrame::sensor) != question.seen.end();
}

// The contacts that the tick allowed, with their ends on the clock of the waypoints.
std::vector<MeantContact> contacts_in_force(const Scene& scene, const InputState& state,
                                            double now) {
  std::vector<MeantContact> contacts;
  for (const ContactReport& report : state.contacts) {
    if (report.since_cycle == 0 || report.ended != ContactEnded::kNot) continue;
    const AllowedContact& contact = scene.contacts[report.contact];
    const ObjectPair& pair = scene.pairs[report.pair];
    double left = kInfinity;  // s
    const std::int64_t last_ns = last_time_of(contact.end, report.since_ns);
    if (last_ns != ContactEnd::kNoTime) left = 1e-9 * static_cast<double>(last_ns - state.now_ns);
    if (contact.end.last_cycle != ContactEnd::kNoCycle) {
      const double cycles =
          static_cast<double>(contact.end.last_cycle) - static_cast<double>(state.cycle);
      left = std::min(left, cycles * scene.shortest_period());
    }
    contacts.push_back({.first = scene.objects[pair.first].name,
                        .second = scene.objects[pair.second].name,
                        .depth = contact.depth,
                        .until = now + left,
                        .distance = contact.end.distance});
  }
  return contacts;
}

}  // namespace

std::optional<std::string> complete(const Scene& scene, const InputState& state,
                                    std::vector<SeenFrame> frames, Question& question) {
  Missing missing;
  const auto is_held = [&](const std::string& name) {
    return std::ranges::find(question.held, name, &HeldJoint::name) != question.held.end();
  };
  const auto is_stated = [&](const std::string& name) {
    return std::ranges::find(question.joints, name, &StatedJoint::name) != question.joints.end();
  };
  const auto is_settled = [&](const std::string& name) {
    return moves(question, name) || is_held(name) || is_stated(name);
  };
  AbsentRobots absent(scene);
  absent.find_left_out(
      scene, [&](std::uint32_t v) { return is_settled(scene.variables[v].name); },
      [&](std::uint32_t object) { return places(question, scene.objects[object].name); });
  const std::vector<bool> is_of_question = robots_of_question(scene, question);
  for (std::size_t i = 0; i < scene.variables.size(); ++i) {
    const JointVariable& variable = scene.variables[i];
    const PresentJoint& joint = state.joints[i];
    const std::string& name = variable.name;
    if (is_settled(name) || absent.is_left_out(variable.robot)) continue;
    if (joint.state != PresentPose::State::kUsable) {
      missing.add(
          fmt::format("the position of joint '{}' {}", variable.name, what_is_wrong(joint.state)));
      continue;
    }
    if (!is_of_question[variable.robot]) {
      question.joints.push_back(
          {.name = variable.name,
           .position = joint.position,
           .age = state.joint_ages[i],
           .speed = std::isnan(joint.velocity) ? 0.0 : std::abs(joint.velocity)});
      continue;
    }
    const bool may_move = question.others == OthersMove::kWithinMaxSpeed;
    if (may_move && !(std::abs(joint.velocity) <= kRestSpeed)) {
      missing.add(std::isnan(joint.velocity)
                      ? fmt::format("the velocity of joint '{}' unknown", variable.name)
                      : fmt::format("that joint '{}' moves at {:.3g} rad/s or m/s, and has no "
                                    "waypoints",
                                    variable.name, joint.velocity));
      continue;
    }
    question.held.push_back({variable.name, joint.position});
  }
  for (const PresentObject& present : state.objects) {
    const std::string& name = scene.objects[present.object].name;
    if (places(question, name) || present.pose.state == PresentPose::State::kAbsent) continue;
    if (present.pose.state != PresentPose::State::kUsable) {
      missing.add(
          fmt::format("the pose of object '{}' {}", name, what_is_wrong(present.pose.state)));
      continue;
    }
    if (scene.objects[present.object].is_seen()) {
      const auto frame = std::ranges::find(frames, name, &SeenFrame::sensor);
      if (frame == frames.end()) {
        missing.add(fmt::format("that sensor '{}' has no frame of this scene", name));
        continue;
      }
      // The age is not too low: the frame in use is not newer than the last one.
      frame->age = present.age;
      question.seen.push_back(std::move(*frame));
      continue;
    }
    question.poses.push_back(
        {.object = name, .world_from_object = present.pose.world_from_body, .age = present.age});
  }
  const double now = question.motion.times.empty() ? 0.0 : question.motion.times.front();
  if (!question.contacts) question.contacts = contacts_in_force(scene, state, now);
  return missing.text();
}

StartDeviation start_deviation(const Scene& scene, const InputState& state,
                               const JointTrajectory& motion) {
  StartDeviation most;
  for (std::size_t i = 0; i < scene.variables.size(); ++i) {
    const JointVariable& variable = scene.variables[i];
    const auto column = std::ranges::find(motion.joints, variable.name);
    if (column == motion.joints.end()) continue;
    const PresentJoint& joint = state.joints[i];
    double deviation = std::numeric_limits<double>::infinity();
    if (joint.state == PresentPose::State::kUsable) {
      deviation = motion.positions[static_cast<std::size_t>(column - motion.joints.begin())] -
                  joint.position;
      if (variable.wraps) deviation = std::remainder(deviation, 2.0 * std::numbers::pi);
      deviation = std::abs(deviation);
    }
    if (most.joint.empty() || deviation > most.deviation) most = {deviation, variable.name};
  }
  return most;
}

}  // namespace clearance
