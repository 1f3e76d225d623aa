// A publisher of transforms in ROS 2's format.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::test {

// The pose of a child frame in its parent frame.
struct Frame {
  std::string parent, child;
  Vec3 position = Vec3::Zero();
  std::vector<double> xyzw = {0, 0, 0, 1};
};

class RosFrames {
 public:
  enum class Kind { kChanging, kStatic };
  explicit RosFrames(Participant& participant, Kind kind = Kind::kChanging)
      : writer_(kind == Kind::kStatic ? participant.ros_writer(kRosTfStatic, "rt/tf_static")
                                      : participant.ros_writer(kRosTf, "rt/tf")) {}
  ~RosFrames() { dds_delete(writer_); }
  RosFrames(const RosFrames&) = delete;
  RosFrames& operator=(const RosFrames&) = delete;

  [[nodiscard]] bool is_heard() const {
    return eventually([this] { return matched_readers(writer_) > 0; });
  }

  // Sends all transforms unchanged, with one stamp.
  void send_at(std::int64_t stamp_ns, const std::vector<Frame>& frames) {
    Sample<tf2_msgs_msg_dds__TFMessage_> message;
    reserve_sequence(message->transforms, frames.size());
    for (const Frame& frame : frames) {
      auto& out = message->transforms._buffer[message->transforms._length++];
      out.header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
      out.header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
      out.header.frame_id = dds_string_dup(frame.parent.c_str());
      out.child_frame_id = dds_string_dup(frame.child.c_str());
      out.transform = {{frame.position.x(), frame.position.y(), frame.position.z()},
                       {frame.xyzw[0], frame.xyzw[1], frame.xyzw[2], frame.xyzw[3]}};
    }
    ASSERT_EQ(dds_write(writer_, &*message), DDS_RETCODE_OK);
  }
  void send(const std::vector<Frame>& frames) { send_at(dds_time(), frames); }

 private:
  dds_entity_t writer_;
};

}  // namespace clearance::test
