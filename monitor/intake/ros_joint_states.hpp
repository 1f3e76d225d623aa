// Decodes joint states of ROS 2 from the topics /joint_states of any namespace, and from those that
// the cell's robots name. They are handed on like those of our own topics, with a source name and a
// sequence of their own.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/stated_stops.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

struct RosJointStatesOptions {
  // The ROS 2 names of the topics that are used. If empty, these are all topics named joint_states,
  // in any namespace, and those that robots name.
  std::vector<std::string> topics = {};
  OtherClock other_clock = OtherClock::kTold;
  std::size_t most_joints = std::numeric_limits<std::size_t>::max();  // in one message
};

class RosJointStates final : public Decoder {
 public:
  static constexpr std::size_t kMostTopics = 32;

  // The scene, the stops and the outlet must outlive this.
  RosJointStates(const Scene& scene, RosJointStatesOptions options, const StatedStops& stops,
                 Outlet& out);

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void keep(std::span<const std::uint64_t> writers) override;
  void change(const Cell& cell) override;

  // The number of writers, and the first names in their messages that no robot of the cell has.
  [[nodiscard]] std::size_t writers() const noexcept;
  [[nodiscard]] const std::set<std::string>& unknown_names() const noexcept {
    return unknown_names_;
  }

 private:
  struct Writer {
    // The first writer of a topic gets the name of the topic, "/left/joint_states"; later writers
    // add "#2" and so on. A name that is too long is cut at its beginning.
    SourceName source;
    std::uint64_t batches = 0;
    StampCheck stamps = {};
    bool no_positions_said = false;
  };
  struct Topic {
    std::string name;
    JointNames names;
    std::map<std::uint64_t, Writer> writers;
    bool is_left = false;  // it had writers, and none is left: it has no place among kMostTopics
  };

  [[nodiscard]] bool is_wanted(const TopicName& topic) const;
  [[nodiscard]] Writer& writer_of(Topic& topic, std::uint64_t handle);
  // The time at which the positions of a message held.
  [[nodiscard]] std::int64_t time_of(const RawMessage& message, const Topic& topic, Writer& writer,
                                     TopicCounts& counts);
  void note_unused(const Topic& topic, Writer& writer);

  // Hands on batch_ as the next one of the writer.
  void give(Writer& writer, std::uint64_t handle);

  const Scene* scene_;
  RosJointStatesOptions options_;
  const StatedStops& stops_;
  Outlet& out_;
  std::vector<Topic> topics_;  // by port
  std::set<std::string> unknown_names_;
  bool too_many_said_ = false;
  CdrDecoder decoder_;
  Sample<sensor_msgs_msg_dds__JointState_> states_;
  PoseBatch batch_;
};

}  // namespace clearance
