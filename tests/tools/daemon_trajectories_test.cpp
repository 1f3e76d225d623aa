// Motions on a topic of ROS 2 are asked about: over real DDS, with ROS 2's own message types.
//
// Oracle: the closed form of an arm whose finger swings past a pin.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "monitor/wire/moveit_types.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test::trajectories {
namespace {

constexpr int kPeriodMs = 20;
const std::string kTopic = "/arm/joint_trajectory";

class RosTrajectories {
 public:
  explicit RosTrajectories(Participant& participant)
      : writer_(participant.ros_writer(kRosJointTrajectory, "rt" + kTopic)) {}
  ~RosTrajectories() { dds_delete(writer_); }
  RosTrajectories(const RosTrajectories&) = delete;
  RosTrajectories& operator=(const RosTrajectories&) = delete;

  [[nodiscard]] bool is_heard() const {
    return eventually([this] { return matched_readers(writer_) > 0; });
  }
  // The joint moves to these positions, at whole seconds from `first` on.
  void send(const std::string& joint, int first, const std::vector<double>& positions,
            std::int64_t stamp_ns) {
    Sample<trajectory_msgs_msg_dds__JointTrajectory_> message;
    message->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
    message->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
    message->header.frame_id = dds_string_dup("");
    reserve_sequence(message->joint_names, 1);
    message->joint_names._buffer[message->joint_names._length++] = dds_string_dup(joint.c_str());
    reserve_sequence(message->points, positions.size());
    for (const double position : positions) {
      auto& point = message->points._buffer[message->points._length];
      reserve_sequence(point.positions, 1);
      point.positions._buffer[point.positions._length++] = position;
      point.time_from_start.sec = first + static_cast<std::int32_t>(message->points._length++);
    }
    ASSERT_EQ(dds_write(writer_, &*message), DDS_RETCODE_OK);
  }

 private:
  dds_entity_t writer_;
};

// The finger is a sphere of 0.05 m that circles at 2 m around the origin.
class DaemonTrajectories : public WatchedDaemon {
 protected:
  // The cell names the topic and a margin; options add to the topics, and replace the margins.
  void start(const std::vector<std::string>& options = {}) {
    watch("name: motions\nunits: {length: m, angle: rad}\nrate_hz: 200\nros2: {trajectories: [" +
              kTopic +
              "], trajectory_margins: [0.1]}\n"
              "defaults: {age_limit_ms: 20000}\n"
              "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
              "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
              "pairs: [{between: [arm, pin]}, {between: [arm, arm]}]\n",
          options);
    diagnostics = client.ros_reader(kRosDiagnostics, "rt/diagnostics");
    number = client.ros_reader(kRosFloat64, "rt" + kTopic + "/clearance");
  }
  // Sends the motion once, and joint states until both answers have come.
  void ask(const std::string& joint, int first, const std::vector<double>& positions,
           std::int64_t stamp_ns = 0) {
    Sample<diagnostic_msgs_msg_dds__DiagnosticArray_> message;
    Sample<std_msgs_msg_dds__Float64_> value;
    bool has_status = false, has_number = false;
    trajectories.send(joint, first, positions, stamp_ns);
    ASSERT_TRUE(step_until(
        kPeriodMs, [&] { send_joints(); },
        [&] {
          has_status = has_status || take_next(diagnostics, message);
          has_number = has_number || take_next(number, value);
          return has_status && has_number;
        }))
        << daemon->output();
    ASSERT_EQ(message->status._length, 1u);
    const auto& status = message->status._buffer[0];
    EXPECT_EQ(std::string(status.name), "clearance motions: motion on " + kTopic);
    level = status.level;
    text = status.message;
    values.clear();
    for (std::uint32_t i = 0; i < status.values._length; ++i)
      values[status.values._buffer[i].key] = status.values._buffer[i].value;
    lower = value->data;
  }
  void send_joints() {
    joints.send({"shoulder", "elbow", "push"}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  }
  void wait_for_joints() {
    ASSERT_TRUE(trajectories.is_heard() && joints.is_heard()) << daemon->output();
    ASSERT_TRUE(
        eventually([&] { return writers_there(diagnostics) > 0 && writers_there(number) > 0; }));
    ASSERT_TRUE(step_until(
        kPeriodMs, [&] { send_joints(); }, [&] { return report->minimum_known; }))
        << daemon->output();
  }

  RosTrajectories trajectories{client};
  RosJoints joints{client};
  dds_entity_t diagnostics = 0, number = 0;
  int level = -1;
  std::string text;
  std::map<std::string, std::string> values;
  double lower = 0.0;
};

TEST_F(DaemonTrajectories, AreAnsweredByDiagnosticsAndANumber) {
  start();
  wait_for_joints();
  ask("shoulder", 0, {-1.0, 0.6});
  EXPECT_EQ(level, 0) << text;
  EXPECT_EQ(values["margin 0.1 m"], "free");
  EXPECT_LE(lower, 0.15 + 1e-9);
  EXPECT_GE(lower, 0.149);
}

// The controller moves from where the joints are, at -1 rad, to the only point.
TEST_F(DaemonTrajectories, BeginWhereTheJointsAre) {
  start({"--ros2-trajectories", kTopic, "--ros2-trajectories", "/other", "--trajectory-margin",
         "0.1", "--trajectory-margin", "0.2"});
  wait_for_joints();
  ask("shoulder", 2, {0.6});
  EXPECT_EQ(level, 2) << "0.15 m is below 0.2 m";
  EXPECT_EQ(values["margin 0.1 m"], "free");
  EXPECT_EQ(values["margin 0.2 m"], "below");
  EXPECT_NE(text.find("finger"), std::string::npos) << text;
  EXPECT_NEAR(lower, 0.15, 1.1e-3);
}

// The age limit of the joints is 20 s.
TEST_F(DaemonTrajectories, AreRefusedIfTheyBeginTooFarAhead) {
  start();
  wait_for_joints();
  ask("shoulder", 0, {-1.0, 0.6}, dds_time() + 60'000'000'000);
  EXPECT_EQ(level, 2);
  EXPECT_NE(text.find("header.stamp"), std::string::npos) << text;
  EXPECT_EQ(lower, -std::numeric_limits<double>::infinity());
  ask("shoulder", 0, {-1.0, 0.6}, dds_time() - 60'000'000'000);
  EXPECT_EQ(level, 0) << text;
}

TEST_F(DaemonTrajectories, AreNeverFreeWhenNothingIsKnown) {
  start();
  wait_for_joints();
  ask("nothing", 0, {0.0, 1.0});
  EXPECT_EQ(level, 2);
  EXPECT_NE(text.find("nothing"), std::string::npos) << text;
  EXPECT_EQ(lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(values["status"], "refused");
}

}  // namespace
}  // namespace clearance::test::trajectories
