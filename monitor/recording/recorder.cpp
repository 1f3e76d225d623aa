// Encodes each batch when it comes and holds it until the report of the tick that used it. The file
// is thus in the order of use, which is what an exact replay needs.
#include "monitor/recording/recorder.hpp"

#include <algorithm>
#include <utility>

#include "config/text/fnv1a.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/scene_ids.hpp"
#include "monitor/recording/event_files.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// When this many batches wait, those that no report names (made for another scene) are written all
// the same.
constexpr std::size_t kMostWaiting = 4096;
// A simulation began anew if the time goes back by more than this, ns.
constexpr std::int64_t kOtherRunNs = 1'000'000;

// The source's stamp of a batch: its newest pose; joints have one in common.
std::int64_t stamp_of(const PoseBatch& batch, std::int64_t otherwise) {
  if (!batch.joints.empty()) return batch.joints.front().stamp_ns;
  const auto newest = std::ranges::max_element(batch.samples, {}, &PoseSample::stamp_ns);
  return newest == batch.samples.end() ? otherwise : newest->stamp_ns;
}

std::unique_ptr<RecordingSink> sink_of(const std::filesystem::path& file, const Topics& topics,
                                       const RecordingOptions& options) {
  if (options.events.any()) return std::make_unique<EventFiles>(file, topics, options);
  return std::make_unique<ContinuousFiles>(file, topics, options);
}

// Equal for batches with the same objects or joints.
std::uint64_t content_of(const PoseBatch& batch) {
  Fnv1a hash;
  for (const PoseSample& sample : batch.samples) hash.add(sample.object);
  for (const JointSample& sample : batch.joints) hash.add(sample.variable);
  return hash.value();
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
      sink_(sink_of(file, cell.topics, options)),
      batch_(make_batch(clearance_msg_kMaxPoses)),
      last_ns_(now_ns),
      watch_(options.events.around_ns) {
  begin_scene(cell, *make_catalogue(cell));
}

// The state of every zone follows with the next report, since its id may be another one.
void Recorder::change(const Cell& cell, const SceneInForce& since) {
  const bool is_other = cell.scene.revision != now_->scene.revision;
  begin_scene(cell, *make_catalogue(cell, since));
  if (!is_other) return;
  watch_.change();
  asked_ = {RecordedEvent::Cause::kCommand, "the cell has changed"};
}

void Recorder::begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue) {
  without_files_ = sink_->begin_scene(cell, catalogue, last_ns_);
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
                      std::vector<std::byte>(cdr.begin(), cdr.end()),
                      options_.ticks_every > 1 ? content_of(batch) : 0});
}

// The last one of several in front of one report counts.
void Recorder::joined(std::span<const std::byte> cdr) {
  std::erase_if(sides_, [](const auto& side) { return side.topic == SideTopic::kStates; });
  sides_.push_back({SideTopic::kStates, last_ns_, {cdr.begin(), cdr.end()}});
}

// Inputs stand in front of the report that they led to, in the order of use. A file ends behind the
// zones of a report, and the next one begins with the state of every zone.
void Recorder::report(const Report& report, std::span<const SourceUse> sources,
                      std::int64_t publish_ns, std::uint64_t lineage) {
  // Ticks of a partner that catches up have earlier times, too; partners follow no simulation.
  const std::int64_t back_ns = elapsed(report.now_ns, std::exchange(last_ns_, report.now_ns));
  if (lineage == 0 && back_ns > kOtherRunNs) {
    sink_->begin_anew(report.now_ns);
    watch_.change();
    states_all_zones_ = true;
  }
  const bool is_kept = options_.ticks_every <= 1 || report.cycle % options_.ticks_every == 0;
  if (options_.ticks_every > 1) sources = thin_out(sources, is_kept);
  if (is_kept) write_report(report, sources, publish_ns, lineage);
  write_zones(report);
  if (is_kept) thin_uses_.clear();
  states_all_zones_ = sink_->end_tick(report.now_ns, event_of(report));
}

void Recorder::write_report(const Report& report, std::span<const SourceUse> sources,
                            std::int64_t publish_ns, std::uint64_t lineage) {
  write_used(sources, report.now_ns);
  for (const WaitingSide& side : std::exchange(sides_, {}))
    sink_->write(side.topic, report.now_ns, side.stamp_ns, side.cdr);
  if (!report.separated_zones.empty() || !report.stops.empty())
    write_separation(report, publish_ns);
  if (holds(TopicKind::kDistances)) {
    to_wire(report, sources, publish_ns, *now_->distances);
    now_->distances->lineage = lineage;
    if (!keeps_pairs(options_, report.cycle)) now_->distances->pairs._length = 0;
    write(TopicKind::kDistances, report.now_ns, report.now_ns, *now_->distances);
  }
  if (now_->scene.gradients && keeps_pairs(options_, report.cycle)) {
    write(TopicKind::kGradients, report.now_ns, report.now_ns,
          now_->gradients.of(report, publish_ns));
  }
}

std::optional<RecordedEvent> Recorder::event_of(const Report& report) {
  std::optional<RecordedEvent> event = watch_.find(report, now_->scene);
  if (asked_) event = std::exchange(asked_, std::nullopt);
  return event;
}

// Notes the last batch of each source since the last tick that was kept, and forgets those that a
// newer one of the same content replaces. Returns the noted ones.
std::span<const SourceUse> Recorder::thin_out(std::span<const SourceUse> sources, bool is_kept) {
  for (const SourceUse& use : sources) {
    const auto same = std::ranges::find(thin_uses_, use.source, &SourceUse::source);
    if (same == thin_uses_.end()) {
      thin_uses_.push_back(use);
    } else {
      same->sequence_number = use.sequence_number;
    }
  }
  const auto is_used = [this](const Waiting& batch) {
    return std::ranges::any_of(thin_uses_, [&batch](const SourceUse& use) {
      return use.source == batch.source && batch.sequence_number <= use.sequence_number;
    });
  };
  for (std::size_t i = waiting_.size(); i-- > 0;) {
    if (!is_used(waiting_[i])) continue;
    const auto replaces = [&](const Waiting& later) {
      return later.source == waiting_[i].source && later.kind == waiting_[i].kind &&
             later.of == waiting_[i].of && is_used(later);
    };
    const auto next = waiting_.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(next + 1, waiting_.end(), replaces)) waiting_.erase(next);
  }
  return is_kept ? std::span<const SourceUse>(thin_uses_) : std::span<const SourceUse>();
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
    sink_->write(waiting_[i].kind, log_ns, waiting_[i].stamp_ns, waiting_[i].cdr, false);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
}

// The message stands in front of the distances, so that a reader of these has it already. It is
// thinned out like them.
void Recorder::write_separation(const Report& report, std::int64_t publish_ns) {
  if (!holds(TopicKind::kSeparation)) return;
  to_wire(report, publish_ns, *now_->separation);
  if (!keeps_pairs(options_, report.cycle)) now_->separation->pairs._length = 0;
  write(TopicKind::kSeparation, report.now_ns, report.now_ns, *now_->separation);
}

// Writes each zone at the start, then its changes, as the daemon does on DDS.
void Recorder::write_zones(const Report& report) {
  for (std::uint32_t zone = 0; zone < now_->scene.zones.size(); ++zone) {
    const WrittenZone present = WrittenZone::of(report.zones[zone]);
    const bool repeated = now_->zones.last(zone) == present;
    if (repeated && !states_all_zones_) continue;
    now_->zones.set(zone, present);
    clearance_msg_ZoneState state{};
    to_wire(now_->scene, report, zone, state);
    write(TopicKind::kZones, report.now_ns, report.now_ns, state, repeated);
  }
}

// Stamped no earlier than the last report, so that log times do not go back.
void Recorder::health(const clearance_msg_Health& health) {
  write(TopicKind::kHealth, std::max(last_ns_, health.now_ns), health.now_ns, health);
}

// Batches that no report has named yet are written as well: they did arrive.
bool Recorder::close() {
  write_waiting(waiting_.size(), last_ns_);
  return sink_->close();
}

}  // namespace clearance
