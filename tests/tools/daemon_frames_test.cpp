// Objects and bases that follow frames of tf, over real DDS: the publications, the log, and a
// recording that replays to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <string>

#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test {
namespace {

// An arm on a cart that follows a frame, a box that follows another, and a wall at x = 5.
class DaemonFrames : public WatchedDaemon {
 protected:
  void start(const std::vector<std::string>& more = {}) {
    watch(
        "name: frames\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
        "defaults: {age_limit_ms: 300}\nros2: {world_frame: map}\n"
        "robots: [{name: arm, urdf: scara.urdf, base: {frame: mir}}]\n"
        "objects:\n"
        "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
        "  - {name: box, frame: box_link, max_speed: 50, sphere: {radius: 0.1}}\n"
        "pairs: [{between: [arm, wall]}, {between: [box, wall]}]\n",
        more);
  }

  Participant second{dds};
};

// The publisher then falls silent: the object is late by the age limit, and is named.
TEST_F(DaemonFrames, PlaceAnObjectAndTheBaseOfARobot) {
  start();
  RosFrames frames(client);
  RosJoints joints(client);
  ASSERT_TRUE(frames.is_heard() && joints.is_heard());
  const auto send_joints = [&] { joints.send({"shoulder", "elbow", "push"}, {0, 0, 0.1}); };
  const auto send = [&] {
    send_joints();
    frames.send({{"map", "mir", {1, 0, 0}}, {"mir", "box_link", {0.5, 0, 0}}});
  };
  ASSERT_TRUE(step_until(5, send, [&] {
    return is("box", PairStatus::kConverged) && is("finger", PairStatus::kConverged);
  })) << daemon->output();
  EXPECT_NEAR(pair("box").distance, 5 - 1.5 - 0.1, 1e-12);
  EXPECT_NEAR(pair("finger").distance, 5 - 1 - 2.1 - 0.05, 1e-12);
  EXPECT_TRUE(step_until(5, send_joints, [&] {
    return is("box", PairStatus::kStale) && is("finger", PairStatus::kUnknown);
  })) << "nothing bounds how fast a base moves";
  EXPECT_TRUE(step_until(5, send_joints, told("poses-late", {" box "}))) << daemon->output();
}

// The changed cell has the objects in another order, and one more that follows a frame. Neither tf
// nor joint states state a revision, so they go on, and a recording of both replays to the bit.
TEST_F(DaemonFrames, AndJointsGoOnWhenTheCellChangesAndReplayToTheBit) {
  const std::string file = (folder / "run.mcap").string();
  start({"--record", file});
  RosFrames frames(client);
  RosJoints joints(client);
  ASSERT_TRUE(frames.is_heard() && joints.is_heard());
  const auto send = [&] {
    joints.send({"shoulder", "elbow", "push"}, {0, 0, 0.1});
    frames.send({{"map", "mir", {1, 0, 0}}, {"mir", "box_link", {0.5, 0, 0}}, {"mir", "lid_link"}});
  };
  const auto are_known = [&] {
    return is("box", PairStatus::kConverged) && is("finger", PairStatus::kConverged);
  };
  ASSERT_TRUE(step_until(5, send, are_known)) << daemon->output();
  std::string text = read_text(cell);
  const std::string wall =
      "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n";
  text.replace(text.find(wall), wall.size(),
               "  - {name: lid, frame: lid_link, max_speed: 50, sphere: {radius: 0.2}}\n");
  text.replace(text.find("pairs:"), 0, wall);
  text.replace(text.find("[{between: [arm, wall]}"), 1, "[{between: [lid, wall]}, ");
  write_text(cell, text);
  read = std::get<Cell>(read_cell(cell));
  daemon->signal(SIGHUP);
  ASSERT_TRUE(step_until(5, send, [&] { return report->scene_revision == scene.revision; }))
      << daemon->output();
  EXPECT_TRUE(is("finger", PairStatus::kConverged)) << "what was known stays known";
  ASSERT_TRUE(step_until(5, send, [&] { return are_known() && is("lid", PairStatus::kConverged); }))
      << daemon->output();
  EXPECT_NEAR(pair("lid").distance, 5 - 1 - 0.2, 1e-12);
  EXPECT_NEAR(pair("box").distance, 5 - 1.5 - 0.1, 1e-12);
  EXPECT_NEAR(pair("finger").distance, 5 - 1 - 2.1 - 0.05, 1e-12);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess replay(kReplay, {"check", file, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

TEST_F(DaemonFrames, ThatAreMissingAreNamedWithThoseThatThereAre) {
  start();
  RosFrames frames(client);
  ASSERT_TRUE(frames.is_heard());
  EXPECT_TRUE(step_until(
      5,
      [&] {
        frames.send({{"map", "box_lnk"}, {"odom", "mir"}});
      },
      told("frame-missing", {"box", "'box_link'", "box_lnk, mir", "'box_lnk'"})))
      << daemon->output();
  EXPECT_TRUE(step_until(
      5, [] {}, told("frame-missing", {"arm", "'mir'", "'odom'", "'map'"})))
      << daemon->output();
  EXPECT_TRUE(step_until(
      5,
      [&] {
        frames.send({{"a", "box_link"}, {"box_link", "a"}});
      },
      told("frame-missing", {"(box_link, a, box_link)"})))
      << daemon->output();
  EXPECT_TRUE(step_until(
      5,
      [&] {
        frames.send({{"map", "a"}, {"a", "box_link"}});
      },
      told("frame-found", {"'box_link'", "box"})))
      << daemon->output();
  EXPECT_TRUE(daemon->tells("frame-moved", {"'a'", "'map'", "'box_link'"}));
}

TEST_F(DaemonFrames, OfTwoPublishersAndOfAnotherClockAreNamed) {
  start();
  RosFrames first(client), other(second);
  ASSERT_TRUE(first.is_heard() && other.is_heard());
  const auto both = [&] {
    first.send({{"map", "box_link", {1, 0, 0}}});
    other.send({{"map", "box_link", {2, 0, 0}}});
  };
  EXPECT_TRUE(step_until(5, both, told("frame-of-two", {"'box_link'"}))) << daemon->output();
  EXPECT_TRUE(step_until(5, both, [&] { return is("box", PairStatus::kUnknown); }));
  // One of them falls silent.
  EXPECT_TRUE(step_until(
      10,
      [&] {
        first.send({{"map", "box_link", {1, 0, 0}}});
      },
      [&] { return is("box", PairStatus::kConverged); }));
  EXPECT_TRUE(step_until(
      5,
      [&] {
        other.send_at(dds_time() - 100'000'000'000, {{"map", "mir"}});
      },
      told("other-clock", {"'mir'", "-100.00", "'stamps: sent'", "'ros2'"})))
      << daemon->output();
}

// Objects and bases with static and changing transforms. During the run one rotates and one gets a
// new parent.
TEST_F(DaemonFrames, OfARecordingReplayToTheBit) {
  const std::string recording = folder / "run.mcap";
  start({"--record", recording});
  RosFrames frames(client), fixed(second, RosFrames::Kind::kStatic);
  RosJoints joints(client);
  ASSERT_TRUE(frames.is_heard() && fixed.is_heard() && joints.is_heard());
  fixed.send({{"mir", "rack", {0.1, 0.2, 0.3}}});
  double t = 0.0;
  ASSERT_TRUE(step_until(
      5,
      [&] {
        t += 0.005;
        joints.send({"shoulder", "elbow", "push"}, {t, -t, 0.1});
        const double half = 0.3 * t;
        frames.send({{"map", "mir", {t, 0, 0}, {0, 0, std::sin(half), std::cos(half)}},
                     {t < 0.5 ? "rack" : "map", "box_link", {0, t, 0}}});
      },
      [&] { return t > 1.0; }));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess replay(kReplay, {"check", "--cell", cell, recording, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

}  // namespace
}  // namespace clearance::test
