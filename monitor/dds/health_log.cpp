// The counts of a sample only grow: their growth is logged, so that the log says when something
// began.
#include "monitor/dds/health_log.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clearance {
namespace {

// Lines of one update; beyond them it logs only how many it left out.
constexpr int kLinesAtOnce = 5;

// Why the object's pairs are stale.
void log_stale(const clearance_msg_InputAge& input) {
  if (input.contradicted) {
    spdlog::warn("poses of {} contradict each other or the cell: its pairs are unknown",
                 input.name);
  } else {
    spdlog::warn("the last pose of {} that could be used is {} ms old: its pairs are stale",
                 input.name, input.age_ns / 1'000'000);
  }
}

// A joint is "joint NAME" in the list of refusals.
std::string samples_of(const std::string& input) {
  return (input.starts_with("joint ") ? "positions of " : "poses of ") + input;
}

// One line for what grew, naming by how much.
void log_growth(const char* what, std::uint64_t now, std::uint64_t& before) {
  if (now > before)
    spdlog::warn("{} {} in the last second, {} since the start", now - before, what, now);
  before = now;
}

}  // namespace

// No object has been seen at the start, so no object is late.
HealthLog::HealthLog(const Scene& scene)
    : stale_(scene.objects.size()), other_source_(scene.objects.size()), joints_(scene) {}

// The offset tells by how much, all steps together.
void HealthLog::log_clock(const clearance_msg_Health& health) {
  if (health.clock_steps > clock_steps_) {
    spdlog::warn(
        "this machine's clock was stepped by {:+.3f} s: ages go on by one that was not; sources of "
        "this machine are late for half a second, sources of others keep their relation to it",
        1e-9 * static_cast<double>(health.clock_offset_ns - clock_offset_ns_));
  }
  clock_steps_ = health.clock_steps;
  clock_offset_ns_ = health.clock_offset_ns;
}

// Refusals, then late inputs, then the totals. The limit on lines is for a cell that loses
// all its objects at once.
void HealthLog::update(const clearance_msg_Health& health,
                       const std::function<std::string()>& senders_of_joints) {
  int lines = 0;
  for (std::uint32_t i = 0; i < health.rejected._length; ++i) {
    const clearance_msg_RejectCount& entry = health.rejected._buffer[i];
    std::uint64_t& before = rejected_[fmt::format("{}: {}", entry.object, entry.cause)];
    if (entry.count > before && lines++ < kLinesAtOnce) {
      spdlog::warn("{} {} refused in the last second: {} ({} since the start)",
                   entry.count - before, samples_of(entry.object), entry.cause, entry.count);
    }
    before = entry.count;
  }
  for (std::uint32_t i = 0; i < health.inputs._length; ++i) {
    const clearance_msg_InputAge& input = health.inputs._buffer[i];
    // An object that was never seen is no news, nor is a link, whose joints are.
    const bool stale = input.stale && input.age_ns >= 0 && !input.follows_joints;
    if (stale != stale_[input.object] && lines++ < kLinesAtOnce) {
      if (stale) {
        log_stale(input);
      } else {
        spdlog::info("poses of {} are back", input.name);
      }
    }
    stale_[input.object] = stale;
    std::string& other = other_source_[input.object];
    if (other != input.other_source && lines++ < kLinesAtOnce) {
      spdlog::warn("{} is sent by '{}' and by '{}': poses of the latter are not used", input.name,
                   input.source, input.other_source);
    }
    other = input.other_source;
  }
  if (lines > kLinesAtOnce) {
    spdlog::warn("{} more refusals and late inputs left out", lines - kLinesAtOnce);
  }
  joints_.update(health.joints, senders_of_joints);
  log_clock(health);
  log_growth("batches lost", health.lost_batches, lost_);
  log_growth("samples that cannot be decoded", health.undecodable_samples, undecodable_);
  log_growth("reports of other daemons", health.foreign_reports, foreign_);
  log_growth("overruns", health.overruns, overruns_);
  log_growth("reports dropped", health.dropped_reports, dropped_);
}

}  // namespace clearance
