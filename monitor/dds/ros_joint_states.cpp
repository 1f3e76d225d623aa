#include "monitor/dds/ros_joint_states.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "monitor/frames/tf_tree.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {
namespace {

// Of ROS 2's topics in DDS: rt/joint_states is /joint_states.
constexpr std::string_view kRos = "rt/";
constexpr std::string_view kLast = "/joint_states";
constexpr std::size_t kMostUnknownNames = 64;

// The end of a long topic tells more than its beginning.
SourceName source_name(const std::string& topic, std::size_t writer) {
  const std::string suffix = writer > 1 ? fmt::format("#{}", writer) : "";
  const std::size_t room = kMaxSourceLength - suffix.size();
  return SourceName((topic.size() > room ? topic.substr(topic.size() - room) : topic) + suffix);
}

}  // namespace

RosJointStates::RosJointStates(const Scene& scene, Participant& participant)
    : scene_(scene), participant_(participant) {}

RosJointStates::~RosJointStates() {
  for (const Topic& topic : topics_) dds_delete(topic.reader);
}

bool RosJointStates::is_wanted(const PresentWriter& writer) const {
  const std::string_view topic = writer.topic;
  if (!topic.starts_with(kRos) || writer.type != kRosJointState.descriptor->m_typename)
    return false;
  const std::string_view ros = topic.substr(kRos.size() - 1);
  return ros.ends_with(kLast) || std::ranges::any_of(scene_.robots, [&](const Robot& robot) {
           return robot.joint_states == ros;
         });
}

void RosJointStates::open(const std::string& dds_name, DataWait& wait) {
  if (std::ranges::find(topics_, dds_name, &Topic::dds_name) != topics_.end()) return;
  if (topics_.size() == kMostTopics) {
    if (!std::exchange(too_many_said_, true))
      spdlog::warn("{} is one topic of joint states too many: {} are heard", dds_name, kMostTopics);
    return;
  }
  const std::string ros_name = dds_name.substr(kRos.size() - 1);
  const dds_entity_t reader = participant_.ros_reader(kRosJointState, dds_name);
  topics_.push_back({dds_name, ros_name, JointNames(scene_, ros_name), reader, {}});
  wait.add(reader);
  spdlog::info("joint states of ROS 2 on {}", dds_name);
}

void RosJointStates::look(const PresentTopics& present, DataWait& wait) {
  for (const auto& [handle, writer] : present.writers()) {
    if (is_wanted(writer)) open(writer.topic, wait);
  }
  for (Topic& topic : topics_) {
    std::erase_if(topic.writers,
                  [&](const auto& writer) { return !present.writers().contains(writer.first); });
  }
}

// The lowest number that no other writer of the topic has: one that is started again gets the name
// of the one before.
RosJointStates::Writer& RosJointStates::writer_of(Topic& topic, std::uint64_t handle) {
  const auto known = topic.writers.find(handle);
  if (known != topic.writers.end()) return known->second;
  std::size_t number = 1;
  const auto is_taken = [&](const auto& writer) {
    return writer.second.source == source_name(topic.ros_name, number);
  };
  while (std::ranges::any_of(topic.writers, is_taken)) ++number;
  return topic.writers.emplace(handle, Writer{.source = source_name(topic.ros_name, number)})
      .first->second;
}

// What the robot of the first joint that is known wants holds for all.
std::int64_t RosJointStates::stamp_of(const sensor_msgs_msg_dds__JointState_& message,
                                      std::int64_t sent_ns, const Topic& topic,
                                      Writer& writer) const {
  RosStamps wanted = RosStamps::kMessage;
  for (std::uint32_t i = 0; i < message.name._length; ++i) {
    const std::uint32_t variable = topic.names.find(message.name._buffer[i]);
    if (variable >= JointNames::kUnused) continue;
    wanted = scene_.robots[scene_.variables[variable].robot].stamps;
    break;
  }
  return writer.stamps.time_of(
      stamp_ns(message.header), sent_ns, wanted, [&]() -> RosStampCheck::Whose {
        return {fmt::format("joint states from '{}'", writer.source.view()),
                "'stamps: sent' of the robot"};
      });
}

void RosJointStates::note_unused(const sensor_msgs_msg_dds__JointState_& message,
                                 const Topic& topic, Writer& writer) {
  if (message.position._length == 0 && message.name._length > 0 &&
      !std::exchange(writer.no_positions_said, true)) {
    spdlog::info("joint states from '{}' without positions are not used", writer.source.view());
  }
  std::string added;
  for (std::uint32_t i = 0; i < message.name._length; ++i) {
    const char* const name = message.name._buffer[i];
    if (unknown_names_.size() >= kMostUnknownNames) break;
    if (topic.names.find(name) != JointNames::kUnknown) continue;
    if (unknown_names_.insert(name).second)
      added += (added.empty() ? "" : ", ") + std::string(name);
  }
  if (!added.empty()) {
    spdlog::info("joints from '{}' that no robot of this cell has there are not used: {}",
                 writer.source.view(), added);
  }
}

void RosJointStates::take_all(const std::function<void(const RosStates&)>& hand_over) {
  Sample<sensor_msgs_msg_dds__JointState_> message;
  for (Topic& topic : topics_) {
    void* pointer = &*message;
    dds_sample_info_t info;
    while (dds_take(topic.reader, &pointer, &info, 1, 1) > 0) {
      if (!info.valid_data) continue;
      Writer& writer = writer_of(topic, info.publication_handle);
      note_unused(*message, topic, writer);
      hand_over({.message = *message,
                 .names = topic.names,
                 .stamp_ns = stamp_of(*message, sent_ns(info.source_timestamp), topic, writer),
                 .source = writer.source,
                 .number = ++writer.messages,
                 .writer = info.publication_handle,
                 .reader = topic.reader});
    }
  }
}

std::size_t RosJointStates::writers() const noexcept {
  std::size_t count = 0;
  for (const Topic& topic : topics_) count += topic.writers.size();
  return count;
}

}  // namespace clearance
