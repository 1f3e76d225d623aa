// The daemon's topics once more, as messages of clearance_msgs on topics of ROS 2.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "config/cell/cell.hpp"
#include "monitor/publish/report_writer.hpp"
#include "monitor/publish/ros_writes.hpp"
#include "monitor/wire/ros_messages.hpp"

namespace clearance {

// Used by the thread that writes reports. A message that is not latched is written only while it
// has a reader. Does nothing for a cell that does not ask for messages.
class RosMessages final : public PublishedSamples {
 public:
  // The participant must outlive this.
  RosMessages(const Cell& cell, Participant& participant);

  void published(TopicKind kind, const void* sample) override;
  void report_ended() override;

 private:
  [[nodiscard]] dds_entity_t writer(TopicKind kind) const noexcept { return writers_[index(kind)]; }

  std::array<dds_entity_t, kTopics.size()> writers_{};  // 0: none
  // ROS 2 has no keys: one message has the states of all zones.
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;  // by id: those that were written
  bool zones_changed_ = false;
  RosWrites writes_;
};

}  // namespace clearance
