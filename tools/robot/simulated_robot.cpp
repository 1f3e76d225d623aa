#include "tools/robot/simulated_robot.hpp"

#include <utility>

namespace clearance {

// One name belongs to one writer: where there are both, joints have one of their own.
SimulatedRobot::SimulatedRobot(const Scene& scene, Participant& participant,
                               const SimulatedRobotOptions& options, JointMotion joints)
    : scene_(scene), motion_(std::move(joints)) {
  poses_at(scene_, 0.0, poses_);
  batch_.source = SourceName(options.source);
  batch_.scene_revision = scene.revision;
  batch_.samples.resize(poses_.size());
  if (!poses_.empty()) {
    sample_ = make_batch(poses_.size());
    pose_writer_ = participant.writer(TopicKind::kPoses, scene.topics.poses);
  }
  if (scene.variables.empty()) return;
  joint_batch_.source = SourceName(poses_.empty() ? options.source : "joints of " + options.source);
  if (options.ros_topic.empty()) {
    joint_writer_ = participant.writer(TopicKind::kJointStates, scene.topics.joint_states);
  } else {
    ros_writer_ = participant.ros_writer(kRosJointState, "rt" + options.ros_topic);
    make_ros_message();
  }
}

SimulatedRobot::~SimulatedRobot() {
  for (const dds_entity_t writer : {pose_writer_, joint_writer_, ros_writer_}) {
    if (writer != 0) dds_delete(writer);
  }
}

// Its names are always the same.
void SimulatedRobot::make_ros_message() {
  const std::size_t count = scene_.variables.size();
  ros_message_->header.frame_id = dds_string_dup("");
  reserve_sequence(ros_message_->name, count);
  reserve_sequence(ros_message_->position, count);
  reserve_sequence(ros_message_->velocity, count);
  for (const JointVariable& variable : scene_.variables) {
    ros_message_->name._buffer[ros_message_->name._length++] =
        dds_string_dup(variable.name.c_str());
  }
}

void SimulatedRobot::write(dds_entity_t writer, const void* sample) {
  if (dds_write(writer, sample) != DDS_RETCODE_OK) ++failed_;
}

void SimulatedRobot::send(double t_s) {
  const std::int64_t stamp = clock_.realtime_ns();
  ++sent_;
  if (pose_writer_ != 0) send_poses(t_s, stamp);
  if (joint_writer_ != 0 || ros_writer_ != 0) send_joints(t_s, stamp);
}

void SimulatedRobot::send_poses(double t_s, std::int64_t stamp_ns) {
  poses_at(scene_, t_s, poses_);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    batch_.samples[i] = {.object = poses_[i].object,
                         .stamp_ns = stamp_ns,
                         .world_from_object = poses_[i].world_from_object,
                         .twist = poses_[i].twist,
                         .has_twist = true};
  }
  batch_.sequence_number = sent_;
  to_wire(batch_, *sample_);
  write(pose_writer_, &*sample_);
}

void SimulatedRobot::send_joints(double t_s, std::int64_t stamp_ns) {
  motion_(t_s, joint_batch_.joints);
  if (ros_writer_ != 0) return send_joints_to_ros(stamp_ns);
  for (JointSample& sample : joint_batch_.joints) sample.stamp_ns = stamp_ns;
  joint_batch_.sequence_number = sent_;
  const auto states = make_joint_states(joint_batch_, scene_);
  write(joint_writer_, &*states);
}

void SimulatedRobot::send_joints_to_ros(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  ros_message_->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecondNs);
  ros_message_->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecondNs);
  ros_message_->position._length = ros_message_->velocity._length = 0;
  for (const JointSample& sample : joint_batch_.joints) {
    ros_message_->position._buffer[ros_message_->position._length++] = sample.position;
    ros_message_->velocity._buffer[ros_message_->velocity._length++] = sample.velocity;
  }
  write(ros_writer_, &*ros_message_);
}

}  // namespace clearance
