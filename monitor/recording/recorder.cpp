// Encodes each batch when it comes and holds it until the report of the tick that used it. The file
// is thus in the order of use, which is what an exact replay needs.
#include "monitor/recording/recorder.hpp"

#include <algorithm>

#include "monitor/files/build_info.hpp"
#include "monitor/inputs/scene_ids.hpp"
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

Recorder::OfScene::OfScene(const Scene& the_scene)
    : scene(the_scene),
      distances(make_distances(scene)),
      separation(make_separation(scene)),
      gradients(scene),
      zones(scene.zones.size()) {}

// The catalogue comes first: it names the ids that every message after it uses.
Recorder::Recorder(const std::filesystem::path& file, const Cell& cell, std::int64_t now_ns,
                   const RecordingOptions& options)
    : options_(options),
      writer_(file, cell.topics, options),
      without_files_(writer_.attach(cell)),
      batch_(make_batch(clearance_msg_kMaxPoses)),
      now_(std::make_unique<OfScene>(cell.scene)),
      last_ns_(now_ns) {
  note_joint_names(cell.scene);
  writer_.catalogue(*make_catalogue(cell), now_ns, kBuild);
}

// The state of every zone follows with the next report, since its id may be another one.
void Recorder::change(const Cell& cell, const SceneInForce& since) {
  without_files_ = writer_.attach(cell);
  writer_.catalogue(*make_catalogue(cell, since), last_ns_, kBuild);
  now_ = std::make_unique<OfScene>(cell.scene);
  note_joint_names(cell.scene);
}

void Recorder::note_joint_names(const Scene& scene) {
  JointNamesOf& now = joint_names_.emplace_back();
  now.revision = scene.revision;
  for (const JointVariable& variable : scene.variables) now.names.push_back(variable.name);
  if (joint_names_.size() > SceneIds::kFormerScenes + 1) joint_names_.pop_front();
}

// The latest scene of a revision. A batch without one has the ids of the present scene.
std::span<const std::string> Recorder::joint_names(std::uint64_t revision) const {
  const auto found = std::ranges::find(joint_names_.rbegin(), joint_names_.rend(), revision,
                                       &JointNamesOf::revision);
  return found == joint_names_.rend() ? joint_names_.back().names : found->names;
}

// Encoded now, written with the report that names it: only then is it known that a tick used it.
void Recorder::poses(const PoseBatch& batch) {
  const bool of_joints = !batch.joints.empty();
  if (!of_joints) to_wire(batch, *batch_);
  const std::span<const std::byte> cdr =
      of_joints ? encoder_.encode(*make_joint_states(batch, joint_names(batch.scene_revision)))
                : encoder_.encode(*batch_);
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
    to_wire(report, sources, publish_ns, *now_->distances);
    if (!keeps_pairs(options_, report.cycle)) now_->distances->pairs._length = 0;
    writer_.write(TopicKind::kDistances, report.now_ns, report.now_ns, *now_->distances);
  }
  if (now_->scene.gradients && keeps_pairs(options_, report.cycle)) {
    writer_.write(TopicKind::kGradients, report.now_ns, report.now_ns,
                  now_->gradients.of(report, publish_ns));
  }
  write_zones(report);
  if (writer_.roll(report.now_ns)) now_->zones = WrittenZones(now_->scene.zones.size());
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
  to_wire(report, publish_ns, *now_->separation);
  if (!keeps_pairs(options_, report.cycle)) now_->separation->pairs._length = 0;
  writer_.write(TopicKind::kSeparation, report.now_ns, report.now_ns, *now_->separation);
}

// Writes each zone at the start, then its changes, as the daemon does on DDS.
void Recorder::write_zones(const Report& report) {
  for (std::uint32_t zone = 0; zone < now_->scene.zones.size(); ++zone) {
    const bool active = report.zones[zone].active;
    if (now_->zones.is(zone, active)) continue;
    now_->zones.set(zone, active);
    clearance_msg_ZoneState state{};
    to_wire(now_->scene, report, zone, state);
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
