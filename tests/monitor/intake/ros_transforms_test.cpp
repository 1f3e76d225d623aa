// Transforms of ROS 2, given as bytes, become poses of the objects that follow frames.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "monitor/intake/tracked_frames.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

constexpr double kHalf = 0.70710678118654757;  // half of sqrt(2)
constexpr std::int64_t kTransformMs = 1'000'000;
constexpr const char* kStatic = "/tf_static";

class RosTransformsTest : public testing::Test {
 protected:
  // A cart and a tool that follow frames, and a robot whose base follows one.
  static Cell framed_cell(const std::string& ros) {
    const ScratchFolder folder;
    write_text(folder / "scara.urdf", kScaraUrdf);
    return read_good(
        "name: test\nunits: {length: m, angle: rad}\n" + ros +
            "robots:\n  - {name: arm, urdf: scara.urdf, prefix: r_, base: {frame: mir/top, "
            "pose: {xyz: [0, 0, 0.5]}, age_limit_ms: 300}}\n"
            "objects:\n  - {name: cart, frame: cart_link, age_limit_ms: 60, sphere: {radius: "
            "0.1}}\n"
            "  - {name: tool, frame: tool0, age_limit_ms: 60, sphere: {radius: 0.1}}\n"
            "pairs: [{between: [arm, cart]}, {between: [cart, tool]}]\n",
        folder / "cell.yaml");
  }

  explicit RosTransformsTest(const std::string& ros = "ros2: {world_frame: map}\n")
      : cell(framed_cell(ros)) {}

  [[nodiscard]] std::int64_t now() const { return heard.now.realtime_ns; }
  void send_at(std::int64_t stamp_ns, const std::vector<FrameText>& frames,
               const std::string& topic = "/tf", std::uint64_t writer = 1) {
    EXPECT_TRUE(heard.take(transforms(now(), stamp_ns, frames, topic), writer));
  }
  // Sends frames stamped with the current time, one millisecond after the previous message.
  void send(const std::vector<FrameText>& frames, const std::string& topic = "/tf",
            std::uint64_t writer = 1) {
    heard.pass(kTransformMs);
    send_at(now(), frames, topic, writer);
  }
  // Returns the batches that result from the messages sent so far.
  std::vector<PoseBatch> settled() {
    heard.settle();
    return heard.all();
  }
  // The position of an object in the only resulting batch.
  Vec3 place_of(std::uint32_t object) {
    const std::vector<PoseBatch> batches = settled();
    EXPECT_EQ(batches.size(), 1u);
    for (const PoseBatch& batch : batches) {
      for (const PoseSample& sample : batch.samples) {
        if (sample.object == object) return sample.world_from_object.position;
      }
    }
    ADD_FAILURE() << "no pose of object " << object;
    return Vec3::Zero();
  }

  // The x of an object by the source that states it.
  using Places = std::map<std::string, double>;
  Places places_of(std::uint32_t object) {
    Places places;
    for (const PoseBatch& batch : settled()) {
      for (const PoseSample& sample : batch.samples) {
        if (sample.object == object)
          places[std::string(batch.source.view())] = sample.world_from_object.position.x();
      }
    }
    return places;
  }

  Cell cell;
  Heard heard{cell};
};

// Objects: cart 0, tool 1.
TEST_F(RosTransformsTest, LeadThroughParentsToTheWorldWithTheStampOfTheOldest) {
  send_at(now(), {{"cart", "cart_link", {0, 0, 1}}}, kStatic, 2);
  send_at(now() - 30 * kTransformMs, {{"odom", "cart", {3, 0, 0}}});
  send_at(now() - 20 * kTransformMs, {{"map", "odom", {1, 2, 0}, {0, 0, kHalf, kHalf}}});
  send_at(now() - 5 * kTransformMs,
          {{"odom", "cart", {3, 0, 0}}, {"/nowhere", "wheel", {9, 9, 9}}});
  std::vector<PoseBatch> batches = settled();
  ASSERT_EQ(batches.size(), 1u);
  EXPECT_EQ(batches[0].source.view(), "/tf");
  EXPECT_EQ(batches[0].sequence_number, 1u);
  ASSERT_EQ(batches[0].samples.size(), 1u);
  const PoseSample& sample = batches[0].samples[0];
  EXPECT_EQ(sample.object, 0u);
  EXPECT_EQ(sample.stamp_ns, now() - 20 * kTransformMs);
  // 3 m along odom's x, which is the map's y.
  EXPECT_NEAR((sample.world_from_object.position - Vec3(1, 5, 1)).norm(), 0.0, 1e-12);
  EXPECT_FALSE(sample.has_twist);
  // A transform that does not change the oldest stamp brings no new information.
  send_at(now() - 1 * kTransformMs, {{"odom", "cart", {4, 0, 0}}});
  EXPECT_TRUE(settled().empty());
  send_at(now() - 1 * kTransformMs, {{"map", "odom", {1, 2, 0}}});
  batches = settled();
  ASSERT_EQ(batches.size(), 1u);
  EXPECT_EQ(batches[0].sequence_number, 2u);
  EXPECT_EQ(batches[0].samples[0].stamp_ns, now() - 1 * kTransformMs);
  EXPECT_EQ(batches[0].samples[0].world_from_object.position, Vec3(5, 2, 1));
}

// A static transform is valid at any time. It is repeated before it becomes late.
TEST_F(RosTransformsTest, OfTfStaticHoldForGood) {
  send({{"map", "cart_link", {0.5, 0, 0}}}, kStatic);
  EXPECT_EQ(heard.intake.patience_ns(), 20 * kTransformMs);
  for (int i = 0; i < 5; ++i) {
    const std::vector<PoseBatch> batches = settled();
    ASSERT_EQ(batches.size(), 1u) << i;
    EXPECT_EQ(batches[0].samples.at(0).stamp_ns, now());
    EXPECT_EQ(batches[0].samples[0].world_from_object.position, Vec3(0.5, 0, 0));
    heard.pass(10 * kTransformMs);
    EXPECT_TRUE(settled().empty()) << "not so soon again";
    heard.pass(10 * kTransformMs);
  }
}

// Nothing tells which of two publishers is right: the tick gets both, as two sources.
TEST_F(RosTransformsTest, OfTwoPublishersOfAFrameAreTwoSources) {
  heard.intake.keep({1, 2});
  send({{"map", "cart_link", {1, 0, 0}}}, "/tf", 1);
  send({{"map", "cart_link", {2, 0, 0}}}, "/tf", 2);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 1.0}, {"/tf#2", 2.0}}));
  EXPECT_EQ(heard.told(lines::kFrameOfTwo.code), 1u);
  // The first publisher is silent for a second.
  heard.pass(kSourceSilentNs);
  send({{"map", "cart_link", {2.1, 0, 0}}}, "/tf", 2);
  EXPECT_EQ(places_of(0), (Places{{"/tf#2", 2.1}}));
  // The second publisher has left.
  heard.intake.keep({1});
  send({{"map", "cart_link", {1, 0, 0}}}, "/tf", 1);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 1.0}}));
}

// The tick recognises the second source as another writer of the first one's name.
TEST_F(RosTransformsTest, OfTwoPublishersOfABaseHaveNumbersAtTheEndOfTheirNames) {
  heard.intake.keep({1, 2, 3});
  send({{"map", "mir/top", {1, 0, 0}}}, "/tf", 1);
  send({{"map", "mir/top", {2, 0, 0}}}, "/tf", 2);
  send({{"map", "mir/top", {3, 0, 0}}}, kStatic, 3);
  std::vector<std::string> sources;
  for (const PoseBatch& batch : settled()) sources.emplace_back(batch.source.view());
  EXPECT_EQ(sources, (std::vector<std::string>{"/tf:bases", "/tf:bases#2", "/tf_static:bases"}));
}

// A static transform never ages, so its publisher may be one that was forgotten.
TEST_F(RosTransformsTest, OnTfAndOnTfStaticAreTwoSourcesWhicheverCameFirst) {
  heard.intake.keep({1, 2});
  send({{"map", "cart_link", {1, 0, 0}}}, kStatic, 1);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 1.0}}));
  heard.pass(100 * kSourceSilentNs);
  send({{"map", "cart_link", {2, 0, 0}}}, "/tf", 2);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 2.0}, {"/tf_static", 1.0}}));
  // The static one does not take over when the other falls silent.
  heard.pass(100 * kSourceSilentNs);
  EXPECT_EQ(places_of(0), (Places{{"/tf_static", 1.0}}));
  heard.intake.keep({2});
  send({{"map", "cart_link", {3, 0, 0}}}, "/tf", 2);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 3.0}}));
}

// A rival may claim a frame in the middle of the path, and give it another parent.
TEST_F(RosTransformsTest, OfARivalLeadThroughItsOwnParents) {
  heard.intake.keep({1, 2});
  send({{"map", "odom", {1, 0, 0}}, {"odom", "cart_link", {0.5, 0, 0}}}, "/tf", 1);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 1.5}}));
  send({{"map", "other", {7, 0, 0}}, {"other", "odom", {2, 0, 0}}}, "/tf", 2);
  EXPECT_EQ(places_of(0), (Places{})) << "where the cart is by the other one is not known yet";
  send({{"map", "odom", {1, 0, 0}}, {"odom", "cart_link", {0.5, 0, 0}}}, "/tf", 1);
  EXPECT_EQ(places_of(0), (Places{{"/tf", 1.5}, {"/tf#2", 9.5}}));
}

// An invalid pose leaves the frame where it was. Frames without names are also refused.
TEST_F(RosTransformsTest, ThatAreNoPosesAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  send({{"map", "cart_link", {8, 0, 0}}});
  const std::vector<FrameText> no_poses{{"map", "cart_link", {kNaN, 0, 0}},
                                        {"map", "cart_link", {7, 0, 0}, {0, 0, 0, 0}},
                                        {"map", "cart_link", {7, 0, 0}, {0, 0, 0, 1.01}},
                                        {"cart_link", "cart_link", {7, 0, 0}},
                                        {"", "cart_link", {7, 0, 0}},
                                        {"map", "", {7, 0, 0}}};
  for (const FrameText& frame : no_poses) send({frame});
  EXPECT_EQ(place_of(0), Vec3(8, 0, 0));
  EXPECT_EQ(heard.told(lines::kFrameRefused.code), 2u) << "once for each frame";
}

// Neither could be meant, as of two positions of one joint in one message.
class FramesPlacedTwice : public RosTransformsTest,
                          public testing::WithParamInterface<const char*> {};

TEST_P(FramesPlacedTwice, InOneMessageAreRefusedAndThoseBesideThemUsed) {
  send({{"map", "tool0", {4, 0, 0}}}, GetParam());
  send({{"map", "tool0", {5, 0, 0}}, {"map", "cart_link", {8, 0, 0}}, {"map", "tool0", {6, 0, 0}}},
       GetParam());
  const std::vector<PoseBatch> batches = settled();
  ASSERT_EQ(batches.size(), 1u);
  ASSERT_EQ(batches[0].samples.size(), 2u);
  EXPECT_EQ(batches[0].samples[0].world_from_object.position, Vec3(8, 0, 0));
  EXPECT_EQ(batches[0].samples[1].world_from_object.position, Vec3(4, 0, 0));
  EXPECT_EQ(heard.told(lines::kFrameRefused.code), 1u);
  heard.pass(20 * kTransformMs);
  send({{"map", "tool0", {5, 0, 0}}, {"map", "tool0", {5, 0, 0}}}, GetParam());
  EXPECT_EQ(place_of(1), Vec3(5, 0, 0)) << "they say the same";
}
INSTANTIATE_TEST_SUITE_P(OfTf, FramesPlacedTwice, testing::Values("/tf", kStatic));

// A publisher may send what it has collected: transforms of several times.
TEST_F(RosTransformsTest, OfSeveralTimesInOneMessageCountInTheirOrder) {
  RosCdr cdr;
  cdr.number(std::uint32_t{2});
  for (const int ms : {0, 5}) {
    cdr.header(now() + ms * kTransformMs, "map").text("cart_link");
    for (const double number : {8.0 + ms, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) cdr.number(number);
  }
  heard.pass(5 * kTransformMs);
  EXPECT_TRUE(heard.take({"/tf", "tf2_msgs/msg/TFMessage", now(), cdr.bytes()}, 1));
  EXPECT_EQ(place_of(0), Vec3(13, 0, 0));
  EXPECT_EQ(heard.told(lines::kFrameRefused.code), 0u);
}

TEST_F(RosTransformsTest, ThatGoRoundInACircleSayNothingUntilTheyDoNot) {
  send({{"a", "cart_link"}, {"b", "a"}, {"cart_link", "b"}, {"map", "tool0", {3, 0, 0}}});
  const std::vector<PoseBatch> batches = settled();
  ASSERT_EQ(batches.size(), 1u);
  ASSERT_EQ(batches[0].samples.size(), 1u);
  EXPECT_EQ(batches[0].samples[0].object, 1u);
  // The frame gets another parent.
  send({{"map", "b", {1, 0, 0}}});
  EXPECT_TRUE(settled().empty()) << "the others are older";
  send({{"a", "cart_link"}, {"b", "a"}});
  EXPECT_EQ(place_of(0), Vec3(1, 0, 0));
}

// A gripper takes a tool from a rack.
TEST_F(RosTransformsTest, OfAFrameWithAnotherParentAreUsedAtOnce) {
  send({{"map", "rack", {1, 0, 0}}, {"map", "hand", {0, 1, 0}}, {"rack", "tool0"}});
  EXPECT_EQ(place_of(1), Vec3(1, 0, 0));
  send({{"map", "rack", {1, 0, 0}}, {"map", "hand", {0, 1, 0}}, {"hand", "tool0"}});
  EXPECT_EQ(place_of(1), Vec3(0, 1, 0));
  EXPECT_EQ(heard.told(lines::kFrameMoved.code), 1u);
}

TEST_F(RosTransformsTest, WithoutAStampHoldWhenTheyWereSent) {
  send_at(0, {{"map", "cart_link"}});
  EXPECT_EQ(settled().at(0).samples.at(0).stamp_ns, now());
}

// The joint that carries the robot has seven positions. q and -q are the same orientation.
TEST_F(RosTransformsTest, CarryTheBaseOfARobot) {
  send({{"map", "mir/top", {1, 2, 3}, {0, 0, kHalf, kHalf}}});
  const PoseBatch batch = settled().at(0);
  EXPECT_EQ(batch.source.view(), "/tf:bases");
  const std::vector<double> expected = {1, 2, 3.5, 0, 0, kHalf, kHalf};
  ASSERT_EQ(batch.joints.size(), 7u);
  const std::vector<JointVariable>& variables = cell.scene.variables;
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(batch.joints[i].position, expected[i], 1e-15);
    EXPECT_TRUE(variables.at(batch.joints[i].variable).name.starts_with("r_arm_base/"));
    EXPECT_EQ(variables[batch.joints[i].variable].age_limit_ns, 300 * kTransformMs);
  }
  send({{"map", "mir/top", {1, 2, 3}, {0, 0, -kHalf, -kHalf}}});
  EXPECT_GT(settled().at(0).joints.at(6).position, 0.0);
}

TEST_F(RosTransformsTest, ThatAreMissingAreToldAfterFiveSeconds) {
  heard.settle();
  heard.pass(RosTransforms::kMissingNs - 1);
  heard.settle();
  EXPECT_EQ(heard.news.size(), 0u);
  heard.pass(1);
  heard.settle();
  EXPECT_EQ(heard.told(lines::kNoTransforms.code), 3u) << "the cart, the tool and the base";
  send({{"map", "cart_link"}, {"earth", "tool0"}});
  heard.settle();
  EXPECT_EQ(heard.told(lines::kFrameFound.code), 1u);
  heard.pass(RosTransforms::kMissingNs);
  heard.settle();
  EXPECT_EQ(heard.told(lines::kFrameMissing.code), 1u) << "the tool, which leads elsewhere";
}

// In a log, tf may have any namespace. Objects without a configured frame follow the frame of their
// own name.
TEST_F(RosTransformsTest, OutOfALogSayWhereFollowersAre) {
  Heard log(cell, {.is_log = true});
  log.take(transforms(now(), now(), {{"map", "cart_link", {1, 0, 0}}}, "/r2/tf_static"), 0);
  EXPECT_EQ(log.one().source.view(), "/r2/tf");
  log.take(transforms(now() + 1, now() + 1, {{"map", "wheel"}}, "/r2/tf"), 0);
  EXPECT_TRUE(log.all().empty()) << "nothing is new";
  log.take(transforms(now() + 2, 5, {{"map", "tool0"}}, "/r2/tf"), 0);
  const PoseBatch tool = log.one();
  ASSERT_EQ(tool.samples.size(), 1u);
  EXPECT_EQ(tool.samples[0].stamp_ns, now() + 2) << "the stamp is of another clock";
}

// The platform goes back as fast as the cart on it goes forth, so that the cart stands still. The
// platform's transforms come ten times less often, and 30 ms late.
TEST_F(RosTransformsTest, OfOnePathAreThoseOfOneTime) {
  const std::int64_t begin = now();
  std::size_t count = 0;
  for (int step = 0; step <= 60; ++step) {
    const double s = 0.01 * step;
    send_at(now(), {{"plat", "cart_link", {s, 0, 0}}});
    if (step % 10 == 3)
      send_at(begin + (step - 3) * 10 * kTransformMs, {{"map", "plat", {0.8 - s + 0.03, 0, 0}}},
              "/tf", 2);
    for (const PoseBatch& batch : settled()) {
      for (const PoseSample& sample : batch.samples) {
        EXPECT_NEAR(sample.world_from_object.position.x(), 0.8, 1e-12) << step;
        EXPECT_EQ((sample.stamp_ns - begin) % (100 * kTransformMs), 0);
        ++count;
      }
    }
    heard.pass(10 * kTransformMs);
  }
  EXPECT_EQ(count, 6u);
}

// A rival without a path to the world contradicts as one with another place does.
TEST_F(RosTransformsTest, OfARivalThatLeadsNowhereLeaveTheFrameWithoutAPlace) {
  send({{"map", "cart_link", {1, 0, 0}}});
  EXPECT_EQ(settled().size(), 1u);
  send({{"lost", "cart_link", {1, 0, 0}}}, "/tf", 2);
  send({{"map", "cart_link", {1.1, 0, 0}}});
  EXPECT_TRUE(settled().empty());
  for (int i = 0; i < 25; ++i) {  // the rival is silent for more than a second
    heard.pass(50 * kTransformMs);
    send({{"map", "cart_link", {1.2, 0, 0}}});
  }
  EXPECT_FALSE(settled().empty());
}

// The cell's world is a frame of the tree, but not its root.
class RosTransformsToAWorld : public RosTransformsTest {
 protected:
  RosTransformsToAWorld() : RosTransformsTest("ros2: {world_frame: cell, stamps: sent}\n") {}
};

TEST_F(RosTransformsToAWorld, EndThereAndOthersAreNotUsed) {
  send_at(1'000, {{"map", "cell", {100, 0, 0}},
                  {"map", "tool0", {5, 0, 0}},
                  {"cell", "cart_link", {1, 0, 0}}});
  const PoseBatch batch = settled().at(0);
  ASSERT_EQ(batch.samples.size(), 1u) << "the tool hangs on the map";
  EXPECT_EQ(batch.samples[0].object, 0u);
  EXPECT_EQ(batch.samples[0].world_from_object.position, Vec3(1, 0, 0));
  EXPECT_EQ(batch.samples[0].stamp_ns, now()) << "stamps: sent";
}

// A recording has frames of that name for what carries the sensor, not for what it sees.
TEST(RosTransformsOfALog, MoveObjectsOfTheirNamesButNotWhatASensorSees) {
  const ScratchFolder folder;
  const Cell cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\n"
      "objects: [{name: tool, sphere: {radius: 0.1}}]\n"
      "sensors: [{name: eye, points: /points, most_points: 10, depth_error: {constant: 0.01}, "
      "range: [0.3, 4], mount: {pose: {xyz: [0, 0, 0]}}}]\n"
      "pairs: [{between: [tool, eye]}]\n",
      folder / "cell.yaml");
  const TrackedFrames tracked(cell, TrackedFrames::ByName::kYes);
  ASSERT_EQ(tracked.followers().size(), 1u);
  EXPECT_EQ(tracked.followers()[0].name, "tool");
}

// A robot with a known base pose defines the frames of its links. Transforms below a link start
// there.
TEST(RosTransformsOfLinks, BeginWhereTheCellHasTheRobot) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const Cell cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: world}\n"
      "robots: [{name: arm, urdf: scara.urdf, base: {pose: {xyz: [0, 0, 2]}}}]\n"
      "objects: [{name: tool, frame: tool0, sphere: {radius: 0.1}}]\n"
      "pairs: [{between: [arm, tool]}]\n",
      folder / "cell.yaml");
  Heard heard(cell);
  heard.take(transforms(heard.now.realtime_ns, heard.now.realtime_ns,
                        {{"foot", "upper", {0, 0, 0.5}}, {"upper", "tool0", {1, 0, 0}}}));
  heard.settle();
  EXPECT_EQ(heard.one().samples.at(0).world_from_object.position, Vec3(1, 0, 2.5));
}

}  // namespace
}  // namespace clearance::test
