#include "monitor/publish/health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "monitor/intake/news.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/publish/refused_text.hpp"

namespace clearance {
namespace {

// The health topic has times in us.
constexpr double kUsPerNs = 1e-3;

void fill(const Histogram& from, double& p50, double& p999, double& max) {
  p50 = kUsPerNs * static_cast<double>(from.percentile_ns(0.5));
  p999 = kUsPerNs * static_cast<double>(from.percentile_ns(0.999));
  max = kUsPerNs * static_cast<double>(from.max_ns());
}

// Times of the loop, as microseconds.
void fill_loop(const LoopStatistics& statistics, clearance_msg_Health& out) {
  out.cycle = statistics.cycle;
  out.now_ns = statistics.now_ns;
  fill(statistics.tick, out.tick_p50_us, out.tick_p999_us, out.tick_max_us);
  fill(statistics.wakeup, out.wakeup_p50_us, out.wakeup_p999_us, out.wakeup_max_us);
  out.late_responses = statistics.late_responses;
  out.tick_second_max_us = kUsPerNs * static_cast<double>(statistics.tick_second_max_ns);
  out.wakeup_second_max_us = kUsPerNs * static_cast<double>(statistics.wakeup_second_max_ns);
  out.clock_steps = statistics.clock_steps;
  out.clock_offset_ns = statistics.clock_offset_ns;
  out.overruns = statistics.overruns;
  out.skipped_cycles = statistics.skipped_cycles;
}

void fill_responses(const ResponseTimes& responses, clearance_msg_Health& out) {
  fill(responses.slowest(), out.response_p50_us, out.response_p999_us, out.response_max_us);
  const std::vector<InputResponse> inputs = responses.inputs();
  reserve_sequence(out.responses, inputs.size());
  for (const InputResponse& of : inputs) {
    out.responses._buffer[out.responses._length++] = {dds_string_dup(of.input.c_str()),
                                                      kUsPerNs * static_cast<double>(of.p50_ns),
                                                      kUsPerNs * static_cast<double>(of.max_ns)};
  }
}

// Only causes that occurred are listed; the sequence was sized for all of them.
void add_rejection(clearance_msg_Health& out, const std::string& object, const char* cause,
                   std::uint64_t count, const std::string& last = "") {
  if (count == 0 || out.rejected._length == out.rejected._maximum) return;
  clearance_msg_RejectCount& entry = out.rejected._buffer[out.rejected._length++];
  entry.object = dds_string_dup(object.c_str());
  entry.cause = dds_string_dup(cause);
  entry.count = count;
  entry.last = dds_string_dup(last.c_str());
}

// The causes of Reject, spelt for people.
const char* cause_name(std::size_t cause) { return name(static_cast<Reject>(cause)); }

// Only the last refusal of an input is kept, whatever its cause.
std::string last_of(const RefusedValue& refused, std::size_t cause) {
  return static_cast<std::size_t>(refused.cause) == cause ? text_of(refused) : "";
}

// Refused messages of sensors, by cause.
void add_refused_frames(const Scene& scene, const std::vector<SensorStatus>& sensors,
                        clearance_msg_Health& out) {
  for (std::size_t i = 0; i < std::min(scene.sensors.size(), sensors.size()); ++i) {
    for (std::size_t fault = 1; fault < kFrameFaults; ++fault) {
      add_rejection(out, "sensor " + scene.sensors[i].name, name(static_cast<FrameFault>(fault)),
                    sensors[i].counts[fault]);
    }
  }
}

void add_witness(const Sensor& sensor, const std::string& robot, const std::string& link,
                 const RaysMet& rays, bool denied, clearance_msg_Health& out) {
  if (out.witnesses._length == out.witnesses._maximum) return;
  clearance_msg_WitnessHealth& entry = out.witnesses._buffer[out.witnesses._length++];
  entry.sensor = dds_string_dup(sensor.name.c_str());
  entry.robot = dds_string_dup(robot.c_str());
  entry.link = dds_string_dup(link.c_str());
  entry.agreeing = rays.agreeing;
  entry.through = rays.through;
  entry.denied = denied;
  entry.residual_p50 = rays.residual_p50;
  entry.residual_p90 = rays.residual_p90;
}

// The robots that a sensor is asked about, each with the links that enough rays meet; what others
// carry is not looked at.
void fill_witnesses(const Scene& scene, const std::vector<SensorStatus>& sensors,
                    clearance_msg_Health& out) {
  std::size_t most = 0;
  for (const SensorStatus& sensor : sensors)
    for (const RobotSeen& robot : sensor.robots) most += 1 + robot.rays.links.size();
  reserve_sequence(out.witnesses, std::min<std::size_t>(most, 4096));
  for (std::size_t i = 0; i < std::min(scene.sensors.size(), sensors.size()); ++i) {
    const std::vector<RobotSeen>& robots = sensors[i].robots;
    for (std::size_t r = 0; r < std::min(scene.robots.size(), robots.size()); ++r) {
      const Robot& robot = scene.robots[r];
      const RaysOfRobot& rays = robots[r].rays;
      if (robot.is_attached) continue;
      const auto add = [&](const std::string& link, const RaysMet& met) {
        add_witness(scene.sensors[i], robot.name, link, met, robots[r].count.denied, out);
      };
      add("", rays);
      for (std::size_t l = 0; l < std::min(robot.links.size(), rays.links.size()); ++l) {
        if (rays.links[l].agreeing + rays.links[l].through >= Witness::kLeastRays)
          add(robot.links[l].name, rays.links[l]);
      }
    }
  }
}

// Lists refusals by source and by object. Refusals of unknown ids have no object, so they are
// listed by cause: the totals minus the objects' counts.
void fill_rejections(const Scene& scene, const LoopStatistics& statistics, const PoseReader& poses,
                     const std::vector<SensorStatus>& sensors, clearance_msg_Health& out) {
  const std::vector<RefusedSource> refused = poses.refused_sources();
  const std::size_t inputs = scene.objects.size() + scene.variables.size();
  const std::size_t most =
      1 + refused.size() + (inputs + 1) * kRejects + sensors.size() * kFrameFaults;
  reserve_sequence(out.rejected, std::min<std::size_t>(most, 4096));
  for (const RefusedSource& source : refused) {
    const std::string_view of = source.source.view();
    const bool is_sum = of.empty() && source.cause != SourceRefusal::kNoName;
    add_rejection(out, is_sum ? "other sources" : "source " + quoted(of), name(source.cause),
                  source.poses);
  }
  add_refused_frames(scene, sensors, out);
  add_rejection(out, "sources", "batches of a writer with too many names", poses.refused_names());
  std::array<std::uint64_t, kRejects> nameless = statistics.rejected_total;
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    for (std::size_t cause = 0; cause < kRejects; ++cause) {
      const std::uint64_t count = statistics.rejected[object][cause];
      nameless[cause] -= std::min(count, nameless[cause]);
      add_rejection(out, scene.objects[object].name, cause_name(cause), count,
                    last_of(statistics.refused_poses[object], cause));
    }
  }
  for (std::size_t joint = 0; joint < scene.variables.size(); ++joint) {
    for (std::size_t cause = 0; cause < kRejects; ++cause) {
      const std::uint64_t count = statistics.rejected_joints[joint][cause];
      nameless[cause] -= std::min(count, nameless[cause]);
      add_rejection(out, "joint " + scene.variables[joint].name, cause_name(cause), count,
                    last_of(statistics.refused_positions[joint], cause));
    }
  }
  for (std::size_t cause = 0; cause < kRejects; ++cause) {
    add_rejection(out, "(no such id)", cause_name(cause), nameless[cause]);
  }
}

// The name of a source by its number; empty for none. The sample begins as zeros.
void copy_name(const LoopStatistics& statistics, std::uint32_t source, char* out) {
  if (source < kMaxSources) statistics.sources[source].view().copy(out, kMaxSourceLength);
}

// The ages of moving objects; fixed ones have none, and none is missed of absent ones.
void fill_inputs(const Scene& scene, const LoopStatistics& statistics, clearance_msg_Health& out) {
  reserve_sequence(out.inputs,
                   std::min<std::size_t>(scene.objects.size(), clearance_msg_kMaxObjects));
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const Object& of = scene.objects[object];
    if (of.fixed || !of.is_read || statistics.ages[object].absent) continue;
    if (out.inputs._length == out.inputs._maximum) continue;
    clearance_msg_InputAge& entry = out.inputs._buffer[out.inputs._length++];
    entry.object = object;
    entry.name = dds_string_dup(scene.objects[object].name.c_str());
    const InputAge& age = statistics.ages[object];
    entry.age_ns = age.age_ns;
    entry.stale = age.stale || entry.age_ns < 0;
    entry.contradicted = age.contradicted;
    entry.follows_joints = age.follows_joints;
    copy_name(statistics, age.source, entry.source);
    copy_name(statistics, age.other_source, entry.other_source);
  }
}

void fill_joints(const Scene& scene, const LoopStatistics& statistics, clearance_msg_Health& out) {
  reserve_sequence(out.joints,
                   std::min<std::size_t>(scene.variables.size(), clearance_msg_kMaxJoints));
  for (std::uint32_t variable = 0; variable < scene.variables.size(); ++variable) {
    if (out.joints._length == out.joints._maximum) return;
    if (!scene.variables[variable].is_read) continue;
    clearance_msg_JointAge& entry = out.joints._buffer[out.joints._length++];
    entry.variable = variable;
    entry.name = dds_string_dup(scene.variables[variable].name.c_str());
    const InputAge& age = statistics.joint_ages[variable];
    entry.age_ns = age.age_ns;
    entry.stale = age.stale;
    entry.contradicted = age.contradicted;
    copy_name(statistics, age.source, entry.source);
    copy_name(statistics, age.other_source, entry.other_source);
  }
}

void add_note(const LoopStatistics& statistics, const InputAge& age, const std::string& input,
              clearance_msg_Health& out) {
  if (age.takeovers == 0 && !age.velocities_contradict) return;
  if (out.notes._length == out.notes._maximum) return;
  clearance_msg_InputNote& note = out.notes._buffer[out.notes._length++];
  note.input = dds_string_dup(input.c_str());
  note.takeovers = age.takeovers;
  note.velocities_contradict = age.velocities_contradict;
  copy_name(statistics, age.source, note.source);
  copy_name(statistics, age.former_source, note.former_source);
}

void fill_notes(const Scene& scene, const LoopStatistics& statistics, clearance_msg_Health& out) {
  const std::size_t inputs = scene.objects.size() + scene.variables.size();
  reserve_sequence(out.notes, std::min<std::size_t>(inputs, 4096));
  for (std::size_t object = 0; object < scene.objects.size(); ++object)
    add_note(statistics, statistics.ages[object], scene.objects[object].name, out);
  for (std::size_t joint = 0; joint < scene.variables.size(); ++joint) {
    add_note(statistics, statistics.joint_ages[joint], "joint " + scene.variables[joint].name, out);
  }
}

// One entry per source, and sums that include the sources of earlier times.
void fill_sources(const std::vector<SourceTally>& sources, const SourceTally& departed,
                  clearance_msg_Health& out) {
  out.batches = departed.batches;
  out.lost_batches = departed.lost;
  const std::int64_t now = SystemClock().monotonic_ns();
  reserve_sequence(out.sources, sources.size());
  for (const SourceTally& tally : sources) {
    clearance_msg_SourceHealth& entry = out.sources._buffer[out.sources._length++];
    tally.source.view().copy(entry.source, kMaxSourceLength);
    entry.batches = tally.batches;
    entry.lost_batches = tally.lost;
    entry.cut_poses = tally.cut_poses;
    entry.age_ns = std::max<std::int64_t>(0, now - tally.last_ns);
    out.batches += tally.batches;
    out.lost_batches += tally.lost;
  }
}

}  // namespace

// The sample is new each time, since its strings differ in length from second to second.
Sample<clearance_msg_Health> make_health(const Scene& scene, const LoopStatistics& statistics,
                                         const PoseReader& poses, std::uint64_t dropped_reports,
                                         const RecordingHealth& recording,
                                         const ResponseTimes* responses) {
  Sample<clearance_msg_Health> sample;
  sample->period_ns = LoopStatistics::kPeriodNs;
  sample->scene_revision = scene.revision;
  sample->dropped_reports = dropped_reports;
  sample->recording = dds_string_dup(recording.state().c_str());
  sample->recording_missing = recording.missing();
  sample->undecodable_samples = poses.undecodable();
  fill_loop(statistics, *sample);
  if (responses != nullptr) fill_responses(*responses, *sample);
  const std::vector<SensorStatus> sensors = poses.sensors();
  fill_rejections(scene, statistics, poses, sensors, *sample);
  fill_witnesses(scene, sensors, *sample);
  fill_inputs(scene, statistics, *sample);
  fill_joints(scene, statistics, *sample);
  fill_notes(scene, statistics, *sample);
  fill_sources(poses.tallies(), poses.departed(), *sample);
  return sample;
}

}  // namespace clearance
