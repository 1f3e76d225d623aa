// Batches wait until the bag has been read further by kLogDisorderNs.
#include "monitor/recording/bag_log.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "monitor/intake/frame_decoders.hpp"

namespace clearance {
namespace {

// The largest number of batches that wait, however close their times are.
constexpr std::size_t kMostWaiting = 1 << 16;
// 2^62 ns, a time in the year 2116.
constexpr std::int64_t kLastTimeNs = std::int64_t{1} << 62;
constexpr std::string_view kJointStateType = "sensor_msgs/msg/JointState";

}  // namespace

BagLog::BagLog(const std::filesystem::path& path, const Cell& cell, const InputLogOptions& options)
    : scene_(cell.scene),
      options_(options),
      path_(path),
      bag_(open_bag(path)),
      intake_(cell,
              {.is_log = true,
               .joint_topics = options.joint_topics,
               .use_scene = options.with_scenes
                                ? [this](moveit::RawScene message) { use(std::move(message)); }
                                : MoveItMessages::Use(),
               .use_sensor = options.with_sensors
                                 ? [this](RawSensorMessage message) { use(std::move(message)); }
                                 : UseSensorMessage()},
              [this](PoseBatch& batch) {
                use(std::move(batch));
                return true;
              }),
      heard_(cell.scene.variables.size()),
      given_(cell.scene, options.joints) {
  error_ = given_.error();
  ended_ = !error_.empty();
}

const std::string& BagLog::error() const noexcept {
  return bag_->error().empty() ? error_ : bag_->error();
}

// Fails if the whole bag has no batch.
bool BagLog::next(LoggedBatch& batch) {
  read_ahead();
  if (waiting_.empty()) {
    if (!given_out_ && error().empty()) error_ = nothing_of_use();
    return false;
  }
  const auto first = waiting_.begin();
  // A batch with an earlier time that comes after this one is not put back in order.
  last_ns_ = std::max(last_ns_, first->first);
  batch = std::move(first->second);
  batch.log_ns = last_ns_;
  given_out_ = given_out_ || batch.scene == nullptr;
  waiting_.erase(first);
  return true;
}

void BagLog::read_ahead() {
  BagMessage message;
  while (!ended_ && (waiting_.empty() || (read_to_ns_ < waiting_.begin()->first + kLogDisorderNs &&
                                          waiting_.size() < kMostWaiting))) {
    ended_ = !bag_->next(message);
    if (ended_) break;
    // With this clamp, sums and differences of times cannot overflow, not even for a hostile bag.
    message.log_ns = std::clamp(message.log_ns, std::int64_t{0}, kLastTimeNs);
    take(message);
  }
}

void BagLog::take(const BagMessage& message) {
  const BagTopic& from = *message.topic;
  const auto [entry, added] = topics_.try_emplace(from.name);
  Topic& topic = entry->second;
  if (added) {
    topic.type = from.type;
    const auto wanted = from.encoding == "cdr" ? intake_.topic({from.name, from.type})
                                               : std::optional<Intake::Topic>();
    if (wanted) topic.number = wanted->number;
  }
  ++topic.messages;
  read_to_ns_ = std::max(read_to_ns_, message.log_ns);
  if (!topic.number) return;
  topic_ = &topic;
  log_ns_ = message.log_ns;
  intake_.take({.topic = *topic.number, .cdr = message.payload, .sent_ns = message.log_ns},
               {.realtime_ns = message.log_ns, .monotonic_ns = message.log_ns});
  for (News& news : intake_.take_news()) {
    const bool is_unused =
        news.code == lines::kTopicNotUsed.code && news.level == lines::kTopicNotUsed.level;
    if (is_unused || news.code == lines::kSlowInput.code) told_.push_back(std::move(news.text));
  }
}

// Messages do not move joints whose positions are given. Batches are numbered in the order of use.
void BagLog::use(PoseBatch batch) {
  std::erase_if(batch.joints, [this](const JointSample& sample) {
    heard_[sample.variable] = true;
    return options_.joints.contains(scene_.variables[sample.variable].name);
  });
  if (batch.empty()) {
    ++topic_->empty;
    return;
  }
  batch.sequence_number = ++sequence_[std::string(batch.source.view())];
  waiting_.emplace(log_ns_, LoggedBatch{std::move(batch)});
  if (!given_.empty()) waiting_.emplace(log_ns_, LoggedBatch{given_.at(log_ns_)});
}

void BagLog::use(moveit::RawScene message) {
  waiting_.emplace(
      log_ns_, LoggedBatch{.batch = {},
                           .scene = std::make_shared<const moveit::RawScene>(std::move(message))});
}

void BagLog::use(RawSensorMessage message) {
  waiting_.emplace(
      log_ns_, LoggedBatch{.batch = {},
                           .sensor = std::make_shared<const RawSensorMessage>(std::move(message))});
}

template <class IsListed>
std::vector<std::string> BagLog::topics(const IsListed& is_listed) const {
  std::vector<std::string> there;
  for (const auto& [name, topic] : topics_) {
    if (is_listed(topic.type))
      there.push_back(fmt::format("{} ({}, {} messages)", name, topic.type, topic.messages));
  }
  return there;
}

std::vector<std::string> BagLog::topics_of(SensorKind kind) const {
  return topics([kind](const std::string& type) { return is_frame_type(kind, type); });
}

// Lists the topics that the bag has instead, so that a user can choose one.
std::string BagLog::nothing_of_use() const {
  const std::vector<std::string> there = topics([](const std::string&) { return true; });
  const auto& joints = intake_.joint_states().unknown_names();
  if (!joints.empty()) {
    return fmt::format(
        "{} has nothing that moves this cell: its joint states are of joints that the cell's "
        "robots "
        "do not have: {}; theirs are {}",
        path_.string(), fmt::join(joints, ", "), fmt::join(joint_names(scene_), ", "));
  }
  return fmt::format(
      "{} has nothing that moves this cell: no joint states of its robots and no transforms to its "
      "objects. Expected a topic joint_states of type {} with its joints' names, or one that "
      "--joint-topic names; there are {}",
      path_.string(), kJointStateType,
      there.empty() ? std::string("no messages") : fmt::format("{}", fmt::join(there, ", ")));
}

std::vector<std::string> BagLog::notes() const {
  std::vector<std::string> notes;
  if (!given_out_) return notes;  // error() tells why
  for (const auto& [name, topic] : topics_) {
    if (!topic.number) continue;
    const auto note = [&, &topic_name = name](std::uint64_t count, const std::string& what) {
      if (count > 0)
        notes.push_back(fmt::format("{} of {} {}", counted(count, "message"), topic_name, what));
    };
    const TopicCounts& counts = intake_.counts(*topic.number);
    note(counts.undecodable, "did not decode as " + topic.type + ": left out");
    note(topic.empty, "had no position of a joint of this cell");
    note(counts.unstamped, "had no stamp: the time of recording is used");
    note(counts.of_another_clock,
         fmt::format("had a stamp of another clock ({:+.1f} s): the time of recording is used",
                     static_cast<double>(counts.clock_difference_ns) * 1e-9));
  }
  notes.insert(notes.end(), told_.begin(), told_.end());
  for (const std::string& joint : intake_.joint_states().unknown_names()) {
    notes.push_back(fmt::format("joint '{}' of the bag is not in the cell: left out{}", joint,
                                did_you_mean(joint, joint_names(scene_))));
  }
  note_unheard(scene_, heard_, options_.joints, notes);
  for (const std::string& world : intake_.transforms().worlds()) {
    notes.push_back(fmt::format("frame '{}' is taken to be the cell's world", world));
  }
  return notes;
}

}  // namespace clearance
