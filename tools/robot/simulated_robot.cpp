#include "tools/robot/simulated_robot.hpp"

#include <algorithm>
#include <utility>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// Most programs send tf at this rate.
constexpr std::int64_t kFramesEveryNs = 10'000'000;

template <class Header>
void set_stamp(Header& header, std::int64_t stamp_ns) {
  constexpr std::int64_t kNsInASecond = 1'000'000'000;
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kNsInASecond);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kNsInASecond);
}

}  // namespace

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
  find_people(cell, connection);
  if (!frames_.empty()) {
    frames_writer_ = connection.participant().ros_writer(kRosTf, ros_dds_name("/tf"));
    reserve_sequence(frames_message_->transforms, frames_.size());
    for (const SimulatedFrame* const frame : frames_) {
      auto& out = frames_message_->transforms._buffer[frames_message_->transforms._length++];
      out.header.frame_id = dds_string_dup(cell.ros.world_frame.c_str());
      out.child_frame_id = dds_string_dup(frame->name.c_str());
    }
  }
  if (sent_joints_.empty()) return;
  positions_.resize(sent_joints_.size());
  velocities_.resize(sent_joints_.size());
  if (!options.ros_topic.empty()) {
    ros_writer_ = connection.participant().ros_writer(kRosJointState, "rt" + options.ros_topic);
    make_ros_message();
    return;
  }
  const std::string source = poses_.empty() ? options.source : "joints of " + options.source;
  std::vector<std::string> names;
  for (const std::uint32_t joint : sent_joints_) names.push_back(cell.scene.variables[joint].name);
  joint_writer_.emplace(connection, source.substr(0, kMaxSourceLength), names);
}

SimulatedRobot::~SimulatedRobot() {
  for (const dds_entity_t writer : {ros_writer_, frames_writer_}) {
    if (writer != 0) dds_delete(writer);
  }
}

// A tracker tells of persons, and nothing else sends their joints and frames.
void SimulatedRobot::find_people(const Cell& cell, client::Connection& connection) {
  std::vector<std::string> bodies;
  for (const Robot& robot : scene_.robots)
    if (robot.person) bodies.push_back(robot.base.frame);
  if (!bodies.empty()) people_.emplace(cell, connection);
  for (const SimulatedFrame& frame : simulation_.frames)
    if (std::ranges::find(bodies, frame.name) == bodies.end()) frames_.push_back(&frame);
  for (std::uint32_t i = 0; i < scene_.variables.size(); ++i)
    if (!scene_.robots[scene_.variables[i].robot].person) sent_joints_.push_back(i);
}

// The names never change, so they are written once.
void SimulatedRobot::make_ros_message() {
  const std::size_t count = sent_joints_.size();
  ros_message_->header.frame_id = dds_string_dup("");
  reserve_sequence(ros_message_->name, count);
  reserve_sequence(ros_message_->position, count);
  reserve_sequence(ros_message_->velocity, count);
  for (const std::uint32_t joint : sent_joints_) {
    ros_message_->name._buffer[ros_message_->name._length++] =
        dds_string_dup(scene_.variables[joint].name.c_str());
  }
}

void SimulatedRobot::send(double t_s, std::int64_t stamp_ns) {
  ++sent_;
  if (pose_writer_) send_poses(t_s, stamp_ns);
  if (!sent_joints_.empty()) send_joints(t_s, stamp_ns);
  if (elapsed(frames_sent_ns_, stamp_ns) < kFramesEveryNs) return;
  frames_sent_ns_ = stamp_ns;
  if (frames_writer_ != 0) send_frames(t_s, stamp_ns);
  if (people_) people_->send(t_s, stamp_ns);
}

void SimulatedRobot::send_frames(double t_s, std::int64_t stamp_ns) {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Pose pose = frame_at(*frames_[i], t_s);
    const Vec3& p = pose.position;
    const Eigen::Quaterniond& q = pose.orientation;
    auto& out = frames_message_->transforms._buffer[i];
    set_stamp(out.header, stamp_ns);
    out.transform = {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  }
  failed_ += dds_write(frames_writer_, &*frames_message_) != DDS_RETCODE_OK;
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
  for (std::size_t i = 0; i < sent_joints_.size(); ++i) {
    positions_[i] = joint_samples_[sent_joints_[i]].position;
    velocities_[i] = joint_samples_[sent_joints_[i]].velocity;
  }
  if (ros_writer_ != 0) return send_joints_to_ros(stamp_ns);
  failed_ += !joint_writer_->write(positions_, velocities_, stamp_ns);
}

void SimulatedRobot::send_joints_to_ros(std::int64_t stamp_ns) {
  set_stamp(ros_message_->header, stamp_ns);
  std::ranges::copy(positions_, ros_message_->position._buffer);
  std::ranges::copy(velocities_, ros_message_->velocity._buffer);
  ros_message_->position._length = ros_message_->velocity._length =
      static_cast<std::uint32_t>(positions_.size());
  failed_ += dds_write(ros_writer_, &*ros_message_) != DDS_RETCODE_OK;
}

}  // namespace clearance
