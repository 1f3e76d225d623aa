// A thread waits for data, takes samples and puts them into the ring as batches. Whatever can be
// slow or allocate (new sources, logging) happens in that thread, behind a mutex that the tick
// thread never takes.
#include "monitor/dds/pose_reader.hpp"

#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "monitor/dds/dds_log.hpp"
#include "monitor/inputs/source_numbers.hpp"
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

// What a ROS 2 node started from the same shell would join.
std::string ros_domain() {
  const char* const id = std::getenv("ROS_DOMAIN_ID");
  return id == nullptr ? "" : fmt::format(" (ROS_DOMAIN_ID is {} here)", id);
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
      where_(participant.where()),
      present_(participant),
      ros_joints_(scene, participant),
      ros_transforms_(scene, participant, present_),
      wait_(participant, readers()),
      joint_names_(scene),
      ring_(kBatches),
      sources_(named_sources(scene)),
      slow_log_(scene) {
  for (auto& sample : taken_) reserve_sequence(sample->poses, samples_a_batch_);
  ring_.prepare([&](PoseBatch& slot) {
    slot.samples.resize(samples_a_batch_);
    slot.joints.resize(joints_a_batch(scene));
  });
  thread_ = std::thread([this] { run(); });
}

// A cell without robots and frames has no use for what ROS 2 says.
bool PoseReader::hears_ros() const noexcept { return joint_reader_ != 0 || ros_transforms_.any(); }

std::vector<dds_entity_t> PoseReader::readers() const {
  std::vector<dds_entity_t> readers = ros_transforms_.readers();
  readers.push_back(reader_);
  if (joint_reader_ != 0) readers.push_back(joint_reader_);
  if (hears_ros()) readers.push_back(present_.reader());
  return readers;
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

std::string PoseReader::senders_of_joints() const {
  const std::lock_guard lock(tallies_mutex_);
  const std::size_t own = joint_reader_ == 0 ? 0 : writers_of(joint_reader_).size();
  const std::size_t heard = own + ros_joints_.writers();
  if (heard > 0) {
    std::string unknown;
    for (const std::string& name : ros_joints_.unknown_names()) {
      unknown += (unknown.empty() ? "" : ", ") + name;
    }
    return fmt::format(
        "{} publishers of joint states are heard{}", heard,
        unknown.empty() ? "" : ", of joints that the cell does not have: " + unknown);
  }
  for (const auto& [handle, writer] : present_.writers()) {
    if (writer.type != kRosJointState.descriptor->m_typename) continue;
    return fmt::format("{} is published in {} and does not reach {}", writer.topic,
                       writer.partition.empty() ? "the default partition"
                                                : fmt::format("partition {}", writer.partition),
                       where_);
  }
  return fmt::format(
      "there is no publisher of {} or of rt/joint_states (any namespace) on {}; there is: {}. "
      "Nothing is heard across domains{}, networks (--interface) or from an rmw that is no DDS "
      "(rmw_zenoh)",
      scene_.topics.joint_states, where_, present_.listed(), ros_domain());
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

// Waits for data, for the time at which frames want to be looked at, or for the destructor.
void PoseReader::run() {
  name_thread("poses");
  while (!stop_) {
    if (wait_.wait(ros_transforms_.patience_ns())) {
      take_all(reader_, taken_);
      if (joint_reader_ != 0) take_all(joint_reader_, taken_joints_);
    }
    if (hears_ros()) take_from_ros();
  }
}

void PoseReader::take_from_ros() {
  bool changed = false;
  {
    const std::lock_guard lock(tallies_mutex_);
    changed = present_.look();
    if (changed) ros_transforms_.look();
    if (changed && joint_reader_ != 0) ros_joints_.look(present_, wait_);
  }
  if (changed) note_writers();
  const std::lock_guard lock(tallies_mutex_);
  ros_joints_.take_all([this](const RosStates& states) { hand_over(states); });
  if (!ros_transforms_.any()) return;
  ros_transforms_.take_all([this](const PoseBatch& batch) { hand_over(batch); });
}

// Names and places of writers that have left are free.
void PoseReader::note_writers() {
  std::vector<std::uint64_t> writers = writers_of(reader_);
  if (joint_reader_ != 0) {
    const std::vector<std::uint64_t> of_joints = writers_of(joint_reader_);
    writers.insert(writers.end(), of_joints.begin(), of_joints.end());
  }
  for (const auto& [handle, writer] : present_.writers()) writers.push_back(handle);
  writers.push_back(RosTransforms::kWriter);
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
  if (made_for(*slot, scene_.revision)) slow_log_.note(*slot);
  ++tally->batches;
  ring_.push();
}

// The same of what is no sample of the poses topic; more names than a cell has any use for are cut.
template <class Fill>
void PoseReader::hand_over_filled(SourceTally& tally, const Fill& fill) {
  PoseBatch* slot = ring_.back();
  if (slot == nullptr) {
    ++tally.lost;
    return;
  }
  fill(*slot);
  if (const std::size_t most = joints_a_batch(scene_); slot->joints.size() > most) {
    tally.cut_poses += slot->joints.size() - most;
    slot->joints.resize(most);
  }
  slow_log_.note(*slot);
  ++tally.batches;
  ring_.push();
}

void PoseReader::hand_over(clearance_msg_JointStates& states, std::uint64_t writer) {
  const std::lock_guard lock(tallies_mutex_);
  SourceTally* tally = admit(joint_reader_, SourceName(states.source), states.sequence_number,
                             states.names._length, writer);
  if (tally == nullptr) return;
  hand_over_filled(*tally, [&](PoseBatch& slot) { from_wire(states, joint_names_, slot); });
}

// The lock is held.
void PoseReader::hand_over(const RosStates& states) {
  SourceTally* tally = admit(states.reader, states.source, states.number,
                             states.message.name._length, states.writer);
  if (tally == nullptr) return;
  hand_over_filled(*tally, [&](PoseBatch& slot) {
    from_wire(states.message, states.names, states.stamp_ns, slot);
    slot.source = states.source;
    slot.sequence_number = states.number;
  });
}

// The lock is held. Fewer than objects and variables, so it fits.
void PoseReader::hand_over(const PoseBatch& of_frames) {
  SourceTally* tally = admit(reader_, of_frames.source, of_frames.sequence_number, of_frames.size(),
                             RosTransforms::kWriter);
  if (tally == nullptr) return;
  hand_over_filled(*tally, [&](PoseBatch& slot) { slot = of_frames; });
}

}  // namespace clearance
