// A robot with joint states as real drivers send them, over real DDS: the publications and the log.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "tests/shared/ros_joints.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> kNames = {"shoulder", "elbow", "push"};

// The cure that the log has for each input without a publisher.
const std::string kOtherNetworks =
    "networks (--interface; ros meets ROS 2 nodes, also those with "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST)";

class DaemonJoints : public WatchedDaemon {
 protected:
  // `keys` contains further keys of the robot.
  void start(const std::string& keys = ", age_limit_ms: 200") {
    watch(
        "name: joints\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
        "robots: [{name: arm, urdf: scara.urdf" +
        keys +
        "}]\n"
        "objects:\n"
        "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
        "pairs:\n  - {between: [arm, wall], publish: true}\n"
        "  - {between: [arm, arm], publish: false}\n");
  }
  // A machine that stands still has them late first, and then back.
  bool hears_joints() {
    return daemon->told("joints-heard", {"3 joints of scara"}) ||
           daemon->told("joints-back", {"3 joints of scara"});
  }
  // A step that sends these positions of all joints, and velocities unless none are given.
  static std::function<void()> sent(RosJoints& joints, const std::vector<double>& positions,
                                    const std::vector<double>& velocities = {}) {
    return [&joints, positions, velocities] { joints.send(kNames, positions, velocities); };
  }
};

// The wall is at x = 5. At the angle 0 the end of the upper link is at 0.9 m.
TEST_F(DaemonJoints, OfRos2PlaceTheLinksOfARobot) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  ASSERT_TRUE(step_until(5, sent(joints, {0, 0, 0.1}, {0, 0, 0}), [&] {
    return is("finger", PairStatus::kConverged);
  })) << daemon->output();
  EXPECT_NEAR(pair("upper").distance, 5 - 0.9, 1e-12);
  EXPECT_NEAR(pair("finger").distance, 5 - 2.1 - 0.05, 1e-12);
  EXPECT_EQ(pair("finger").closing_speed, 0.0);
  EXPECT_TRUE(step_until(5, sent(joints, {0, 0, 0.1}),
                         told("joints-heard", {"arm", "shoulder, elbow, push"})));
}

// The drivers of the arm and of the gripper each send their own joints. Then the gripper's driver
// falls silent.
TEST_F(DaemonJoints, OfSeveralPublishersAreOneRobot) {
  start();
  RosJoints arm(client), gripper(client);
  ASSERT_TRUE(arm.is_heard() && gripper.is_heard());
  const auto send_arm = [&] { arm.send({"elbow", "shoulder"}, {0.1, 0.0}); };
  EXPECT_TRUE(step_until(5, send_arm, [&] { return is("lower", PairStatus::kConverged); }));
  EXPECT_TRUE(is("finger", PairStatus::kUnknown)) << "what hangs on an unknown joint";
  EXPECT_TRUE(step_until(
      5,
      [&] {
        send_arm();
        gripper.send({"push"}, {0.1});
      },
      [&] { return is("finger", PairStatus::kConverged); }));
  EXPECT_TRUE(step_until(5, send_arm, [&] { return is("finger", PairStatus::kStale); }));
  EXPECT_TRUE(is("lower", PairStatus::kConverged));
  EXPECT_TRUE(step_until(5, send_arm, told("joints-late", {"1 joint of arm"}))) << daemon->output();
}

// A joint_state_publisher was left running. The daemon cannot tell which of the two is the driver.
TEST_F(DaemonJoints, OfAPublisherThatSendsZerosMakeTheLinksUnknownAndAreNamed) {
  start();
  RosJoints driver(client), zeros(client);
  ASSERT_TRUE(driver.is_heard() && zeros.is_heard());
  const auto real = [&] { driver.send(kNames, {0.5, 0.5, 0.1}); };
  ASSERT_TRUE(step_until(5, real, [&] { return is("finger", PairStatus::kConverged); }));
  EXPECT_TRUE(step_until(
      5,
      [&] {
        real();
        zeros.send(kNames, {0, 0, 0});
      },
      told("two-joint-sources", {"arm", "'/joint_states'", "'/joint_states#2'"})))
      << daemon->output();
  EXPECT_FALSE(is("finger", PairStatus::kConverged));
  EXPECT_TRUE(daemon->tells("refused", {"joint elbow", "another source contradicts"}))
      << daemon->output();
  // The driver ends. What the other one sends is used when the joints can have got there.
  EXPECT_TRUE(step_until(
      10,
      [&] {
        zeros.send(kNames, {0, 0, 0});
      },
      told("source-changed", {"joint elbow", "'/joint_states#2'", "'/joint_states'"})))
      << daemon->output();
}

// The cell names the topic, which both publish.
TEST_F(DaemonJoints, OfTwoPublishersOfTheTopicThatTheCellNamesAreUnknownWhileTheyContradict) {
  start(", age_limit_ms: 200, source: /joint_states");
  RosJoints first(client), second(client);
  ASSERT_TRUE(first.is_heard() && second.is_heard());
  ASSERT_TRUE(step_until(5, sent(first, {0.5, 0.5, 0.1}), [&] {
    return is("finger", PairStatus::kConverged);
  })) << daemon->output();
  EXPECT_TRUE(step_until(
      5,
      [&] {
        first.send(kNames, {0.5, 0.5, 0.1});
        second.send(kNames, {0, 0, 0});
      },
      told("refused", {"joint elbow", "another source contradicts"})))
      << daemon->output();
  EXPECT_FALSE(is("finger", PairStatus::kConverged));
}

// Many drivers fill in 0.
TEST_F(DaemonJoints, WhoseVelocitiesAreAlwaysZeroAreNamed) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  double t = 0.0;
  EXPECT_TRUE(step_until(
      10,
      [&] {
        t += 0.005;
        joints.send(kNames, {0.3 * std::sin(t), 0.3 * std::sin(t), 0.1}, {0.0, 0.0, 0.0});
      },
      told("velocities-contradict", {"joint shoulder", "joint elbow"})))
      << daemon->output();
}

TEST_F(DaemonJoints, ThatAreNoNumbersAreRefusedAndNamed) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(step_until(5, sent(joints, {0.1, 0.1, kNaN}, {kNaN, kNaN, kNaN}),
                         told("refused", {"joint push", "not finite"})))
      << daemon->output();
  EXPECT_TRUE(is("lower", PairStatus::kConverged)) << "the rest of the message is used";
  EXPECT_TRUE(is("finger", PairStatus::kUnknown));
}

TEST_F(DaemonJoints, ThatAJointCannotHaveAreRefusedAndItsLinksUnknownOrWide) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  ASSERT_TRUE(step_until(5, sent(joints, {0.0, 0.0, 0.1}),
                         [&] { return is("finger", PairStatus::kConverged); }));
  // The shoulder rotates at 2 rad/s at most, which is 0.4 rad in an age limit.
  EXPECT_TRUE(step_until(5, sent(joints, {2.9, 0.0, 0.1}), told("joints-contradict", {"arm"})))
      << daemon->output();
  EXPECT_TRUE(daemon->tells("refused", {"joint shoulder"})) << daemon->output();
  EXPECT_FALSE(is("upper", PairStatus::kConverged));
}

// Joint states at 10 Hz, with an age limit of 20 ms.
TEST_F(DaemonJoints, ThatComeMoreSeldomThanTheirAgeLimitAreNamedOnceWithOneThatFits) {
  start("");
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(
      step_until(100, sent(joints, {0, 0, 0.1}),
                 told("slow-input", {"'/joint_states'", "shoulder and 2 more joints", "20 ms"})))
      << daemon->output();
}

TEST_F(DaemonJoints, OfAThousandHertzAreAllTaken) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  double at = 0.0;
  EXPECT_TRUE(step_until(
      1,
      [&] {
        joints.send(kNames, {at += 1e-4, 0, 0.1});
      },
      [&] { return at > 0.1; }));
  EXPECT_TRUE(is("finger", PairStatus::kConverged));
  EXPECT_FALSE(daemon->told("batches-lost")) << daemon->output();
}

// A simulation's clock, which counts seconds since its start.
TEST_F(DaemonJoints, StampedByAnotherClockAreNamedAndUsableByTheTimeTheyAreSent) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  std::int64_t clock = 12'000'000'000;
  const auto send = [&] { joints.send_at(clock += 5'000'000, kNames, {0, 0, 0.1}); };
  EXPECT_TRUE(step_until(5, send, told("other-clock", {"'/joint_states'"}))) << daemon->output();
  EXPECT_FALSE(is("finger", PairStatus::kConverged)) << "what is not known is never clear";
  daemon.reset();
  start(", age_limit_ms: 200, stamps: sent");
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(step_until(5, send, [&] { return is("finger", PairStatus::kConverged); }))
      << daemon->output();
}

TEST_F(DaemonJoints, ThatAreNotStampedAreUsed) {
  start();
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(step_until(
      5,
      [&] {
        joints.send_at(0, kNames, {0, 0, 0.1});
      },
      [&] { return is("finger", PairStatus::kConverged); }))
      << daemon->output();
}

TEST_F(DaemonJoints, ThatNobodySendsAreMissedWithWhatIsThereInstead) {
  start();
  const dds_entity_t tf = client.ros_writer(kRosTf, "rt/tf");
  EXPECT_GT(tf, 0);
  EXPECT_TRUE(step_until(
      50, [] {},
      told("joints-silent", {"3 joints of arm", "shoulder, elbow, push", "rt/tf", "interface lo",
                             "domain " + std::to_string(*dds.domain), kOtherNetworks})))
      << daemon->output();
}

// Whatever is missing, a reader of the log is told of other networks in the same words.
TEST_F(DaemonJoints, TransformsImagesAndScenesThatNobodySendsAreMissedWithTheSameCure) {
  watch(
      "name: missing\nunits: {length: m, angle: rad}\nrate_hz: 50\n"
      "ros2: {world_frame: map, planning_scene: true, collision_object: true}\n"
      "robots: [{name: arm, urdf: scara.urdf}]\n"
      "objects: [{name: cart, frame: cart_link, sphere: {radius: 0.1}}]\n"
      "sensors: [{name: eye, depth_image: /cam/image, size: [65, 49], range: [0.3, 4], "
      "depth_error: {constant: 0.002}, mount: {pose: {xyz: [0, 0, 3]}}}]\n"
      "pairs: [{between: [arm, cart]}, {between: [arm, eye]}, {between: [arm, moveit]}]\n");
  const auto is_missed = [&](const std::string& code, const std::string& what) {
    return step_until(
        50, [] {},
        told(code, {what, "domain " + std::to_string(*dds.domain), "there is: no other program",
                    kOtherNetworks}));
  };
  EXPECT_TRUE(is_missed("joints-silent", "of rt/joint_states")) << daemon->output();
  EXPECT_TRUE(is_missed("no-transforms", "no transform has come")) << daemon->output();
  EXPECT_TRUE(is_missed("frames-silent", "no publisher of rt/cam/image")) << daemon->output();
  EXPECT_TRUE(is_missed("moveit-silent", "no publisher of /collision_object or /planning_scene"))
      << daemon->output();
}

TEST_F(DaemonJoints, ADescriptionThatNobodySendsIsMissedWithTheSameCure) {
  daemon.emplace(kDaemon, with({"--robot-description", "/robot_description"}, dds_arguments(dds)));
  EXPECT_TRUE(eventually(
      told("waiting-for-description", {"rt/robot_description on domain", kOtherNetworks})))
      << daemon->output();
}

TEST_F(DaemonJoints, OfARobotNeedNoCellFile) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  const std::vector<std::string> robot = {"--urdf", folder / "scara.urdf"};
  const std::string neighbours = "not watched: foot - upper, upper - lower, lower - finger";
  ChildProcess check(kDaemon, with(robot, {"--check"}));
  EXPECT_EQ(check.wait(), 0) << check.output();
  EXPECT_TRUE(check.wrote("scara")) << check.output();
  EXPECT_TRUE(check.wrote(neighbours)) << check.output();
  daemon.emplace(kDaemon, with(robot, dds_arguments(dds)));
  RosJoints joints(client);
  ASSERT_TRUE(joints.is_heard());
  ASSERT_TRUE(eventually([&] {
    joints.send(kNames, {0, 0, 0.1});
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return hears_joints();
  })) << daemon->output();
  EXPECT_TRUE(daemon->tells("how-to-reach", {"in partition " + dds.partition})) << daemon->output();
  EXPECT_TRUE(daemon->tells("robot-note", {"scara", neighbours})) << daemon->output();
}

TEST_F(DaemonJoints, OfARobotWithoutACellFileMayHaveATopicOfAnyName) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  const std::vector<std::string> robot = {"--urdf", folder / "scara.urdf", "--joint-states"};
  daemon.emplace(kDaemon, with(with(robot, {"/scara/measured"}), dds_arguments(dds)));
  RosJoints joints(client, "rt/scara/measured");
  ASSERT_TRUE(joints.is_heard());
  ASSERT_TRUE(eventually([&] {
    joints.send(kNames, {0, 0, 0.1});
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return hears_joints();
  })) << daemon->output();
  ChildProcess refused(kDaemon, with(robot, {"measured"}));
  EXPECT_EQ(refused.wait(), 2);
  EXPECT_TRUE(refused.wrote("a topic with its namespace: /arm/joints")) << refused.output();
}

TEST_F(DaemonJoints, OfADescriptionThatRos2PublishesNeedNoFileAtAll) {
  const ChildOptions cache{.environment = {{"XDG_CACHE_HOME", (folder / "cache").string()}}};
  daemon.emplace(kDaemon, with({"--robot-description", "/robot_description"}, dds_arguments(dds)),
                 cache);
  const dds_entity_t writer = client.ros_writer(kRosString, "rt/robot_description");
  Sample<std_msgs_msg_dds__String_> description;
  description->data = dds_string_dup(kScaraUrdf.c_str());
  ASSERT_EQ(dds_write(writer, &*description), DDS_RETCODE_OK);
  RosJoints joints(client);
  ASSERT_TRUE(eventually([&] {
    joints.send(kNames, {0, 0, 0.1});
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return hears_joints();
  })) << daemon->output();
  EXPECT_TRUE(
      daemon->tells("description-kept", {(folder / "cache/clearance/robot_description_").string()}))
      << daemon->output();
}

TEST_F(DaemonJoints, OfACellFileAndARobotOneIsEnough) {
  ChildProcess both(kDaemon, {"cell.yaml", "--urdf", "robot.urdf"});
  EXPECT_EQ(both.wait(), 2) << both.output();
  ChildProcess none(kDaemon, {});
  EXPECT_EQ(none.wait(), 2) << none.output();
  ChildProcess missing(kDaemon, {"--urdf", "nosuch.urdf", "--check"});
  EXPECT_EQ(missing.wait(), 3) << missing.output();
  EXPECT_TRUE(missing.wrote("nosuch.urdf")) << missing.output();
}

}  // namespace
}  // namespace clearance::test
