// Sends the motion of a cell over DDS: the poses and frames of its simulation, the joints of its
// robots, and its persons.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/convert.hpp"
#include "tools/rendering/simulated_world.hpp"
#include "tools/robot/simulated_people.hpp"

namespace clearance {

struct SimulatedRobotOptions {
  std::string source = "robot";
  // The topic of ROS 2 for joints, "/joint_states"; empty: our own topic.
  std::string ros_topic = {};
};

// A robot follows a daemon that changes its cell: objects have the ids that the latest catalogue
// gives their names, and what that cell lacks is not sent.
class SimulatedRobot {
 public:
  // The cell and the connection must outlive this. `joints` is not called in a cell without
  // robots.
  SimulatedRobot(const Cell& cell, client::Connection& connection,
                 const SimulatedRobotOptions& options, JointMotion joints);
  ~SimulatedRobot();
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  [[nodiscard]] std::size_t objects() const noexcept { return poses_.size(); }
  [[nodiscard]] std::size_t joints() const noexcept { return positions_.size(); }
  [[nodiscard]] std::size_t frames() const noexcept { return frames_.size(); }
  // None: the cell has no persons.
  [[nodiscard]] const std::optional<SimulatedPeople>& people() const noexcept { return people_; }

  // Sends the state `t_s` seconds after the start under this stamp.
  void send(double t_s, std::int64_t stamp_ns);

  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }

 private:
  void find_people(const Cell& cell, client::Connection& connection);
  void make_ros_message();
  [[nodiscard]] bool follows_another_cell() const;
  void send_poses(double t_s, std::int64_t stamp_ns);
  void send_joints(double t_s, std::int64_t stamp_ns);
  void send_joints_to_ros(std::int64_t stamp_ns);
  void send_frames(double t_s, std::int64_t stamp_ns);

  const Scene& scene_;
  const Simulation& simulation_;
  JointMotion motion_;
  std::vector<PoseAt> poses_;
  std::vector<clearance_msg_ObjectPose> sent_poses_;
  std::vector<JointSample> joint_samples_;
  std::vector<std::uint32_t> sent_joints_;      // variables of robots that are no persons
  std::vector<double> positions_, velocities_;  // of these
  std::optional<client::Catalogue> catalogue_;  // none: no poses are sent
  std::vector<client::Object> moving_;          // in the order of the poses
  std::optional<client::PoseWriter> pose_writer_;
  std::optional<client::JointWriter> joint_writer_;
  Sample<sensor_msgs_msg_dds__JointState_> ros_message_;
  dds_entity_t ros_writer_ = 0;  // 0: none
  Sample<tf2_msgs_msg_dds__TFMessage_> frames_message_;
  std::vector<const SimulatedFrame*> frames_;  // but those of persons
  dds_entity_t frames_writer_ = 0;             // 0: none
  std::optional<SimulatedPeople> people_;
  std::int64_t frames_sent_ns_ = 0;
  std::uint64_t sent_ = 0, failed_ = 0;
};

}  // namespace clearance
