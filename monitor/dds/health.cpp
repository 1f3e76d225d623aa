// make_health fills a sample from counts that only grow. HealthLog compares each sample with the
// one before and logs the growth, so that the log says when something began.
#include "monitor/dds/health.hpp"

#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string_view>

#include "monitor/loop/ports.hpp"

namespace clearance {
namespace {

// Units of the health topic are us.
constexpr double kUsPerNs = 1e-3;
// Lines of one update; beyond them it logs only how many it left out.
constexpr int kLinesAtOnce = 5;

// Times of the loop, as microseconds.
void fill_loop(const LoopStatistics& statistics, clearance_msg_Health& out) {
  out.cycle = statistics.cycle;
  out.now_ns = statistics.now_ns;
  out.tick_p50_us = kUsPerNs * static_cast<double>(statistics.tick.percentile_ns(0.5));
  out.tick_p999_us = kUsPerNs * static_cast<double>(statistics.tick.percentile_ns(0.999));
  out.tick_max_us = kUsPerNs * static_cast<double>(statistics.tick.max_ns());
  out.wakeup_p50_us = kUsPerNs * static_cast<double>(statistics.wakeup.percentile_ns(0.5));
  out.wakeup_p999_us = kUsPerNs * static_cast<double>(statistics.wakeup.percentile_ns(0.999));
  out.wakeup_max_us = kUsPerNs * static_cast<double>(statistics.wakeup.max_ns());
  out.tick_second_max_us = kUsPerNs * static_cast<double>(statistics.tick_second_max_ns);
  out.wakeup_second_max_us = kUsPerNs * static_cast<double>(statistics.wakeup_second_max_ns);
  out.clock_steps = statistics.clock_steps;
  out.clock_offset_ns = statistics.clock_offset_ns;
  out.overruns = statistics.overruns;
  out.skipped_cycles = statistics.skipped_cycles;
}

// Only causes that occurred are listed; the sequence was sized for all of them.
void add_rejection(clearance_msg_Health& out, const std::string& object, const char* cause,
                   std::uint64_t count) {
  if (count == 0 || out.rejected._length == out.rejected._maximum) return;
  clearance_msg_RejectCount& entry = out.rejected._buffer[out.rejected._length++];
  entry.object = dds_string_dup(object.c_str());
  entry.cause = dds_string_dup(cause);
  entry.count = count;
}

// As in Reject, spelt for people.
const char* cause_name(std::size_t cause) { return name(static_cast<Reject>(cause)); }

// By source, by object and, for ids that no object has, by cause alone: what the totals hold beyond
// the objects' counts.
void fill_rejections(const Scene& scene, const LoopStatistics& statistics, const PoseReader& poses,
                     clearance_msg_Health& out) {
  const std::vector<RefusedSource> refused = poses.refused_sources();
  const std::size_t most = 1 + refused.size() + (scene.objects.size() + 1) * kRejects;
  reserve_sequence(out.rejected, std::min<std::size_t>(most, 4096));
  for (const RefusedSource& source : refused) {
    const std::string_view of = source.source.view();
    add_rejection(out, of.empty() ? "other sources" : fmt::format("source '{}'", of),
                  name(source.cause), source.poses);
  }
  add_rejection(out, "sources", "batches of a writer with too many names", poses.refused_names());
  std::array<std::uint64_t, kRejects> nameless = statistics.rejected_total;
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    for (std::size_t cause = 0; cause < kRejects; ++cause) {
      const std::uint64_t count = statistics.rejected[object][cause];
      nameless[cause] -= std::min(count, nameless[cause]);
      add_rejection(out, scene.objects[object].name, cause_name(cause), count);
    }
  }
  for (std::size_t cause = 0; cause < kRejects; ++cause) {
    add_rejection(out, "(no such id)", cause_name(cause), nameless[cause]);
  }
}

// Of a source by its number; nothing for none. The sample begins as zeros.
void copy_name(const LoopStatistics& statistics, std::uint32_t source, char* out) {
  if (source < kMaxSources) statistics.sources[source].view().copy(out, kMaxSourceLength);
}

// Ages of the moving objects; fixed ones have none.
void fill_inputs(const Scene& scene, const LoopStatistics& statistics, clearance_msg_Health& out) {
  reserve_sequence(out.inputs,
                   std::min<std::size_t>(scene.objects.size(), clearance_msg_kMaxObjects));
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    if (scene.objects[object].fixed || out.inputs._length == out.inputs._maximum) continue;
    clearance_msg_InputAge& entry = out.inputs._buffer[out.inputs._length++];
    entry.object = object;
    entry.name = dds_string_dup(scene.objects[object].name.c_str());
    const InputAge& age = statistics.ages[object];
    entry.age_ns = age.age_ns;
    entry.stale = age.stale || entry.age_ns < 0;
    entry.contradicted = age.contradicted;
    copy_name(statistics, age.source, entry.source);
    copy_name(statistics, age.other_source, entry.other_source);
  }
}

// One entry a source, and the sums of these and of those that were heard before.
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

// One line for what grew, naming by how much.
void log_growth(const char* what, std::uint64_t now, std::uint64_t& before) {
  if (now > before)
    spdlog::warn("{} {} in the last second, {} since the start", now - before, what, now);
  before = now;
}

}  // namespace

// A new sample each time: its strings differ in length from second to second.
Sample<clearance_msg_Health> make_health(const Scene& scene, const LoopStatistics& statistics,
                                         const PoseReader& poses, std::uint64_t dropped_reports,
                                         const RecordingHealth& recording) {
  Sample<clearance_msg_Health> sample;
  sample->scene_revision = scene.revision;
  sample->dropped_reports = dropped_reports;
  sample->recording = dds_string_dup(recording.state().c_str());
  sample->recording_missing = recording.missing();
  sample->undecodable_samples = poses.undecodable();
  fill_loop(statistics, *sample);
  fill_rejections(scene, statistics, poses, *sample);
  fill_inputs(scene, statistics, *sample);
  fill_sources(poses.tallies(), poses.departed(), *sample);
  return sample;
}

// No object has been seen at the start, so no object is late.
HealthLog::HealthLog(const Scene& scene)
    : stale_(scene.objects.size()), other_source_(scene.objects.size()) {}

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
void HealthLog::update(const clearance_msg_Health& health) {
  int lines = 0;
  for (std::uint32_t i = 0; i < health.rejected._length; ++i) {
    const clearance_msg_RejectCount& entry = health.rejected._buffer[i];
    std::uint64_t& before = rejected_[fmt::format("{}: {}", entry.object, entry.cause)];
    if (entry.count > before && lines++ < kLinesAtOnce) {
      spdlog::warn("{} poses of {} refused in the last second: {} ({} since the start)",
                   entry.count - before, entry.object, entry.cause, entry.count);
    }
    before = entry.count;
  }
  for (std::uint32_t i = 0; i < health.inputs._length; ++i) {
    const clearance_msg_InputAge& input = health.inputs._buffer[i];
    // An object that was never seen is no news.
    const bool stale = input.stale && input.age_ns >= 0;
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
  log_clock(health);
  log_growth("batches lost", health.lost_batches, lost_);
  log_growth("samples that cannot be decoded", health.undecodable_samples, undecodable_);
  log_growth("reports of other daemons", health.foreign_reports, foreign_);
  log_growth("overruns", health.overruns, overruns_);
  log_growth("reports dropped", health.dropped_reports, dropped_);
}

}  // namespace clearance
