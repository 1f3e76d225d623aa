// Batches wait until the bag has been read two seconds further: recorders write messages of several
// topics only nearly in the order of their times.
#include "monitor/bags/bag_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/text/spelling.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kDisorderNs = 2'000'000'000;
// Batches that wait at most, however near their times are.
constexpr std::size_t kMostWaiting = 1 << 16;
// In the year 2116.
constexpr std::int64_t kLastTimeNs = std::int64_t{1} << 62;
// A stamp that is this far from when its message was recorded is of another clock.
constexpr std::int64_t kOtherClockNs = 10'000'000'000;

// As rosbag2 names them.
constexpr std::string_view kJointStateType = "sensor_msgs/msg/JointState";
constexpr std::string_view kTransformsType = "tf2_msgs/msg/TFMessage";

std::string last_name_of(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

// Transforms of both topics are one source.
std::string transforms_source(std::string topic) {
  constexpr std::string_view kStatic = "_static";
  if (topic.ends_with(kStatic)) topic.erase(topic.size() - kStatic.size());
  return topic;
}

}  // namespace

BagLog::BagLog(const std::filesystem::path& path, const Cell& cell, const InputLogOptions& options)
    : scene_(cell.scene),
      ros_(cell.ros),
      options_(options),
      path_(path),
      bag_(open_bag(path)),
      frames_(cell, TrackedFrames::ByName::kYes),
      heard_(cell.scene.variables.size()),
      given_(cell.scene, options.joints) {
  error_ = given_.error();
  ended_ = !error_.empty();
}

const std::string& BagLog::error() const noexcept {
  return bag_->error().empty() ? error_ : bag_->error();
}

// Without a batch in all of the bag, that is the error.
bool BagLog::next(LoggedBatch& batch) {
  read_ahead();
  if (waiting_.empty()) {
    if (!given_out_ && error().empty()) error_ = nothing_of_use();
    return false;
  }
  const auto first = waiting_.begin();
  // What comes later than that is not put back in order.
  last_ns_ = std::max(last_ns_, first->first);
  given_out_ = true;
  batch = {std::move(first->second), last_ns_};
  waiting_.erase(first);
  return true;
}

void BagLog::read_ahead() {
  BagMessage message;
  while (!ended_ && (waiting_.empty() || (read_to_ns_ < waiting_.begin()->first + kDisorderNs &&
                                          waiting_.size() < kMostWaiting))) {
    ended_ = !bag_->next(message);
    if (ended_) break;
    // Of a hostile bag, too, times can be added and taken from each other.
    message.log_ns = std::clamp(message.log_ns, std::int64_t{0}, kLastTimeNs);
    take(message);
  }
}

BagLog::Use BagLog::use_of(const BagTopic& topic) const {
  if (topic.encoding != "cdr") return Use::kNothing;
  const std::string last = last_name_of(topic.name);
  if (topic.type == kTransformsType) {
    if (last == "tf_static") return Use::kStaticTransforms;
    return last == "tf" ? Use::kTransforms : Use::kNothing;
  }
  if (topic.type != kJointStateType) return Use::kNothing;
  const std::vector<std::string>& asked = options_.joint_topics;
  const bool is_named =
      std::ranges::find(scene_.robots, topic.name, &Robot::joint_states) != scene_.robots.end();
  const bool used = asked.empty() ? last == "joint_states" || is_named
                                  : std::ranges::find(asked, topic.name) != asked.end();
  return used ? Use::kJoints : Use::kNothing;
}

void BagLog::take(const BagMessage& message) {
  const auto [entry, added] = topics_.try_emplace(message.topic->name);
  Topic& topic = entry->second;
  if (added) {
    topic.type = message.topic->type;
    topic.use = use_of(*message.topic);
    if (topic.use == Use::kJoints) topic.names.emplace(scene_, message.topic->name);
  }
  ++topic.messages;
  read_to_ns_ = std::max(read_to_ns_, message.log_ns);
  switch (topic.use) {
    case Use::kJoints:
      return take_joints(message, topic);
    case Use::kTransforms:
    case Use::kStaticTransforms:
      return take_transforms(message, topic);
    case Use::kNothing:
      return;
  }
}

std::int64_t BagLog::stamp_of(std::int64_t stamp_ns, std::int64_t log_ns, Topic& topic) {
  if (stamp_ns == 0) {
    ++topic.unstamped;
    return log_ns;
  }
  if (std::abs(stamp_ns - log_ns) <= kOtherClockNs) return stamp_ns;
  if (topic.of_another_clock++ == 0) topic.clock_difference_ns = stamp_ns - log_ns;
  return log_ns;
}

// What the robot of the first joint that is known wants holds for all, as on DDS.
RosStamps BagLog::stamps_of(const JointNames& names) const {
  for (std::uint32_t i = 0; i < joint_state_->name._length; ++i) {
    const std::uint32_t variable = names.find(joint_state_->name._buffer[i]);
    if (variable >= scene_.variables.size()) continue;
    return scene_.robots[scene_.variables[variable].robot].stamps;
  }
  return RosStamps::kMessage;
}

void BagLog::note_unknown(const JointNames& names) {
  for (std::uint32_t i = 0; i < joint_state_->name._length; ++i) {
    const char* const name = joint_state_->name._buffer[i];
    if (names.find(name) == JointNames::kUnknown) unknown_joints_.insert(name);
  }
}

void BagLog::take_joints(const BagMessage& message, Topic& topic) {
  if (!decoder_.decode(message.payload, joint_state_)) {
    ++topic.undecodable;
    return;
  }
  const bool by_stamp = stamps_of(*topic.names) == RosStamps::kMessage;
  const std::int64_t stamp =
      by_stamp ? stamp_of(stamp_ns(joint_state_->header), message.log_ns, topic) : message.log_ns;
  PoseBatch batch;
  from_wire(*joint_state_, *topic.names, stamp, batch);
  note_unknown(*topic.names);
  std::erase_if(batch.joints, [this](const JointSample& sample) {
    heard_[sample.variable] = true;
    return options_.joints.contains(scene_.variables[sample.variable].name);
  });
  if (batch.joints.empty()) {
    ++topic.empty;
    return;
  }
  give(message.topic->name, message.log_ns, std::move(batch), topic);
}

// Transforms that never change hold whenever anything comes.
void BagLog::take_transforms(const BagMessage& message, Topic& topic) {
  if (!decoder_.decode(message.payload, transforms_)) {
    ++topic.undecodable;
    return;
  }
  for (std::uint32_t i = 0; i < transforms_->transforms._length; ++i) {
    tree_.set(transforms_->transforms._buffer[i], topic.use == Use::kStaticTransforms);
  }
  const std::string source = transforms_source(message.topic->name);
  PoseBatch poses;
  const std::vector<TrackedFrames::Follower>& followers = frames_.followers();
  for (std::size_t i = 0; i < followers.size(); ++i) {
    std::string root;
    const auto place = frames_.find(tree_, followers[i].frame, &root);
    if (!place) continue;
    roots_met_.insert(root);
    const bool by_stamp = place->stamp_ns && ros_.stamps == RosStamps::kMessage;
    const std::int64_t stamp =
        by_stamp ? stamp_of(*place->stamp_ns, message.log_ns, topic) : message.log_ns;
    PoseBatch base;
    frames_.add(i, place->root_from_frame, stamp, followers[i].is_base ? base : poses);
    for (const JointSample& sample : base.joints) heard_[sample.variable] = true;
    give(base_source(source), message.log_ns, std::move(base), topic);
  }
  give(source, message.log_ns, std::move(poses), topic);
}

void BagLog::give(const std::string& source, std::int64_t log_ns, PoseBatch batch, Topic& topic) {
  if (batch.empty()) return;
  topic.rate.note(scene_, batch);
  wait(source, log_ns, std::move(batch));
}

void BagLog::wait(const std::string& source, std::int64_t log_ns, PoseBatch batch) {
  batch.source = SourceName(source);
  batch.sequence_number = ++sequence_[source];
  waiting_.emplace(log_ns, std::move(batch));
  if (!given_.empty()) waiting_.emplace(log_ns, given_.at(log_ns));
}

// What there is instead, so that it can be asked for.
std::string BagLog::nothing_of_use() const {
  std::string there;
  for (const auto& [name, topic] : topics_) {
    there += fmt::format("{}{} ({}, {} messages)", there.empty() ? "" : ", ", name, topic.type,
                         topic.messages);
  }
  std::string joints;
  for (const std::string& joint : unknown_joints_) joints += (joints.empty() ? "" : ", ") + joint;
  if (!joints.empty()) {
    return fmt::format(
        "{} has nothing that moves this cell: its joint states are of joints that the cell's "
        "robots "
        "do not have: {}; theirs are {}",
        path_.string(), joints, fmt::join(joint_names(scene_), ", "));
  }
  return fmt::format(
      "{} has nothing that moves this cell: no joint states of its robots and no transforms to its "
      "objects. Expected a topic joint_states of type {} with its joints' names, or one that "
      "--joint-topic names; there are {}",
      path_.string(), kJointStateType, there.empty() ? "no messages" : there);
}

std::vector<std::string> BagLog::notes() const {
  std::vector<std::string> notes;
  if (!given_out_) return notes;  // error() says it
  for (const auto& [name, topic] : topics_) {
    const auto note = [&, &topic_name = name](std::uint64_t count, const std::string& what) {
      if (count > 0) notes.push_back(fmt::format("{} messages of {} {}", count, topic_name, what));
    };
    topic.rate.add_note("messages of " + name, notes);
    note(topic.undecodable, "do not decode as " + topic.type + " and were left out");
    note(topic.empty, "have no position of a joint of this cell");
    note(topic.unstamped, "have no stamp: the time when they were recorded is used");
    note(
        topic.of_another_clock,
        fmt::format("have stamps of another clock ({:+.1f} s): the time when they were recorded is "
                    "used",
                    static_cast<double>(topic.clock_difference_ns) * 1e-9));
  }
  for (const std::string& joint : unknown_joints_) {
    notes.push_back(fmt::format("joint '{}' of the bag is not in the cell: left out{}", joint,
                                did_you_mean(joint, joint_names(scene_))));
  }
  note_unheard(scene_, heard_, options_.joints, notes);
  for (const std::string& root : roots_met_) {
    if (frames_.is_root_link(root) || root == ros_.world()) continue;
    notes.push_back(fmt::format("frame '{}' is taken to be the cell's world", root));
  }
  return notes;
}

}  // namespace clearance
