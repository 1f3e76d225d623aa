#include "monitor/intake/ros_joint_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "monitor/intake/pose_sources.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

constexpr std::string_view kJointStatesType = "sensor_msgs/msg/JointState";
constexpr std::string_view kLast = "/joint_states";
constexpr std::size_t kMostUnknownNames = 64;

}  // namespace

RosJointStates::RosJointStates(const Scene& scene, RosJointStatesOptions options,
                               const StatedStops& stops, Outlet& out)
    : scene_(&scene), options_(std::move(options)), stops_(stops), out_(out) {}

void RosJointStates::change(const Cell& cell) {
  scene_ = &cell.scene;
  for (Topic& topic : topics_) topic.names = JointNames(*scene_, topic.name);
  unknown_names_.clear();
}

bool RosJointStates::is_wanted(const TopicName& topic) const {
  if (scene_->variables.empty() || topic.type != kJointStatesType) return false;
  if (!options_.topics.empty()) {
    return std::ranges::find(options_.topics, topic.name) != options_.topics.end();
  }
  const auto is_unread = [this, &topic](const JointVariable& variable) {
    return scene_->robots[variable.robot].joint_states == topic.name && !variable.is_read;
  };
  if (std::ranges::any_of(scene_->variables, is_unread)) return false;
  return topic.name.ends_with(kLast) || topic.name == kLast.substr(1) ||
         std::ranges::find(scene_->robots, topic.name, &Robot::joint_states) !=
             scene_->robots.end();
}

std::optional<Decoder::Wanted> RosJointStates::wants(const TopicName& topic) {
  if (!is_wanted(topic)) return std::nullopt;
  const auto known = std::ranges::find(topics_, topic.name, &Topic::name);
  const auto port = static_cast<std::uint32_t>(known - topics_.begin());
  if (known != topics_.end()) return Wanted{port, &kRosJointState};
  const auto held = std::ranges::count(topics_, false, &Topic::is_left);
  if (static_cast<std::size_t>(held) >= kMostTopics) {
    if (!std::exchange(too_many_said_, true)) {
      out_.tell(News(lines::kTooManyTopics, topic.name, kMostTopics));
    }
    return std::nullopt;
  }
  topics_.push_back({topic.name, JointNames(*scene_, topic.name), {}});
  out_.tell(News(lines::kTopicHeard, "joint states of ROS 2", ros_dds_name(topic.name)));
  return Wanted{port, &kRosJointState};
}

// A robot without a topic of its own has the joints of /joint_states.
std::vector<NamedTopic> RosJointStates::named() const {
  std::vector<NamedTopic> named;
  for (const Robot& robot : scene_->robots) {
    const std::string topic = robot.joint_states.empty() ? std::string(kLast) : robot.joint_states;
    const bool is_there = std::ranges::find(named, topic, &NamedTopic::name) != named.end();
    if (!is_there && is_wanted({topic, std::string(kJointStatesType)}))
      named.push_back({topic, &kRosJointState});
  }
  return named;
}

void RosJointStates::keep(std::span<const std::uint64_t> writers) {
  for (Topic& topic : topics_) {
    const auto gone = std::erase_if(topic.writers, [&](const auto& writer) {
      return !std::ranges::binary_search(writers, writer.first);
    });
    topic.is_left = topic.writers.empty() && (topic.is_left || gone > 0);
  }
}

// Uses the lowest number that no other writer of the topic has. A restarted writer thus gets its
// former name again.
RosJointStates::Writer& RosJointStates::writer_of(Topic& topic, std::uint64_t handle) {
  topic.is_left = false;
  const auto known = topic.writers.find(handle);
  if (known != topic.writers.end()) return known->second;
  std::size_t number = 1;
  const auto is_taken = [&](const auto& writer) {
    return writer.second.source == name_of_writer(topic.name, number);
  };
  while (std::ranges::any_of(topic.writers, is_taken)) ++number;
  return topic.writers.emplace(handle, Writer{.source = name_of_writer(topic.name, number)})
      .first->second;
}

// The robot of the first known joint decides for the whole message.
std::int64_t RosJointStates::time_of(const RawMessage& message, const Topic& topic, Writer& writer,
                                     TopicCounts& counts) {
  RosStamps wanted = RosStamps::kMessage;
  for (std::uint32_t i = 0; i < states_->name._length; ++i) {
    const std::uint32_t variable = topic.names.find(states_->name._buffer[i]);
    if (variable >= JointNames::kUnused) continue;
    wanted = scene_->robots[scene_->variables[variable].robot].stamps;
    break;
  }
  return writer.stamps.time_of(stamp_ns(states_->header), message.sent_ns, wanted,
                               options_.other_clock, counts, out_, [&]() -> StampCheck::Whose {
                                 return {
                                     fmt::format("joint states from '{}'", writer.source.view()),
                                     "'stamps: sent' of the robot"};
                               });
}

void RosJointStates::note_unused(const Topic& topic, Writer& writer) {
  if (states_->position._length == 0 && states_->name._length > 0 &&
      !std::exchange(writer.no_positions_said, true)) {
    out_.tell(News(lines::kNoPositions, writer.source.view()));
  }
  std::string added;
  for (std::uint32_t i = 0; i < states_->name._length; ++i) {
    const char* const name = states_->name._buffer[i];
    if (unknown_names_.size() >= kMostUnknownNames) break;
    if (topic.names.find(name) != JointNames::kUnknown) continue;
    if (unknown_names_.insert(name).second)
      added += (added.empty() ? "" : ", ") + (*name == '\0' ? quoted(name) : std::string(name));
  }
  if (added.empty()) return;
  out_.tell(News(lines::kUnknownRosJoints, writer.source.view(), added));
}

void RosJointStates::give(Writer& writer, std::uint64_t handle) {
  batch_.source = writer.source;
  batch_.sequence_number = ++writer.batches;
  const std::size_t used = std::min(batch_.joints.size(), options_.most_joints);
  const std::size_t cut = batch_.joints.size() - used;
  batch_.joints.resize(used);
  out_.give(batch_, handle, cut);
}

// All joints of a batch are stopping, or none is: one message may have two robots that differ.
bool RosJointStates::decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) {
  if (!decoder_.decode(message.cdr, states_, message.bytes)) return false;
  Topic& topic = topics_[port];
  Writer& writer = writer_of(topic, message.writer);
  note_unused(topic, writer);
  from_wire(*states_, topic.names, time_of(message, topic, writer, counts), batch_);
  for (JointSample& sample : batch_.joints)
    sample.stopping = stops_.is_stopping(sample.variable, sample.stamp_ns, now);
  const auto moving = std::ranges::stable_partition(batch_.joints, &JointSample::stopping);
  std::vector<JointSample> others;
  if (moving.begin() != batch_.joints.begin()) {
    others.assign(moving.begin(), moving.end());
    batch_.joints.erase(moving.begin(), moving.end());
  }
  give(writer, message.writer);
  if (others.empty()) return true;
  batch_.scene_revision = 0;
  batch_.samples.clear();
  batch_.joints = std::move(others);
  give(writer, message.writer);
  return true;
}

std::size_t RosJointStates::writers() const noexcept {
  std::size_t count = 0;
  for (const Topic& topic : topics_) count += topic.writers.size();
  return count;
}

}  // namespace clearance
