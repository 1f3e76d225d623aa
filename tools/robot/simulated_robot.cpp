#include "tools/robot/simulated_robot.hpp"

#include <algorithm>
#include <utility>

namespace clearance {

// A source name belongs to one writer. Beside poses, joints therefore have a name of their own.
SimulatedRobot::SimulatedRobot(const Cell& cell, client::Connection& connection,
                               const SimulatedRobotOptions& options, JointMotion joints)
    : scene_(cell.scene), simulation_(cell.simulation), motion_(std::move(joints)) {
  poses_at(simulation_, 0.0, poses_);
  if (!poses_.empty()) {
    pose_writer_.emplace(connection, options.source);
    catalogue_.emplace(connection);
    for (const PoseAt& pose : poses_)
      moving_.emplace_back(*catalogue_, cell.scene.objects[pose.object].name);
  }
  if (cell.scene.variables.empty()) return;
  positions_.resize(cell.scene.variables.size());
  velocities_.resize(cell.scene.variables.size());
  if (!options.ros_topic.empty()) {
    ros_writer_ = connection.participant().ros_writer(kRosJointState, "rt" + options.ros_topic);
    make_ros_message();
    return;
  }
  const std::string source = poses_.empty() ? options.source : "joints of " + options.source;
  std::vector<std::string> names;
  for (const JointVariable& variable : cell.scene.variables) names.push_back(variable.name);
  joint_writer_.emplace(connection, source.substr(0, kMaxSourceLength), names);
}

SimulatedRobot::~SimulatedRobot() {
  if (ros_writer_ != 0) dds_delete(ros_writer_);
}

// The names never change, so they are written once.
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

void SimulatedRobot::send(double t_s, std::int64_t stamp_ns) {
  ++sent_;
  if (pose_writer_) send_poses(t_s, stamp_ns);
  if (!scene_.variables.empty()) send_joints(t_s, stamp_ns);
}

// The cell of another daemon, which has another name, is not followed.
bool SimulatedRobot::follows_another_cell() const {
  const clearance_msg_Catalogue* const now = catalogue_->message();
  return now != nullptr && now->scene_revision != scene_.revision && now->scene == scene_.name;
}

void SimulatedRobot::send_poses(double t_s, std::int64_t stamp_ns) {
  poses_at(simulation_, t_s, poses_);
  catalogue_->update();
  const bool follows = follows_another_cell();
  const std::uint64_t revision = follows ? catalogue_->revision() : scene_.revision;
  sent_poses_.clear();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const std::optional<std::uint32_t> object =
        follows ? moving_[i].id(revision) : std::optional(poses_[i].object);
    if (!object) continue;
    to_wire({.object = *object,
             .stamp_ns = stamp_ns,
             .world_from_object = poses_[i].world_from_object,
             .twist = poses_[i].twist,
             .has_twist = true},
            sent_poses_.emplace_back());
  }
  failed_ += !pose_writer_->write(sent_poses_, revision);
}

void SimulatedRobot::send_joints(double t_s, std::int64_t stamp_ns) {
  motion_(t_s, joint_samples_);
  for (std::size_t i = 0; i < joint_samples_.size(); ++i) {
    positions_[i] = joint_samples_[i].position;
    velocities_[i] = joint_samples_[i].velocity;
  }
  if (ros_writer_ != 0) return send_joints_to_ros(stamp_ns);
  failed_ += !joint_writer_->write(positions_, velocities_, stamp_ns);
}

void SimulatedRobot::send_joints_to_ros(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  ros_message_->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecondNs);
  ros_message_->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecondNs);
  std::ranges::copy(positions_, ros_message_->position._buffer);
  std::ranges::copy(velocities_, ros_message_->velocity._buffer);
  ros_message_->position._length = ros_message_->velocity._length =
      static_cast<std::uint32_t>(positions_.size());
  failed_ += dds_write(ros_writer_, &*ros_message_) != DDS_RETCODE_OK;
}

}  // namespace clearance
