// A robot of two sliding joints in controller_manager's loop, with its mock hardware, the limiter
// as a plug-in, and a real daemon that hears its joint states. Its hand slides towards a wall.
#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <controller_manager/controller_manager.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <thread>
#include <vector>

namespace clearance_control_test {

using Values = std::array<double, 2>;  // of the joints slide and lift

inline constexpr double kPeriod = 1e-3;  // s, of the loop and of the daemon

// The values that an update has read. Positions and velocities follow from the commands before it.
struct Observed {
  Values positions{}, velocities{};
  double scaling = 0.0;
  int cause = 0;  // Cause of permit_reader.hpp
};

class Daemon {
 public:
  // `stopping`: text of that key of the robot, or nothing. Reports are told to domain
  // ROS_DOMAIN_ID.
  Daemon(const std::filesystem::path& folder, const std::string& stopping);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  void signal(int number) const;
  // SIGKILL. Returns a time after which the process has done nothing.
  std::chrono::steady_clock::time_point kill() const;

 private:
  pid_t pid_ = -1;
};

struct RobotOptions {
  std::string interface = "velocity";
  double slide = 0.0;  // where it begins, m
  std::string limits = "stop_at: 0.1\n    slow_from: 0.4";
  std::string reports_count_for = "0.1";
  std::string stopping = {};  // of the daemon's cell
};

class LimitedRobot {
 public:
  explicit LimitedRobot(const RobotOptions& options);
  ~LimitedRobot();

  // One cycle of the loop, at its time: read, update, write. Joint states follow.
  void step(const Values& references);
  [[nodiscard]] const Observed& observed() const { return observed_; }
  // The true distance of the hand from the wall, m.
  [[nodiscard]] double distance() const { return 1.0 - observed_.positions[0]; }
  // Steps until it is so. False after `most_s` of the robot's time.
  bool step_until(const std::function<Values()>& references, const std::function<bool()>& is_so,
                  double most_s);

  // The allocations of one update of the limiter, in this thread.
  [[nodiscard]] std::uint64_t allocations_of_update();
  bool acknowledge();
  [[nodiscard]] const rclcpp::Node& node() const { return *node_; }

  std::unique_ptr<Daemon> daemon;
  std::filesystem::path folder;
  std::string stopping;

 private:
  void write_files(const RobotOptions& options) const;
  void advance();
  void activate(const std::vector<std::string>& names);

  Values references_{};
  Observed observed_;
  std::shared_ptr<rclcpp::Executor> executor_;
  std::shared_ptr<controller_manager::ControllerManager> manager_;
  controller_interface::ControllerInterfaceBaseSharedPtr limiter_;
  rclcpp::Node::SharedPtr node_;
  rclcpp::Publisher<sensor_msgs::msg::JointState>::SharedPtr states_;
  std::thread spinning_;
  std::chrono::steady_clock::time_point next_;
  rclcpp::Time now_{1, 0, RCL_ROS_TIME};  // the robot's
};

}  // namespace clearance_control_test
