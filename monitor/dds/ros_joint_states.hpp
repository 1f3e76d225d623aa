// Joint states of ROS 2: the topics rt/joint_states of any namespace, and those that the cell's
// robots name. What they say is handed on as if a driver of ours had sent it: under a source name,
// with numbers of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/dds/present_topics.hpp"
#include "monitor/dds/ros_stamps.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

// One message, valid during the call that hands it over.
struct RosStates {
  const sensor_msgs_msg_dds__JointState_& message;
  const JointNames& names;
  std::int64_t stamp_ns;  // when the positions held
  // The topic as ROS 2 calls it, "/left/joint_states", for the first of its writers; for the others
  // with "#2" and so on. Of a longer one the end.
  SourceName source;
  std::uint64_t number;  // counts this writer's messages
  std::uint64_t writer;  // publication handle
  dds_entity_t reader;
};

// For one thread.
class RosJointStates {
 public:
  static constexpr std::size_t kMostTopics = 32;

  // Scene and participant must outlive this.
  RosJointStates(const Scene& scene, Participant& participant);
  ~RosJointStates();
  RosJointStates(const RosJointStates&) = delete;
  RosJointStates& operator=(const RosJointStates&) = delete;

  // Makes readers of topics that have appeared and adds them to `wait`; forgets writers that have
  // left.
  void look(const PresentTopics& present, DataWait& wait);
  // Hands over all that has come, topic by topic.
  void take_all(const std::function<void(const RosStates&)>& hand_over);

  // Writers that are heard, and what was not used of what they said: names that no robot of the
  // cell has, the first of them.
  [[nodiscard]] std::size_t writers() const noexcept;
  [[nodiscard]] const std::set<std::string>& unknown_names() const noexcept {
    return unknown_names_;
  }

 private:
  struct Writer {
    SourceName source;
    std::uint64_t messages = 0;
    RosStampCheck stamps = {};
    bool no_positions_said = false;
  };
  struct Topic {
    std::string dds_name, ros_name;
    JointNames names;
    dds_entity_t reader;
    std::map<std::uint64_t, Writer> writers;  // by publication handle
  };

  [[nodiscard]] bool is_wanted(const PresentWriter& writer) const;
  void open(const std::string& dds_name, DataWait& wait);
  [[nodiscard]] Writer& writer_of(Topic& topic, std::uint64_t handle);
  [[nodiscard]] std::int64_t stamp_of(const sensor_msgs_msg_dds__JointState_& message,
                                      std::int64_t sent_ns, const Topic& topic,
                                      Writer& writer) const;
  void note_unused(const sensor_msgs_msg_dds__JointState_& message, const Topic& topic,
                   Writer& writer);

  const Scene& scene_;
  Participant& participant_;
  std::list<Topic> topics_;
  std::set<std::string> unknown_names_;
  bool too_many_said_ = false;
};

}  // namespace clearance
