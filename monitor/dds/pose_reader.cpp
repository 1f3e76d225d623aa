// A thread waits for data, takes samples and puts them into the ring as batches. Everything that
// may be slow or allocate (new sources, logging) happens in that thread. Its mutex is never taken
// by the tick thread.
#include "monitor/dds/pose_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/loop/batch_store.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/scene_capacity.hpp"

namespace clearance {
namespace {

std::string topic_of(dds_entity_t reader) {
  std::array<char, 128> name{"?"};
  dds_get_name(dds_get_topic(reader), name.data(), name.size());
  return name.data();
}

// This reader hears nothing of a writer with another type or other QoS. Only this line tells.
void log_incompatible(dds_entity_t reader, const dds_requested_incompatible_qos_status_t status,
                      void*) {
  if (status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID) return;  // another cell's writer
  if (status.last_policy_id == DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID) {
    log_line(lines::kOtherTypeWriter, topic_of(reader), kBuild);
  } else {
    log_line(lines::kIncompatibleWriter, topic_of(reader), status.last_policy_id);
  }
}

// Cyclone calls this in a thread of its own. The flag makes the taking thread check which writers
// have left.
void log_matched(dds_entity_t reader, const dds_subscription_matched_status_t status,
                 void* changed) {
  static_cast<std::atomic<bool>*>(changed)->store(true);
  log_line(status.current_count_change > 0 ? lines::kWriterAppeared : lines::kWriterLeft,
           topic_of(reader), status.current_count);
}

}  // namespace

std::size_t PoseReader::samples_a_batch(const Cell& cell) noexcept {
  // A batch may have several poses of one object: a sensor may be faster than its sender.
  return std::min<std::size_t>(2 * capacity_for(cell).objects + 64, clearance_msg_kMaxPoses);
}

std::size_t PoseReader::joints_a_batch(const Cell& cell) noexcept {
  if (cell.scene.variables.empty()) return 0;
  return std::min<std::size_t>(2 * capacity_for(cell).variables + 64, clearance_msg_kMaxJoints);
}

// Reserves all memory before the thread starts. Later, only what is heard for the first time
// allocates.
PoseReader::PoseReader(const Cell& cell, Participant& participant, MoveItMessages::Use use_scene,
                       SimulatedTime* time)
    : topics_(&cell.topics),
      undecodable_before_(undecodable_samples()),
      where_(participant.where()),
      partition_(participant.partition()),
      sensors_(cell.scene.sensors.empty()
                   ? nullptr
                   : std::make_unique<SensorReader>(cell, participant, time)),
      intake_(cell,
              {.admits_sources = true,
               .most_samples = samples_a_batch(cell),
               .most_joints = joints_a_batch(cell),
               .use_scene = std::move(use_scene),
               .time = time,
               .writer_name = [this](auto writer) REQUIRES(mutex_) { return guid_of(writer); }},
              [this](PoseBatch& batch) { return hand_over(batch); }),
      ros_(participant, intake_),
      wait_(participant, {}),
      ring_(kBatches) {
  open(participant, TopicKind::kPoses);
  if (!cell.scene.variables.empty()) open(participant, TopicKind::kJointStates);
  if (intake_.hears_ros()) wait_.add(ros_.present().reader());
  ros_.stand();
  ring_.prepare([&](PoseBatch& slot) {
    slot.samples.resize(samples_a_batch(cell));
    slot.joints.resize(joints_a_batch(cell));
  });
}

void PoseReader::start() {
  if (sensors_) sensors_->start();
  thread_ = std::thread([this] { run(); });
}

void PoseReader::change(const Cell& cell) {
  if (sensors_) sensors_->change(cell);
  const Lock lock(mutex_);
  topics_ = &cell.topics;
  intake_.change(cell);
  ros_.stand();
  wait_.wake();
}

// Cyclone copies the listener and the filter. The objects to which they point are members of this
// one.
void PoseReader::open(Participant& participant, TopicKind kind) {
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_requested_incompatible_qos(listener, log_incompatible);
  dds_lset_subscription_matched_arg(listener, log_matched, &writers_changed_, true);
  const dds_topic_filter filter = filter_of(names_);
  const dds_entity_t reader =
      participant.reader(kind, topics_->*topic(kind).name, 0, listener, &filter);
  dds_delete_listener(listener);
  own_.push_back({reader, intake_.topic(kind)->number});
  wait_.add(reader);
}

// Ends the thread before the ring is destroyed. Deletes the readers before the objects to which
// their listeners and filters point.
PoseReader::~PoseReader() {
  stop_ = true;
  wait_.wake();
  if (thread_.joinable()) thread_.join();
  for (const OwnReader& reader : own_) dds_delete(reader.handle);
}

// Gives back the slot that the last call lent. It needs no lock, because the ring has one producer
// and one consumer.
const PoseBatch* PoseReader::next() noexcept {
  if (lent_) ring_.pop();
  const PoseBatch* batch = ring_.front();
  lent_ = batch != nullptr;
  return batch;
}

// Returns a copy, because the taking thread continues to change the tallies.
std::vector<SourceTally> PoseReader::tallies() const {
  const Lock lock(mutex_);
  return intake_.sources().tallies();
}

std::vector<RefusedSource> PoseReader::refused_sources() const {
  const Lock lock(mutex_);
  return intake_.sources().refused();
}

SourceTally PoseReader::departed() const {
  const Lock lock(mutex_);
  return intake_.sources().departed();
}

std::uint64_t PoseReader::undecodable() const {
  return undecodable_samples() - undecodable_before_;
}

std::string PoseReader::senders_of_joints() const {
  const Lock lock(mutex_);
  const std::size_t own = own_.size() < 2 ? 0 : writers_of(own_.back().handle).size();
  const std::size_t heard = own + intake_.joint_states().writers();
  if (heard > 0) {
    const auto& names = intake_.joint_states().unknown_names();
    return fmt::format(
        "joint states come from {}{}{}", counted(heard, "publisher"),
        names.empty() ? "" : ", of joints that the cell does not have: ", fmt::join(names, ", "));
  }
  for (const auto& [handle, writer] : ros_.present().writers()) {
    if (writer.type != kRosJointState.descriptor->m_typename) continue;
    if (writer.partition == partition_ && !writer.topic.ends_with("/joint_states")) {
      return fmt::format(
          "{} has joint states, and is not read: expected {}, rt/joint_states in any "
          "namespace, or that a robot names its topic (joint_states)",
          writer.topic, topics_->joint_states);
    }
    return fmt::format("{} is published in {} and does not reach {}", writer.topic,
                       writer.partition.empty() ? "the default partition"
                                                : fmt::format("partition {}", writer.partition),
                       where_);
  }
  return fmt::format("there is no publisher of {} or of rt/joint_states (any namespace) {}",
                     topics_->joint_states, ros_.present().instead_on(where_));
}

// Waits for data, for the time at which the intake wants to settle, or for the destructor.
void PoseReader::run() {
  name_thread("poses");
  SystemClock clock;
  Lock lock(mutex_);
  while (!stop_) {
    const std::int64_t patience = intake_.patience_ns();
    lock.unlock();
    wait_.wait(patience);
    lock.lock();
    if (stop_) return;
    try {
      poll();
      take_all({.realtime_ns = clock.realtime_ns(), .monotonic_ns = clock.monotonic_ns()});
    } catch (const DdsError& error) {
      log_line(lines::kInputsFailed, error.what());
    }
    log_news();
  }
}

// Updates the topics that other programs publish, and the writers that still exist.
void PoseReader::poll() {
  const bool changed = intake_.hears_ros() && ros_.poll();
  if (writers_changed_.exchange(false) || changed) note_writers();
  const std::vector<RosReaders::Reader>& readers = ros_.readers();
  for (; waited_for_ < readers.size(); ++waited_for_) wait_.add(readers[waited_for_].handle);
}

// Frees the names and places of writers that have left.
void PoseReader::note_writers() {
  std::vector<std::uint64_t> writers = ros_.writers();
  for (const OwnReader& reader : own_) {
    const std::vector<std::uint64_t> heard = writers_of(reader.handle);
    writers.insert(writers.end(), heard.begin(), heard.end());
  }
  names_.keep(writers);
  intake_.keep(std::move(writers));
}

void PoseReader::take_all(const Now& now) {
  for (const OwnReader& reader : own_) {
    take_into(intake_, reader.topic, reader.handle, now, taken_, &ended_);
  }
  for (const std::uint64_t name : std::exchange(ended_, {})) names_.forget_name(name);
  for (const bool of_clock : {true, false}) {
    for (const RosReaders::Reader& reader : ros_.readers()) {
      if (intake_.is_clock(reader.topic) == of_clock) ros_.take(reader, now, taken_);
    }
  }
  intake_.settle(now);
}

// Puts the batch into a free slot. The intake gets the slot's memory in exchange.
bool PoseReader::hand_over(PoseBatch& batch) noexcept {
  PoseBatch* const slot = ring_.back();
  if (slot == nullptr) return false;
  if (sensors_) sensors_->note(batch);
  batch.came_ns = SystemClock().monotonic_ns();
  batch.content = content_of(batch);
  std::swap(*slot, batch);
  ring_.push();
  return true;
}

void PoseReader::log_news() {
  for (const News& news : intake_.take_news()) {
    const bool is_missing =
        news.code == lines::kNoTransforms.code || news.code == lines::kMoveItSilent.code;
    const std::string instead = is_missing ? " " + ros_.present().instead_on(where_) : "";
    log_text(news.level, news.text + instead, news.code);
  }
}

std::string PoseReader::guid_of(std::uint64_t writer) const {
  for (const OwnReader& reader : own_) {
    const WriterFacts facts = writer_facts(reader.handle, writer);
    if (facts.present) return facts.guid;
  }
  for (const RosReaders::Reader& reader : ros_.readers()) {
    const WriterFacts facts = writer_facts(reader.handle, writer);
    if (facts.present) return facts.guid;
  }
  return "that has left";
}

}  // namespace clearance
