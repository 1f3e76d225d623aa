// An arm and its tools (tests/shared/tool_cell.hpp), and what carries which.
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "monitor/client/client.hpp"

namespace clearance::test {

// Sends the joints of a moving arm and of both tools, which stand, whoever carries them.
class ToolsInMotion {
 public:
  explicit ToolsInMotion(client::Connection& connection)
      : joints_(connection, "robot", {"shoulder", "elbow", "roll", "g_finger", "t_tilt"}),
        thread_([this] { run(); }) {}
  ~ToolsInMotion() {
    stop_ = true;
    thread_.join();
  }
  ToolsInMotion(const ToolsInMotion&) = delete;
  ToolsInMotion& operator=(const ToolsInMotion&) = delete;

 private:
  void run() {
    for (int step = 0; !stop_; ++step) {
      const double swing = std::sin(0.005 * step);
      joints_.write({{0.3 * swing, -0.5, 0.2 * swing, 0.01, 0.2}});
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  client::JointWriter joints_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// Each list but the first puts one tool down and takes the other one.
inline std::vector<CellChange> next_tool(int step) {
  const bool is_gripper = step % 2 == 0;
  std::vector<CellChange> changes{AttachRobot{.robot = is_gripper ? "gripper" : "torch",
                                              .to = "flange",
                                              .carrier_from_root = Pose{},
                                              .far = true}};
  if (step > 0)
    changes.insert(changes.begin(),
                   DetachRobot{.robot = is_gripper ? "torch" : "gripper", .absent = step % 3 == 0});
  return changes;
}

}  // namespace clearance::test
