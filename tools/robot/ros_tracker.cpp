#include "tools/robot/ros_tracker.hpp"

#include <algorithm>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance::people {
namespace {

template <class Header>
void fill(Header& header, std::int64_t stamp_ns, const std::string& frame) {
  constexpr std::int64_t kNsInASecond = 1'000'000'000;
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kNsInASecond);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kNsInASecond);
  header.frame_id = dds_string_dup(frame.c_str());
}

}  // namespace

RosTracker::RosTracker(client::Connection& connection, std::string world_frame,
                       const std::string& list_topic)
    : connection_(connection),
      world_frame_(std::move(world_frame)),
      ids_(connection.participant().ros_writer(
          kRosIdsList, ros_dds_name(list_topic.empty() ? "/humans/bodies/tracked" : list_topic))),
      frames_(connection.participant().ros_writer(kRosTf, ros_dds_name("/tf"))) {}

RosTracker::~RosTracker() {
  for (const dds_entity_t writer : {ids_, frames_}) dds_delete(writer);
  for (const auto& [id, writer] : joints_) dds_delete(writer);
}

void RosTracker::list(const std::vector<std::string>& ids, std::int64_t stamp_ns) {
  Sample<hri_msgs_msg_dds__IdsList_> message;
  fill(message->header, stamp_ns, "");
  reserve_sequence(message->ids, ids.size());
  for (const std::string& id : ids)
    message->ids._buffer[message->ids._length++] = dds_string_dup(id.c_str());
  dds_write(ids_, &*message);
  std::erase_if(joints_, [&ids](const auto& of_body) {
    const bool is_gone = std::ranges::find(ids, of_body.first) == ids.end();
    if (is_gone) dds_delete(of_body.second);
    return is_gone;
  });
}

void RosTracker::tell(const std::string& id, const Skeleton& skeleton, std::int64_t stamp_ns) {
  dds_entity_t& writer = joints_[id];
  if (writer == 0) {
    writer = connection_.participant().ros_writer(
        kRosJointState, ros_dds_name("/humans/bodies/" + id + "/joint_states"));
  }
  Sample<tf2_msgs_msg_dds__TFMessage_> frames;
  reserve_sequence(frames->transforms, 1);
  auto& body = frames->transforms._buffer[frames->transforms._length++];
  fill(body.header, stamp_ns, world_frame_);
  body.child_frame_id = dds_string_dup(("body_" + id).c_str());
  const Vec3& p = skeleton.world_from_body.position;
  const Eigen::Quaterniond& q = skeleton.world_from_body.orientation;
  body.transform = {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  dds_write(frames_, &*frames);

  Sample<sensor_msgs_msg_dds__JointState_> joints;
  fill(joints->header, stamp_ns, "");
  reserve_sequence(joints->name, skeleton.angles.size());
  reserve_sequence(joints->position, skeleton.angles.size());
  for (const auto& [name, angle] : skeleton.angles) {
    joints->name._buffer[joints->name._length++] = dds_string_dup((name + "_" + id).c_str());
    joints->position._buffer[joints->position._length++] = angle;
  }
  dds_write(writer, &*joints);
}

}  // namespace clearance::people
