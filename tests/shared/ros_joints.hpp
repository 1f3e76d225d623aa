// A publisher of joint states in ROS 2's format.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::test {

class RosJoints {
 public:
  explicit RosJoints(Participant& participant, const std::string& topic = "rt/joint_states")
      : writer_(participant.ros_writer(kRosJointState, topic)) {}
  ~RosJoints() { dds_delete(writer_); }
  RosJoints(const RosJoints&) = delete;
  RosJoints& operator=(const RosJoints&) = delete;

  [[nodiscard]] bool is_heard() const {
    return eventually([this] { return matched_readers(writer_) > 0; });
  }

  // Sends the lists unchanged, whatever their lengths. The default stamp is the current time.
  void send(const std::vector<std::string>& names, const std::vector<double>& positions,
            const std::vector<double>& velocities = {}) {
    send_at(dds_time(), names, positions, velocities);
  }
  void send_at(std::int64_t stamp_ns, const std::vector<std::string>& names,
               const std::vector<double>& positions, const std::vector<double>& velocities = {}) {
    Sample<sensor_msgs_msg_dds__JointState_> message;
    message->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
    message->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
    message->header.frame_id = dds_string_dup("");
    reserve_sequence(message->name, names.size());
    for (const std::string& name : names)
      message->name._buffer[message->name._length++] = dds_string_dup(name.c_str());
    fill(message->position, positions);
    fill(message->velocity, velocities);
    ASSERT_EQ(dds_write(writer_, &*message), DDS_RETCODE_OK);
  }

 private:
  template <class Sequence>
  static void fill(Sequence& sequence, const std::vector<double>& values) {
    reserve_sequence(sequence, values.size());
    for (const double value : values) sequence._buffer[sequence._length++] = value;
  }

  dds_entity_t writer_;
};

}  // namespace clearance::test
