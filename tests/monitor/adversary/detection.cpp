#include "tests/monitor/adversary/detection.hpp"

#include <string_view>

#include "monitor/interface/log_lines.hpp"
#include "tests/monitor/adversary/rests_on.hpp"

namespace clearance::test::lies {
namespace {

// The variables of a robot's base contain a slash; they follow the frames of tf.
bool is_struck(std::string_view variable, Channel channel) {
  const bool is_base = variable.find('/') != variable.npos;
  if (is_robot(channel)) return !is_base && variable.starts_with(name(channel));
  return is_base && (channel == Channel::kOdom || channel == Channel::kBase);
}

}  // namespace

Detection::Detection(const Scene& scene, const Fault& fault) : fault_(fault) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    std::size_t body = 0;
    while (object.name != body_name(body)) ++body;
    if (!rests_on(body, fault.channel) || is_link_of(Channel::kArm, body) ||
        is_link_of(Channel::kPost, body))
      continue;
    (object.is_seen() ? seen_ : objects_).push_back(i);
    if (object.is_seen()) sensors_.push_back(object.sensor);
  }
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    if (is_struck(scene.variables[i].name, fault.channel)) variables_.push_back(i);
  }
}

Detection::Refused Detection::refused(const Monitor& monitor, const Sensors& sensors) const {
  Refused sum;
  const auto add = [](const auto& counts, auto& to) {
    for (std::size_t cause = 0; cause < to.size(); ++cause) to[cause] += counts[cause];
  };
  for (const std::uint32_t object : objects_) add(monitor.rejected(object), sum.samples);
  for (const std::uint32_t variable : variables_)
    add(monitor.rejected_joints(variable), sum.samples);
  for (const std::uint32_t sensor : sensors_) add(sensors.status(sensor).counts, sum.frames);
  return sum;
}

void Detection::follow(const Monitor& monitor, const Sensors& sensors, std::int64_t t) {
  const Refused now = refused(monitor, sensors);
  if (t < fault_.from) before_ = now;
  if (t < fault_.from || t >= fault_.to) return;
  const auto note_late = [&](const InputAge& age, std::string_view late, std::string_view refuted) {
    const bool was_heard = age.age_ns >= 0;
    if (age.stale && was_heard) note(age.contradicted ? refuted : late, t);
  };
  for (const std::uint32_t object : objects_)
    note_late(monitor.input_age(object), lines::kPosesLate.code, lines::kPosesContradict.code);
  for (const std::uint32_t object : seen_)
    note_late(monitor.input_age(object), lines::kFramesLate.code, lines::kFramesUnplaced.code);
  for (const std::uint32_t variable : variables_) {
    const InputAge age = monitor.joint_age(variable);
    note_late(age, lines::kJointsLate.code, lines::kJointsContradict.code);
    if (age.velocities_contradict) note(lines::kVelocitiesContradict.code, t);
  }
  for (std::size_t cause = 0; cause < kRejects; ++cause) {
    if (now.samples[cause] > before_.samples[cause])
      note(clearance::name(static_cast<Reject>(cause)), t);
  }
  for (std::size_t cause = 1; cause < kFrameFaults; ++cause) {  // 0 counts those in use
    if (now.frames[cause] > before_.frames[cause])
      note(clearance::name(static_cast<FrameFault>(cause)), t);
  }
}

}  // namespace clearance::test::lies
