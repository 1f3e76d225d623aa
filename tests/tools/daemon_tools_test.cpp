// Tools of an arm change by commands to a running daemon, over real DDS.
//
// Oracle: a replay of the recording, which makes every report again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/tool_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

// Sends the joints of the arm and of both tools, whoever carries them.
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
      joints_.write({0.3 * swing, -0.5, 0.2 * swing, 0.01, 0.2 + 0.1 * swing});
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  client::JointWriter joints_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class DaemonTools : public RunsPrograms {
 protected:
  DaemonTools() {
    std::string text = kToolCell;
    text.replace(text.find("objects:"), 0,
                 "rate_hz: 200\ndefaults: {age_limit_ms: 10000, max_speed: 1}\n");
    write_tools(folder, text);
  }
};

TEST_F(DaemonTools, ThatChangeAreReplayedToTheSameBits) {
  const DdsOptions dds = own_dds();
  constexpr int kTimes = 10;
  {
    ChildProcess daemon(
        kDaemon, with({path("cell.yaml"), "--record", path("run.mcap")}, dds_arguments(dds)));
    client::Connection connection(dds);
    const ToolsInMotion motion(connection);
    client::Commands commands(connection, "planner");
    std::uint64_t before = 0;
    for (int i = 0; i < kTimes; ++i) {
      const bool is_gripper = i % 2 == 0;
      std::vector<CellChange> changes{AttachRobot{.robot = is_gripper ? "gripper" : "torch",
                                                  .to = "flange",
                                                  .carrier_from_root = Pose{},
                                                  .far = true}};
      if (i > 0)
        changes.insert(changes.begin(), DetachRobot{.robot = is_gripper ? "torch" : "gripper",
                                                    .absent = i % 3 == 0});
      const auto result = commands.send(changes, {}, std::chrono::seconds(20));
      ASSERT_TRUE(result) << daemon.output();
      ASSERT_TRUE(result->done()) << i << ": " << result->path << ": " << result->reason;
      EXPECT_GT(result->in_force_from, before);
      before = result->in_force_from;
    }
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  }
  EXPECT_EQ(run(kReplay, {"check", path("run.mcap"), "--compare"}), 0) << output;
  EXPECT_THAT(output, HasSubstr("ticks"));
}

}  // namespace
}  // namespace clearance::test
