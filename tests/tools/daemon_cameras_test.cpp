// The daemon reads cameras over real DDS.
//
// Oracles: closed forms for a made scene, which tests/shared/ros_camera.hpp renders.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "monitor/client/client.hpp"
#include "monitor/client/questions.hpp"
#include "monitor/wire/moveit_types.hpp"
#include "tests/shared/one_cube.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/tools/camera_daemon.hpp"

namespace clearance::test {
namespace {

// The slabs of the pixels cover the wall up to its depth less the error, everywhere below the ball.
TEST_F(DaemonCameras, GivesTheExactDistanceToAWallInADepthImage) {
  start(kImage + kAbove);
  EXPECT_TRUE(have_readers(client, dds.partition, {"rt/cam/image", "rt/cam/camera_info"}));
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
  const double exact = static_cast<double>(2.5F) - kError - 1.0 - kRadius;
  EXPECT_LE(ball_pair().lower, exact + 1e-12);
  EXPECT_GE(ball_pair().upper, exact - 1e-12);
  EXPECT_LT(ball_pair().upper - ball_pair().lower, 2.0 * kRounding) << "depths are rounded outward";
  EXPECT_TRUE(daemon->tells("topic-heard", {"'eye'", "/cam/image"})) << daemon->output();
}

// A sphere beside the axis: its surface is nearer than that of the wall.
TEST_F(DaemonCameras, GivesALowerBoundOfTheDistanceToASphereThatIsCloseToIt) {
  start(kImage + kAbove);
  RosCamera camera(client, {});
  camera.encoding = "16UC1";
  ASSERT_TRUE(camera.is_heard());
  MadeScene seen = scene_of_wall;
  seen.ball = {{0.1, 0.05, 1.8}, 0.25};
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(seen); }, [&] { return is_measured(); }))
      << daemon->output();
  // The ball of the cell is at z = 1 in the camera's frame.
  const double exact = (seen.ball->centre - Vec3(0, 0, 1)).norm() - seen.ball->radius - kRadius;
  EXPECT_LE(ball_pair().lower, exact);
  EXPECT_GT(ball_pair().lower, exact - 0.006) << "the error twice, and rounding to millimetres";
}

TEST_F(DaemonCameras, GivesTheExactDistanceToTheBallsOfPoints) {
  start(kPoints + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_points(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
  double exact = 1e9;
  for (std::uint32_t v = 0; v < camera.made.height; ++v) {
    for (std::uint32_t u = 0; u < camera.made.width; ++u) {
      const Vec3 point = (2.5 * camera.made.ray(u, v)).cast<float>().cast<double>();
      const double radius = kError * point.norm() / point.z();
      exact = std::min(exact, (point - Vec3(0, 0, 1)).norm() - radius - kRadius);
    }
  }
  EXPECT_LE(ball_pair().lower, exact);
  EXPECT_NEAR(ball_pair().upper, exact, 1e-8) << "radii are rounded up to float32";
  EXPECT_LT(ball_pair().upper - ball_pair().lower, 1e-8);
}

Sample<octomap_msgs_msg_dds__Octomap_> map_of(const std::string& tree) {
  Sample<octomap_msgs_msg_dds__Octomap_> message;
  const std::int64_t stamp = dds_time();
  message->header.stamp.sec = static_cast<std::int32_t>(stamp / 1'000'000'000);
  message->header.stamp.nanosec = static_cast<std::uint32_t>(stamp % 1'000'000'000);
  message->header.frame_id = dds_string_dup("map");
  message->binary = true;
  message->id = dds_string_dup("OcTree");
  message->resolution = 0.1;
  reserve_sequence(message->data, tree.size());
  message->data._length = static_cast<std::uint32_t>(tree.size());
  std::memcpy(message->data._buffer, tree.data(), tree.size());
  return message;
}

// A cube of 0.1 m below the ball, whose upper side is at z = 0.8.
const std::string kCubeBelow = one_cube({0, 0, 7});

TEST_F(DaemonCameras, GivesTheExactDistanceToTheCubesOfAnOctomap) {
  start("octomap: /map, age_limit_ms: 1000, mount: {pose: {xyz: [0, 0, 0]}}");
  const dds_entity_t writer = client.ros_writer(kRosOctomap, ros_dds_name("/map"));
  ASSERT_TRUE(eventually([&] { return matched_readers(writer) > 0; })) << daemon->output();
  const auto send = [&] { ASSERT_EQ(dds_write(writer, &*map_of(kCubeBelow)), DDS_RETCODE_OK); };
  ASSERT_TRUE(step_until(kPeriodMs, send, [&] { return is_measured(); })) << daemon->output();
  EXPECT_LE(ball_pair().lower, 2.0 - 0.8 - kRadius);
  EXPECT_NEAR(ball_pair().upper, 2.0 - 0.8 - kRadius, 1e-6) << "cubes contain the exact ones";
  dds_delete(writer);
}

TEST_F(DaemonCameras, HaveReadersBeforeAnyPublisherAndThenThoseOfItsType) {
  start("octomap: /map, age_limit_ms: 1000");
  EXPECT_TRUE(have_readers(client, dds.partition, {"rt/map", "rt/tf", "rt/tf_static"}));
  start(kPoints + kAbove);
  ASSERT_TRUE(have_readers(client, dds.partition, {"rt/cam/points"})) << daemon->output();
  const dds_entity_t scan = client.ros_writer(kRosLaserScan, "rt/cam/points");
  ASSERT_TRUE(eventually([&] { return matched_readers(scan) > 0; })) << daemon->output();
  EXPECT_TRUE(eventually([&] {
    return types_read(client, dds.partition)["rt/cam/points"] ==
           std::set<std::string>{kRosLaserScan.descriptor->m_typename};
  })) << "ROS 2's tools refuse a topic of two types";
  dds_delete(scan);
}

// Servers of maps publish a map that does not change once, for readers that come later as well.
TEST_F(DaemonCameras, GetsAMapThatWasPublishedBeforeItStarted) {
  const RosType latched{kRosOctomap.descriptor, kRosOctomap.user_data, true, 1};
  const dds_entity_t writer = client.ros_writer(latched, ros_dds_name("/map"));
  ASSERT_EQ(dds_write(writer, &*map_of(kCubeBelow)), DDS_RETCODE_OK);
  start("octomap: /map, age_limit_ms: 60000, mount: {pose: {xyz: [0, 0, 0]}}");
  ASSERT_TRUE(step_until(
      kPeriodMs, [] {}, [&] { return is_measured(); }))
      << daemon->output();
  EXPECT_NEAR(ball_pair().upper, 2.0 - 0.8 - kRadius, 1e-6);
  // Another server may have no memory for late readers: the daemon reads both kinds.
  dds_delete(writer);
  const dds_entity_t other = client.ros_writer(kRosOctomap, ros_dds_name("/map"));
  ASSERT_TRUE(eventually([&] { return matched_readers(other) > 0; })) << daemon->output();
  const std::string higher = one_cube({0, 0, 9});
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { ASSERT_EQ(dds_write(other, &*map_of(higher)), DDS_RETCODE_OK); },
      [&] { return ball_pair().upper < 2.0 - 0.9 - kRadius; }))
      << daemon->output();
  dds_delete(other);
}

// The camera hangs on a frame that moves past the ball. Each report is that of a frame whose place
// was at its stamp, wherever the camera is now.
TEST_F(DaemonCameras, PlacesAFrameByTfAtItsStamp) {
  start(kImage);
  RosCamera camera(client, {});
  RosFrames frames(client), fixed(client, RosFrames::Kind::kStatic);
  ASSERT_TRUE(camera.is_heard() && frames.is_heard() && fixed.is_heard());
  // Rotation by pi about x.
  fixed.send({{"rail", "camera", Vec3::Zero(), {1, 0, 0, 0}}});
  const auto height = [](std::int64_t stamp_ns) {
    return kHeight + 0.2 * std::sin(1e-9 * static_cast<double>(stamp_ns % 100'000'000'000));
  };
  std::int64_t stamp = dds_time();
  const auto step = [&] {
    stamp = dds_time();
    frames.send_at(stamp, {{"map", "rail", {0, 0, height(stamp)}}});
    camera.send_image(scene_of_wall, stamp);
  };
  ASSERT_TRUE(step_until(kPeriodMs, step, [&] { return is_measured(); })) << daemon->output();
  for (int i = 0; i < 30; ++i) {
    step_until(kPeriodMs, step, [] { return true; });
    if (!is_measured()) continue;
    const auto of_frame = report->oldest_pose_ns;
    const double exact = static_cast<double>(2.5F) - kError - (height(of_frame) - 2.0) - kRadius;
    EXPECT_LE(ball_pair().lower, exact + 1e-9);
    EXPECT_GE(ball_pair().upper, exact - 1e-9);
  }
}

// The arm lies along x in front of the camera, which sees its upper side and the wall behind it.
TEST_F(DaemonCameras, LeavesOutTheRobotsOwnImage) {
  start(kImage + ", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}", {},
        "pose: {xyz: [0.5, 3, 1]}");
  RosCamera camera(client, {});
  RosJoints joints(client);
  ASSERT_TRUE(camera.is_heard() && joints.is_heard());
  const auto send_joints = [&] { joints.send({"shoulder", "elbow", "push"}, {0, 0, 0.1}); };
  camera.change_image = [&](sensor_msgs_msg_dds__Image_& image) {
    auto* const depth = reinterpret_cast<float*>(image.data._buffer);
    for (std::uint32_t v = 0; v < image.height; ++v) {
      for (std::uint32_t u = 0; u < image.width; ++u) {
        const Vec3 on_arm = 1.95 * camera.made.ray(u, v);
        if (std::abs(on_arm.y()) < 0.05 && std::abs(on_arm.x()) < 0.4)
          depth[v * image.width + u] = 1.95F;
      }
    }
  };
  const MadeScene floor{.wall = 3.0, .ball = {}};
  const auto step = [&] {
    send_joints();
    camera.send_image(floor);
    send_joints();
  };
  ASSERT_TRUE(step_until(5, step, [&] { return is("upper", PairStatus::kConverged); }))
      << daemon->output();
  // From the lower side of the arm to the floor, which is seen on both of its sides.
  const double below = 1.0 - 0.05 - kError;
  EXPECT_GE(pair("upper").lower, below - 1e-9);
  EXPECT_LT(pair("upper").lower, below + 0.01);
  // The picture of a robot that is elsewhere is an obstacle.
  const auto turned = [&] {
    joints.send({"shoulder", "elbow", "push"}, {1.5, 0, 0.1});
    camera.send_image(floor);
    joints.send({"shoulder", "elbow", "push"}, {1.5, 0, 0.1});
  };
  EXPECT_TRUE(step_until(5, turned, [&] {
    return is("upper", PairStatus::kConverged) && pair("upper").lower < 0.3;
  })) << daemon->output();
  // Without joints, the arm may be anywhere.
  EXPECT_TRUE(step_until(
      5, [&] { camera.send_image(floor); },
      [&] { return daemon->output().find("[shell-thick]") != std::string::npos; }))
      << daemon->output();
}

// Without a stated speed of what it sees, nothing is known after the age limit.
TEST_F(DaemonCameras, KnowsNothingBeforeTheFirstFrameAndAfterTheLast) {
  start(kImage + kAbove);
  ASSERT_TRUE(step_until(
      kPeriodMs, [] {}, [&] { return report->pairs._length > 0; }));
  EXPECT_EQ(ball_pair().status, static_cast<std::uint8_t>(PairStatus::kUnknown));
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image(scene_of_wall); }, [&] { return is_measured(); }))
      << daemon->output();
  EXPECT_TRUE(step_until(
      kPeriodMs, [] {}, [&] { return is("ball", PairStatus::kUnknown); }))
      << daemon->output();
}

// A changed cell knows nothing of what is seen until its first frame.
TEST_F(DaemonCameras, GoesOnWhenTheCellChanges) {
  start(kImage + kAbove);
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  const auto send = [&] { camera.send_image(scene_of_wall); };
  ASSERT_TRUE(step_until(kPeriodMs, send, [&] { return is_measured(); })) << daemon->output();
  std::string text = read_text(cell);
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.2");
  write_text(cell, text);
  daemon->signal(SIGHUP);
  EXPECT_TRUE(step_until(kPeriodMs, send, [&] {
    return is_measured() && std::abs(ball_pair().lower - (2.5 - kError - 1.0 - 0.2)) < 1e-6;
  })) << daemon->output();
  // Another topic takes another reader.
  text.replace(text.find("/cam/image"), 10, "/eye/image");
  write_text(cell, text);
  daemon->signal(SIGHUP);
  EXPECT_TRUE(step_until(kPeriodMs, send, told("scene-refused", {"sensors"}))) << daemon->output();
  EXPECT_TRUE(is_measured());
  // Frames come until the daemon has ended, and use the changed cell.
  std::atomic<bool> has_ended{false};
  std::thread camera_thread([&] {
    for (; !has_ended; std::this_thread::sleep_for(std::chrono::milliseconds(1))) send();
  });
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  has_ended = true;
  camera_thread.join();
}

// The robot, and with it a camera in its hand, moves while frames come. The first frames come
// before the first joints.
TEST_F(DaemonCameras, AreRecordedSoThatAReplayMakesTheSameReports) {
  const std::string file = (folder / "run.mcap").string();
  start(kImage + ", mount: {on: upper, pose: {xyz: [0.3, 0, 0.5], rpy: [3.141592653589793, 0, 0]}}",
        {"--record", file}, "pose: {xyz: [0.3, 0, -1]}");
  RosCamera camera(client, {});
  RosJoints joints(client);
  ASSERT_TRUE(camera.is_heard() && joints.is_heard());
  int steps = 0;
  const auto send = [&] {
    if (++steps > 10) joints.send({"shoulder", "elbow", "push"}, {0.004 * steps, 0, 0.1});
    if (steps % 5 == 0) camera.send_image(scene_of_wall);
  };
  ASSERT_TRUE(step_until(5, send, [&] { return steps > 150 && is_measured(); }))
      << daemon->output();
  std::string text = read_text(cell);
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.2");
  write_text(cell, text);
  daemon->signal(SIGHUP);
  ASSERT_TRUE(step_until(5, send, [&] { return daemon->told("scene-changed", {}) && steps > 250; }))
      << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess replay(kReplay, {"check", file, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
  EXPECT_THAT(replay.output(), testing::HasSubstr("sensor 'eye'"));
  // Another cell, in which objects have other numbers, uses the images of the same entry.
  const auto replayed = [&](const std::string& changed) {
    write_text(cell, changed);
    ChildProcess other(kReplay, {"check", file, "--cell", cell, "--between", "ball,eye=0.001"});
    static_cast<void>(other.wait());
    return other.output();
  };
  std::string more = text;
  more.insert(more.find("objects: [") + 10, "{name: post, fixed: true, sphere: {radius: 0.1}}, ");
  more.insert(more.find("pairs: [") + 8, "{between: [post, eye]}, ");
  EXPECT_THAT(replayed(more), testing::ContainsRegex("sensor 'eye': [1-9][0-9]* frames used"));
  more.replace(more.find("range: [0.3"), 11, "range: [0.4");
  EXPECT_THAT(replayed(more), testing::AllOf(testing::HasSubstr("no image that this cell can use"),
                                             testing::HasSubstr("what is seen by 'eye'")));
}

// The camera falls silent, which is a fault: the file has the frames of the seconds before it.
TEST_F(DaemonCameras, AreInARecordingByEvent) {
  start(kImage + kAbove, {"--record", (folder / "run.mcap").string(), "--record-around", "1"});
  RosCamera camera(client, {});
  RosJoints joints(client);
  ASSERT_TRUE(camera.is_heard() && joints.is_heard());
  int steps = 0;
  const auto send_joints = [&] {
    joints.send({"shoulder", "elbow", "push"}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  };
  const auto send = [&] {
    camera.send_image({.wall = 2.5 + 0.01 * ++steps, .ball = {}});
    send_joints();
  };
  ASSERT_TRUE(step_until(kPeriodMs, send, [&] { return steps > 30 && is_measured(); }))
      << daemon->output();
  ASSERT_TRUE(step_until(
      kPeriodMs, [] {}, [&] { return daemon->told("event-recorded", {}); }))
      << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  std::string file;
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) {
    if (entry.path().filename().string().starts_with("run-")) file = entry.path().string();
  }
  ChildProcess replay(kReplay, {"check", file, "--compare-bounds"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
  EXPECT_THAT(replay.output(), testing::HasSubstr("sensor 'eye'"));
  EXPECT_THAT(replay.output(), testing::Not(testing::HasSubstr("'eye': 0 frames")));
}

// A recording that leaves out the content of frames says so instead of an answer.
TEST_F(DaemonCameras, ThatARecordingLeavesOutCannotBeCompared) {
  const std::string file = (folder / "run.mcap").string();
  start(kImage + kAbove, {"--record", file, "--record-clouds", "4"});
  RosCamera camera(client, {});
  ASSERT_TRUE(camera.is_heard());
  int steps = 0;
  ASSERT_TRUE(step_until(
      kPeriodMs, [&] { camera.send_image({.wall = 2.5 + 0.01 * ++steps, .ball = {}}); },
      [&] { return steps > 30 && is_measured(); }))
      << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess replay(kReplay, {"check", file, "--compare"});
  EXPECT_NE(replay.wait(), 0);
  EXPECT_THAT(replay.output(), testing::HasSubstr("not in the recording"));
}

// The forearm's top is at z = 0.05, and the slabs of the wall end at z = 0.5 - kError.
TEST_F(DaemonCameras, AnswersQuestionsAboutMotionsBesideWhatTheySee) {
  start(kImage + kAbove, {"--questions", "planner"});
  RosCamera camera(client, {});
  RosJoints joints(client);
  ASSERT_TRUE(camera.is_heard() && joints.is_heard());
  const auto send = [&] {
    camera.send_image(scene_of_wall);
    joints.send({"shoulder", "elbow", "push"}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  };
  ASSERT_TRUE(step_until(kPeriodMs, send, [&] { return is_measured(); })) << daemon->output();
  client::Connection connection(dds);
  client::Questions questions(connection, "planner");
  Question question;
  question.motion = {
      .joints = {"elbow"}, .times = {0.0, 1.0}, .positions = {0.0, 0.5}, .velocities = {}};
  question.margins = {0.1, 0.9};
  const auto ask = [&] {
    std::optional<QuestionResult> result;
    EXPECT_TRUE(step_until(kPeriodMs, send, [&] {
      result = questions.ask(question, {}, std::chrono::seconds(5));
      return result && result->status != QuestionStatus::kNoInput;
    })) << (result ? result->reason : daemon->output());
    return result.value_or(QuestionResult{});
  };
  const QuestionResult refused = ask();
  EXPECT_EQ(refused.status, QuestionStatus::kRefused) << "the eye states no max_speed";
  EXPECT_NE(refused.reason.find("eye"), std::string::npos) << refused.reason;
  question.others = OthersMove::kNot;
  const QuestionResult result = ask();
  ASSERT_TRUE(result.done()) << result.reason;
  const double wall = kHeight - 2.5 - kError - 0.05;  // the pixels' slabs reach this low
  EXPECT_LE(result.lower, wall + 1e-6);
  EXPECT_GE(result.upper, wall - 2e-3);
  EXPECT_LE(result.upper - result.lower, 1e-3 + 1e-6);
  EXPECT_TRUE(result.is_free(0.1));
  EXPECT_EQ(result.first, "eye");
  EXPECT_EQ(result.margins[1].verdict, Verdict::kBelow);
}

}  // namespace
}  // namespace clearance::test
