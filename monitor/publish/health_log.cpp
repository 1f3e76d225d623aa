// The counts of a sample only grow. The log tells their growth, which shows when a fault began.
#include "monitor/publish/health_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/interface/age_text.hpp"

namespace clearance {
namespace {

// The most lines of one update; it then logs how many it left out.
constexpr std::size_t kLinesAtOnce = 5;

constexpr int kFirstPauseS = 10, kLongestPauseS = 640;
constexpr int kOverS = 60;  // growth is new again after this time without any

// Logs by how much a count has grown.
template <class Growth, class... Noun>
void log_growth(const LogLine<lines::Text, lines::Count>& line, std::uint64_t now, Growth& growth,
                Noun... noun) {
  if (const std::uint64_t grown = growth.update(now)) log_line(line, counted(grown, noun...), now);
}

}  // namespace

std::uint64_t HealthLog::Growth::update(std::uint64_t now) noexcept {
  ++silent_s;
  quiet_s = now > before ? 0 : quiet_s + 1;
  before = now;
  if (quiet_s > kOverS && now == told) pause_s = 0;
  if (now <= told || silent_s < pause_s) return 0;
  silent_s = 0;
  pause_s = std::clamp(2 * pause_s, kFirstPauseS, kLongestPauseS);
  return now - std::exchange(told, now);
}

HealthLog::HealthLog(const Scene& scene) : joints_(scene) { note_sensors(scene); }

void HealthLog::note_sensors(const Scene& scene) {
  for (const Sensor& sensor : scene.sensors) poses_[sensor.name].is_of_sensor = true;
}

// Says that an input is late, and why; or that it is back.
void HealthLog::log_late(const clearance_msg_InputAge& input, const Poses& now) {
  const std::string age = age_text(input.age_ns);
  if (now.is_of_sensor && now.stale && input.contradicted) {
    log_line(lines::kFramesUnplaced, input.name);
  } else if (now.is_of_sensor && now.stale) {
    log_line(lines::kFramesLate, input.name, age);
  } else if (now.is_of_sensor) {
    log_line(lines::kFramesBack, input.name);
  } else if (!now.stale) {
    log_line(lines::kPosesBack, input.name);
  } else if (input.contradicted) {
    log_line(lines::kPosesContradict, input.name);
  } else {
    log_line(lines::kPosesLate, input.name, age);
  }
}

void HealthLog::change(const Scene& scene) {
  refusals_.begin_counts_anew();
  joints_.change(scene);
  std::set<std::string> inputs;
  for (const Object& object : scene.objects) inputs.insert(object.name);
  for (const JointVariable& variable : scene.variables) inputs.insert("joint " + variable.name);
  const auto is_gone = [&](const auto& entry) { return !inputs.contains(entry.first); };
  std::erase_if(poses_, is_gone);
  std::erase_if(notes_, is_gone);
  note_sensors(scene);
}

// The change of the offset is the sum of all steps.
void HealthLog::log_clock(const clearance_msg_Health& health) {
  if (health.clock_steps > clock_steps_) {
    log_line(lines::kClockStepped,
             1e-9 * static_cast<double>(health.clock_offset_ns - clock_offset_ns_));
  }
  clock_steps_ = health.clock_steps;
  clock_offset_ns_ = health.clock_offset_ns;
}

// One line when the response becomes too late, and one when it is not any more.
void HealthLog::log_response(const clearance_msg_Health& health) {
  const std::uint64_t ticks =
      health.late_responses - std::exchange(late_responses_, health.late_responses);
  const bool was_late = std::exchange(response_is_late_, ticks > 0);
  if (was_late == response_is_late_) return;
  if (was_late) return log_line(lines::kResponseBack);
  const bool is_known = health.responses._length > 0;
  log_line(lines::kResponseLate, counted(ticks, "tick"),
           is_known ? fmt::format("{}, {:.1f} ms", health.responses._buffer[0].input,
                                  1e-3 * health.responses._buffer[0].max_us)
                    : std::string("not known yet"));
}

// Inputs that change together share one line: all joints of a robot have the same source.
void HealthLog::log_notes(const clearance_msg_Health& health) {
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> changed;
  std::vector<std::string> velocities;
  for (std::uint32_t i = 0; i < health.notes._length; ++i) {
    const clearance_msg_InputNote& note = health.notes._buffer[i];
    Note& before = notes_[note.input];
    if (note.takeovers > before.takeovers)
      changed[{note.source, note.former_source}].emplace_back(note.input);
    before.takeovers = note.takeovers;
    if (note.velocities_contradict && !std::exchange(before.velocities_said, true))
      velocities.emplace_back(note.input);
  }
  for (const auto& [sources, inputs] : changed) {
    log_line(lines::kSourceChanged, listed(inputs, kNamesALine), sources.first, sources.second);
  }
  if (!velocities.empty()) log_line(lines::kVelocitiesContradict, listed(velocities, kNamesALine));
}

// Logs late inputs, then refusals, then the totals. The limit on lines is for a cell that loses all
// its objects at once.
void HealthLog::update(const clearance_msg_Health& health,
                       const std::function<std::string()>& senders_of_joints) {
  std::size_t logged = 0;
  for (std::uint32_t i = 0; i < health.inputs._length; ++i) {
    const clearance_msg_InputAge& input = health.inputs._buffer[i];
    // An object that was never known is no news, and one whose frame was let go is as late as
    // before. For links, the log of joints reports lateness.
    Poses& before = poses_[input.name];  // first without poses, which is not late
    const bool is_known = input.age_ns >= 0;
    const bool stale = !input.follows_joints && (is_known ? input.stale : before.stale);
    // A changed scene may state another age limit: then nothing has come back.
    const std::int64_t stamp_ns = less(health.now_ns, input.age_ns);
    if (std::exchange(before.stale, stale) != stale && (stale || stamp_ns > before.stamp_ns) &&
        logged++ < kLinesAtOnce)
      log_late(input, before);
    if (stale && is_known) before.stamp_ns = stamp_ns;
    if (*input.other_source != '\0' && before.other_source != input.other_source &&
        logged++ < kLinesAtOnce) {
      log_line(lines::kTwoSources, input.name, input.source, input.other_source);
    }
    before.other_source = input.other_source;
  }
  logged += refusals_.update(health, kLinesAtOnce - std::min(logged, kLinesAtOnce));
  if (logged > kLinesAtOnce)
    log_line(lines::kMoreLeftOut, counted(logged - kLinesAtOnce, "more line"));
  joints_.update(health.joints, senders_of_joints);
  log_notes(health);
  log_clock(health);
  log_response(health);
  log_growth(lines::kBatchesLost, health.lost_batches, lost_, "batch", "batches");
  log_growth(lines::kUndecodable, health.undecodable_samples, undecodable_, "sample");
  log_growth(lines::kOtherReports, health.foreign_reports, foreign_, "report");
  log_growth(lines::kOverruns, health.overruns, overruns_, "overrun");
  log_growth(lines::kReportsDropped, health.dropped_reports, dropped_, "report");
}

}  // namespace clearance
