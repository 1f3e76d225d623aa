// A thread waits for data, takes samples and puts them into the ring as batches. Whatever can be
// slow or allocate (new sources, logging) happens in that thread, behind a mutex that the tick
// thread never takes.
#include "monitor/dds/pose_reader.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "monitor/dds/dds_log.hpp"
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

// Cyclone calls this in a thread of its own. The flag makes the taking thread look who has left.
void log_matched(dds_entity_t, const dds_subscription_matched_status_t status, void* changed) {
  static_cast<std::atomic<bool>*>(changed)->store(true);
  spdlog::info("a writer of poses {}: {} now",
               status.current_count_change > 0 ? "appeared" : "left", status.current_count);
}

// Cyclone asks before it stores a sample, with the name's instance handle and no decoded sample.
bool admits(const dds_sample_info_t* info, void* names) {
  return static_cast<NameLimit*>(names)->admits(info->publication_handle, info->instance_handle,
                                                SystemClock().monotonic_ns());
}

void log_matched_joints(dds_entity_t, const dds_subscription_matched_status_t status,
                        void* changed) {
  static_cast<std::atomic<bool>*>(changed)->store(true);
  spdlog::info("a writer of joint states {}: {} now",
               status.current_count_change > 0 ? "appeared" : "left", status.current_count);
}

// What a person should know of a batch's source. Writers are named by their GUIDs.
void log_news(const Admission& admission, const SourceName& source, dds_entity_t reader,
              std::uint64_t writer) {
  const auto guid = [reader](std::uint64_t handle) {
    const WriterFacts facts = writer_facts(reader, handle);
    return facts.present ? facts.guid : std::string("that has left");
  };
  switch (admission.news) {
    case Admission::News::kNothing:
      return;
    case Admission::News::kNewSource:
      if (admission.place_of.view().empty()) {
        spdlog::info("poses from source '{}'", source.view());
      } else {
        spdlog::info("poses from source '{}', in the place of '{}'", source.view(),
                     admission.place_of.view());
      }
      return;
    case Admission::News::kTakenOver:
      spdlog::warn("source '{}' is now writer {}; before, it was writer {}", source.view(),
                   guid(writer), guid(admission.former_writer));
      return;
    case Admission::News::kFirstRefusal:
      if (admission.cause == SourceRefusal::kTooMany) {
        spdlog::warn("source '{}' is one too many: {} sources are heard, its poses are not used",
                     source.view(), kMaxSources);
      } else {
        spdlog::warn(
            "writer {} uses the name of source '{}', which is writer {}: its poses are not used",
            guid(writer), source.view(), guid(admission.former_writer));
      }
      return;
  }
}

// Once each; the reader of cells refuses more than there are places.
std::vector<SourceName> named_sources(const Scene& scene) {
  std::vector<SourceName> named;
  for (const Object& object : scene.objects) {
    const SourceName source(object.source);
    if (!object.source.empty() && std::ranges::find(named, source) == named.end())
      named.push_back(source);
  }
  return named;
}

}  // namespace

std::size_t PoseReader::samples_a_batch(const Scene& scene) noexcept {
  // Several poses of one object in a batch are fine: a sensor may be faster than its sender.
  return std::min<std::size_t>(2 * scene.objects.size() + 64, clearance_msg_kMaxPoses);
}

std::size_t PoseReader::joints_a_batch(const Scene& scene) noexcept {
  if (scene.robots.empty()) return 0;
  return std::min<std::size_t>(2 * scene.variables.size() + 64, clearance_msg_kMaxJoints);
}

// All memory is reserved before the thread starts; only a source that sends for the first time
// allocates later.
PoseReader::PoseReader(const Scene& scene, Participant& participant)
    : scene_(scene),
      samples_a_batch_(samples_a_batch(scene)),
      undecodable_before_(undecodable_samples()),
      reader_(make_reader(participant, TopicKind::kPoses)),
      joint_reader_(scene.robots.empty() ? 0 : make_reader(participant, TopicKind::kJointStates)),
      wait_(participant,
            joint_reader_ == 0 ? std::vector{reader_} : std::vector{reader_, joint_reader_}),
      joint_names_(scene),
      ring_(kBatches),
      sources_(named_sources(scene)),
      slow_poses_(scene) {
  for (auto& sample : taken_) reserve_sequence(sample->poses, samples_a_batch_);
  ring_.prepare([&](PoseBatch& slot) {
    slot.samples.resize(samples_a_batch_);
    slot.joints.resize(joints_a_batch(scene));
  });
  thread_ = std::thread([this] { run(); });
}

// The listener and the filter are copied by Cyclone; what they point to is here.
dds_entity_t PoseReader::make_reader(Participant& participant, TopicKind kind) {
  const bool of_joints = kind == TopicKind::kJointStates;
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_requested_incompatible_qos(listener, log_incompatible);
  dds_lset_subscription_matched_arg(listener, of_joints ? log_matched_joints : log_matched,
                                    &writers_changed_, true);
  const dds_topic_filter filter{
      .mode = DDS_TOPIC_FILTER_SAMPLEINFO_ARG, .f = {.sampleinfo_arg = admits}, .arg = &names_};
  const dds_entity_t reader =
      participant.reader(kind, scene_.topics.*topic(kind).name, kDepth, listener, &filter);
  dds_delete_listener(listener);
  return reader;
}

// Ends the thread before the ring is destroyed, and the reader before what its listener and filter
// point to.
PoseReader::~PoseReader() {
  stop_ = true;
  wait_.wake();
  thread_.join();
  dds_delete(reader_);
  if (joint_reader_ != 0) dds_delete(joint_reader_);
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
  return sources_.tallies();
}

std::vector<RefusedSource> PoseReader::refused_sources() const {
  const std::lock_guard lock(tallies_mutex_);
  return sources_.refused();
}

SourceTally PoseReader::departed() const {
  const std::lock_guard lock(tallies_mutex_);
  return sources_.departed();
}

std::uint64_t PoseReader::undecodable() const {
  return undecodable_samples() - undecodable_before_;
}

// Takes until nothing is left, into samples that are reused: no allocation for batches that fit,
// but for the names of joints.
template <class Taken>
void PoseReader::take_all(dds_entity_t reader, Taken& taken) {
  std::array<void*, kDepth> pointers;
  std::array<dds_sample_info_t, kDepth> infos;
  for (std::size_t i = 0; i < kDepth; ++i) pointers[i] = &*taken[i];
  for (;;) {
    const dds_return_t count = dds_take(reader, pointers.data(), infos.data(), kDepth, kDepth);
    if (count < 0) spdlog::error("taking poses failed: {}", dds_strretcode(count));
    if (count <= 0) return;
    if (writers_changed_.exchange(false)) note_writers();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) hand_over(*taken[i], infos[i].publication_handle);
      if (infos[i].instance_state != DDS_IST_ALIVE) names_.forget_name(infos[i].instance_handle);
    }
  }
}

// Waits for data or for the destructor.
void PoseReader::run() {
  name_thread("poses");
  while (!stop_) {
    if (!wait_.wait(DDS_INFINITY)) continue;
    take_all(reader_, taken_);
    if (joint_reader_ != 0) take_all(joint_reader_, taken_joints_);
  }
}

// Names and places of writers that have left are free.
void PoseReader::note_writers() {
  std::vector<std::uint64_t> writers = writers_of(reader_);
  if (joint_reader_ != 0) {
    const std::vector<std::uint64_t> of_joints = writers_of(joint_reader_);
    writers.insert(writers.end(), of_joints.begin(), of_joints.end());
  }
  names_.keep(writers);
  const std::lock_guard lock(tallies_mutex_);
  sources_.keep(writers);
}

// The log gets what is new.
SourceTally* PoseReader::admit(dds_entity_t reader, const SourceName& source,
                               std::uint64_t sequence_number, std::size_t count,
                               std::uint64_t writer) {
  const std::int64_t now_ns = SystemClock().monotonic_ns();
  const Admission admission = sources_.admit(source, writer, count, now_ns);
  log_news(admission, source, reader, writer);
  if (admission.tally == nullptr) return nullptr;
  admission.tally->note_sequence(sequence_number);
  admission.tally->last_ns = now_ns;
  return admission.tally;
}

void PoseReader::log_slow_poses(const PoseBatch& batch) {
  for (const PoseSample& sample : batch.samples) {
    const auto interval_ns = slow_poses_.note(sample.object, sample.stamp_ns);
    if (!interval_ns) continue;
    const Object& object = scene_.objects[sample.object];
    spdlog::warn(
        "poses of {} come every {} ms, its age limit is {} ms: it is late again and again, and its "
        "zones flicker; age_limit_ms of {} would fit",
        object.name, *interval_ns / 1'000'000, object.age_limit_ns / 1'000'000,
        fitting_age_limit_ms(*interval_ns));
  }
}

// Counts what is missing, converts into a free slot, and hands it to the tick thread.
void PoseReader::hand_over(clearance_msg_PoseBatch& batch, std::uint64_t writer) {
  const std::lock_guard lock(tallies_mutex_);
  SourceTally* tally =
      admit(reader_, SourceName(batch.source), batch.sequence_number, batch.poses._length, writer);
  if (tally == nullptr) return;
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
  if (made_for(*slot, scene_.revision)) log_slow_poses(*slot);
  ++tally->batches;
  ring_.push();
}

// The same of joint states; more names than a cell has any use for are cut.
void PoseReader::hand_over(clearance_msg_JointStates& states, std::uint64_t writer) {
  const std::lock_guard lock(tallies_mutex_);
  SourceTally* tally = admit(joint_reader_, SourceName(states.source), states.sequence_number,
                             states.names._length, writer);
  if (tally == nullptr) return;
  PoseBatch* slot = ring_.back();
  if (slot == nullptr) {
    ++tally->lost;
    return;
  }
  from_wire(states, joint_names_, *slot);
  if (const std::size_t most = joints_a_batch(scene_); slot->joints.size() > most) {
    tally->cut_poses += slot->joints.size() - most;
    slot->joints.resize(most);
  }
  ++tally->batches;
  ring_.push();
}

}  // namespace clearance
