// A thread waits for data, takes samples and puts them into the ring as batches. Whatever can be
// slow or allocate (new sources, logging) happens in that thread, behind a mutex that the tick
// thread never takes.
#include "monitor/dds/pose_reader.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "monitor/loop/realtime.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// A writer with other QoS is silent for us, which nobody would notice without this line.
void log_incompatible(dds_entity_t, const dds_requested_incompatible_qos_status_t status, void*) {
  if (status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID) return;  // somebody else's cell
  spdlog::warn(
      "a writer of the poses topic offers QoS that does not fit (policy {}): it is not heard. "
      "Policy 11: it "
      "must be reliable; 24: another type; idl/README.md has the whole contract",
      status.last_policy_id);
}

// Cyclone calls this in a thread of its own.
void log_matched(dds_entity_t, const dds_subscription_matched_status_t status, void*) {
  spdlog::info("a writer of poses {}: {} now",
               status.current_count_change > 0 ? "appeared" : "left", status.current_count);
}

// The listener is copied by Cyclone, so ours is deleted at once.
dds_entity_t make_reader(const Scene& scene, Participant& participant) {
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_requested_incompatible_qos(listener, log_incompatible);
  dds_lset_subscription_matched(listener, log_matched);
  const dds_entity_t reader =
      participant.reader(TopicKind::kPoses, scene.topics.poses, PoseReader::kDepth, listener);
  dds_delete_listener(listener);
  return reader;
}

}  // namespace

std::size_t PoseReader::samples_a_batch(const Scene& scene) noexcept {
  // Several poses of one object in a batch are fine: a sensor may be faster than its sender.
  return std::min<std::size_t>(2 * scene.objects.size() + 64, clearance_msg_kMaxPoses);
}

// All memory is reserved before the thread starts; only a source that sends for the first time
// allocates later.
PoseReader::PoseReader(const Scene& scene, Participant& participant)
    : scene_(scene),
      samples_a_batch_(samples_a_batch(scene)),
      reader_(make_reader(scene, participant)),
      wait_(participant, {reader_}),
      ring_(kBatches) {
  for (auto& sample : taken_) reserve_sequence(sample->poses, samples_a_batch_);
  ring_.prepare([this](PoseBatch& slot) { slot.samples.resize(samples_a_batch_); });
  tallies_.reserve(kMaxSources);
  refused_.reserve(kMaxSources + 1);
  thread_ = std::thread([this] { run(); });
}

// Ends the thread before the ring is destroyed.
PoseReader::~PoseReader() {
  stop_ = true;
  wait_.wake();
  thread_.join();
}

// The slot lent by the last call is given back by this one. No lock: the ring has one filler and
// one emptier.
const PoseBatch* PoseReader::next() noexcept {
  if (lent_) ring_.pop();
  const PoseBatch* batch = ring_.front();
  lent_ = batch != nullptr;
  return batch;
}

// A copy, since the taking thread goes on changing them.
std::vector<SourceTally> PoseReader::tallies() const {
  const std::lock_guard lock(tallies_mutex_);
  return tallies_;
}

std::vector<RefusedSource> PoseReader::refused_sources() const {
  const std::lock_guard lock(tallies_mutex_);
  return refused_;
}

// Waits for data or for the destructor.
void PoseReader::run() {
  name_thread("poses");
  while (!stop_) {
    if (wait_.wait(DDS_INFINITY)) take_all();
  }
}

// Takes until nothing is left, into samples that are reused: no allocation for batches that fit.
void PoseReader::take_all() {
  std::array<void*, kDepth> pointers;
  std::array<dds_sample_info_t, kDepth> infos;
  for (std::size_t i = 0; i < kDepth; ++i) pointers[i] = &*taken_[i];
  for (;;) {
    const dds_return_t count = dds_take(reader_, pointers.data(), infos.data(), kDepth, kDepth);
    if (count < 0) spdlog::error("taking poses failed: {}", dds_strretcode(count));
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) hand_over(*taken_[i]);
    }
  }
}

// Null: one source too many.
SourceTally* PoseReader::tally_of(const SourceName& source) {
  const auto found = std::find_if(tallies_.begin(), tallies_.end(),
                                  [&](const SourceTally& tally) { return tally.source == source; });
  if (found != tallies_.end()) return &*found;
  if (tallies_.size() == kMaxSources) return nullptr;
  spdlog::info("poses from source '{}'", source.view());
  return &tallies_.emplace_back(SourceTally{.source = source});
}

// The first sources beyond the limit are named, all others counted together.
void PoseReader::refuse(const SourceName& source, std::uint64_t poses) {
  auto entry = std::ranges::find(refused_, source, &RefusedSource::source);
  if (entry == refused_.end()) {
    const bool named = refused_.size() < kMaxSources;
    if (named) {
      spdlog::warn("source '{}' is one too many: {} sources are heard, its poses are not used",
                   source.view(), kMaxSources);
    }
    if (refused_.size() <= kMaxSources) refused_.push_back({named ? source : SourceName(), 0});
    entry = refused_.end() - 1;
  }
  entry->poses += poses;
}

// Counts what is missing, converts into a free slot, and hands it to the tick thread.
void PoseReader::hand_over(clearance_msg_PoseBatch& batch) {
  const std::lock_guard lock(tallies_mutex_);
  SourceTally* tally = tally_of(SourceName(batch.source));
  if (tally == nullptr) {
    refuse(SourceName(batch.source), batch.poses._length);
    return;
  }
  // A smaller number is a source that started again.
  if (tally->last_ns != 0 && batch.sequence_number > tally->last_sequence + 1) {
    tally->lost += batch.sequence_number - tally->last_sequence - 1;
  }
  tally->last_sequence = batch.sequence_number;
  tally->last_ns = dds_time();

  PoseBatch* slot = ring_.back();
  if (slot == nullptr) {
    ++tally->lost;
    return;
  }
  if (batch.poses._length > samples_a_batch_) {
    tally->cut_poses += batch.poses._length - samples_a_batch_;
    batch.poses._length = static_cast<std::uint32_t>(samples_a_batch_);
  }
  from_wire(batch, *slot);
  if (!made_for(*slot, scene_.revision) && !std::exchange(tally->warned_of_revision, true)) {
    spdlog::warn(
        "source '{}' sends poses for scene revision {:016x}, this cell's is {:016x}: not used",
        tally->source.view(), batch.scene_revision, scene_.revision);
  }
  ++tally->batches;
  ring_.push();
}

}  // namespace clearance
