// Joint states of ROS 2: the topics /joint_states of any namespace, and those that the cell's
// robots name. They are handed on as if a driver of ours had sent them: under a source name, with
// numbers of their own.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

struct RosJointStatesOptions {
  // ROS 2's names of the topics that are used; empty: all that are named joint_states, in any
  // namespace, and those that robots name.
  std::vector<std::string> topics = {};
  OtherClock other_clock = OtherClock::kTold;
  std::size_t most_joints = std::numeric_limits<std::size_t>::max();  // of a message
};

class RosJointStates final : public Decoder {
 public:
  static constexpr std::size_t kMostTopics = 32;

  // The scene and the outlet must outlive this.
  RosJointStates(const Scene& scene, RosJointStatesOptions options, Outlet& out);

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void keep(std::span<const std::uint64_t> writers) override;

  // Writers that are heard, and what was not used of what they said: names that no robot of the
  // cell has, the first of them.
  [[nodiscard]] std::size_t writers() const noexcept;
  [[nodiscard]] const std::set<std::string>& unknown_names() const noexcept {
    return unknown_names_;
  }

 private:
  struct Writer {
    // The topic, "/left/joint_states", for the first of its writers; for the others with "#2" and
    // so on. The end of it, when it is longer.
    SourceName source;
    std::uint64_t messages = 0;
    StampCheck stamps = {};
    bool no_positions_said = false;
  };
  struct Topic {
    std::string name;
    JointNames names;
    std::map<std::uint64_t, Writer> writers;
  };

  [[nodiscard]] bool is_wanted(const TopicName& topic) const;
  [[nodiscard]] Writer& writer_of(Topic& topic, std::uint64_t handle);
  // When the positions held.
  [[nodiscard]] std::int64_t time_of(const RawMessage& message, const Topic& topic, Writer& writer,
                                     TopicCounts& counts);
  void note_unused(const Topic& topic, Writer& writer);

  const Scene& scene_;
  RosJointStatesOptions options_;
  Outlet& out_;
  std::vector<Topic> topics_;  // by port
  std::set<std::string> unknown_names_;
  bool too_many_said_ = false;
  CdrDecoder decoder_;
  Sample<sensor_msgs_msg_dds__JointState_> states_;
  PoseBatch batch_;
};

}  // namespace clearance
