// Encodes each batch when it comes and holds it until the report of the tick that used it. The file
// is thus in the order of use, which is what an exact replay needs.
#include "monitor/recording/recorder.hpp"

#include <algorithm>

#include "monitor/files/build_info.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// When this many batches wait, those that no report names (made for another scene) are written all
// the same.
constexpr std::size_t kMostWaiting = 4096;

// The source's stamp of a batch: its newest pose; joints have one in common.
std::int64_t stamp_of(const PoseBatch& batch, std::int64_t otherwise) {
  if (!batch.joints.empty()) return batch.joints.front().stamp_ns;
  const auto newest = std::ranges::max_element(batch.samples, {}, &PoseSample::stamp_ns);
  return newest == batch.samples.end() ? otherwise : newest->stamp_ns;
}

}  // namespace

// The catalogue comes first: it names the ids that every message after it uses.
Recorder::Recorder(const std::filesystem::path& file, const Cell& cell, std::int64_t now_ns,
                   const RecordingOptions& options)
    : scene_(cell.scene),
      options_(options),
      writer_(file, cell.topics, options),
      without_files_(writer_.attach(cell)),
      batch_(make_batch(clearance_msg_kMaxPoses)),
      distances_(make_distances(cell.scene)),
      separation_(make_separation(cell.scene)),
      gradients_(cell.scene),
      zones_(cell.scene.zones.size()),
      last_ns_(now_ns) {
  writer_.catalogue(*make_catalogue(cell), now_ns, kBuild);
}

// Encoded now, written with the report that names it: only then is it known that a tick used it.
void Recorder::poses(const PoseBatch& batch) {
  const bool of_joints = !batch.joints.empty();
  if (!of_joints) to_wire(batch, *batch_);
  const std::span<const std::byte> cdr =
      of_joints ? encoder_.encode(*make_joint_states(batch, scene_)) : encoder_.encode(*batch_);
  waiting_.push_back({of_joints ? TopicKind::kJointStates : TopicKind::kPoses, batch.source,
                      batch.sequence_number, stamp_of(batch, last_ns_),
                      std::vector<std::byte>(cdr.begin(), cdr.end())});
}

// Inputs stand in front of the report that they led to, in the order of use. A file ends behind the
// zones of a report, and the next one begins with the state of every zone.
void Recorder::report(const Report& report, std::span<const SourceUse> sources,
                      std::int64_t publish_ns) {
  last_ns_ = report.now_ns;
  write_used(sources, report.now_ns);
  if (!report.separated_zones.empty()) write_separation(report, publish_ns);
  if (writer_.holds(TopicKind::kDistances)) {
    to_wire(report, sources, publish_ns, *distances_);
    if (!keeps_pairs(options_, report.cycle)) distances_->pairs._length = 0;
    writer_.write(TopicKind::kDistances, report.now_ns, report.now_ns, *distances_);
  }
  if (scene_.gradients && keeps_pairs(options_, report.cycle)) {
    writer_.write(TopicKind::kGradients, report.now_ns, report.now_ns,
                  gradients_.of(report, publish_ns));
  }
  write_zones(report);
  if (writer_.roll(report.now_ns)) zones_ = WrittenZones(scene_.zones.size());
}

// Batches may already wait that belong to later ticks: all up to the last one that this tick names.
void Recorder::write_used(std::span<const SourceUse> sources, std::int64_t log_ns) {
  const auto named = [sources](const Waiting& batch) {
    return std::ranges::any_of(sources, [&batch](const SourceUse& use) {
      return use.source == batch.source && use.sequence_number == batch.sequence_number;
    });
  };
  const auto last = std::find_if(waiting_.rbegin(), waiting_.rend(), named);
  write_waiting(static_cast<std::size_t>(waiting_.rend() - last), log_ns);
  if (waiting_.size() > kMostWaiting) write_waiting(waiting_.size(), log_ns);
}

// The first `count` batches, stamped with the log time of the report that used them.
void Recorder::write_waiting(std::size_t count, std::int64_t log_ns) {
  for (std::size_t i = 0; i < count; ++i) {
    writer_.write(waiting_[i].kind, log_ns, waiting_[i].stamp_ns,
                  std::span<const std::byte>(waiting_[i].cdr));
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
}

// The message stands in front of the distances, so that a reader of these has it already. It is
// thinned out like them.
void Recorder::write_separation(const Report& report, std::int64_t publish_ns) {
  if (!writer_.holds(TopicKind::kSeparation)) return;
  to_wire(report, publish_ns, *separation_);
  if (!keeps_pairs(options_, report.cycle)) separation_->pairs._length = 0;
  writer_.write(TopicKind::kSeparation, report.now_ns, report.now_ns, *separation_);
}

// Writes each zone at the start, then its changes, as the daemon does on DDS.
void Recorder::write_zones(const Report& report) {
  for (std::uint32_t zone = 0; zone < scene_.zones.size(); ++zone) {
    const bool active = report.zones[zone].active;
    if (zones_.is(zone, active)) continue;
    zones_.set(zone, active);
    clearance_msg_ZoneState state{};
    to_wire(scene_, report, zone, state);
    writer_.write(TopicKind::kZones, report.now_ns, report.now_ns, state);
  }
}

// Stamped no earlier than the last report, so that log times do not go back.
void Recorder::health(const clearance_msg_Health& health) {
  writer_.write(TopicKind::kHealth, std::max(last_ns_, health.now_ns), health.now_ns, health);
}

// Batches that no report has named yet are written as well: they did arrive.
bool Recorder::close() {
  write_waiting(waiting_.size(), last_ns_);
  return writer_.close();
}

}  // namespace clearance
