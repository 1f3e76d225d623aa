// Octomaps as sensors, by octomap_msgs and in MoveIt's planning scenes.
//
// Oracle: the place of the cubes that the test puts in.
#include <gtest/gtest.h>

#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/one_cube.hpp"

namespace clearance::sensors_test {
namespace {

using test::one_cube;

constexpr double kResolution = 0.1;
const std::string kMap = "octomap: /map, range: 10, age_limit_ms: 2000";

std::vector<std::byte> map_message(const std::string& bytes, std::int64_t stamp_ns,
                                   const std::string& id = "OcTree",
                                   const std::string& frame = "camera",
                                   double resolution = kResolution) {
  return test::camera::map_cdr(bytes, stamp_ns, id, frame, resolution);
}

// The maps of two cubes as one. The cubes are in different children of a node, the first one in the
// lower child. Nodes are depth first, in order.
std::string joined(const std::string& near, const std::string& far) {
  std::size_t same = 0;
  while (near.substr(2 * same, 2) == far.substr(2 * same, 2)) ++same;
  std::string both = near.substr(0, 2 * same);
  both += static_cast<char>(near[2 * same] | far[2 * same]);
  both += static_cast<char>(near[2 * same + 1] | far[2 * same + 1]);
  return both + near.substr(2 * same + 2) + far.substr(2 * same + 2);
}

class OctomapsTest : public SensorsTest {
 protected:
  void add_map(Type type, const std::vector<std::byte>& cdr, std::int64_t sent_ns) {
    sensors->add({.type = type, .topic = "/map", .sent_ns = sent_ns, .writer = 1, .cdr = cdr},
                 {.realtime_ns = sent_ns, .monotonic_ns = sent_ns});
  }
  // The pair of the cart, a ball of 0.1 m.
  PairReport cart(const std::vector<SensorFrame>& frames, std::int64_t now_ns,
                  const Pose& at = {}) {
    Monitor monitor(cell.scene);
    for (const SensorFrame& frame : frames) EXPECT_TRUE(monitor.show(0, frame));
    const Report& report = monitor.tick(std::vector{test::sample(0, at, now_ns)}, now_ns);
    for (const PairReport& pair : report.pairs) {
      if (cell.scene.pairs[pair.pair].first == 0) return pair;
    }
    ADD_FAILURE() << "no pair of the cart";
    return {};
  }
};

TEST_F(OctomapsTest, AreCubesOfTheirResolutionAtThePlaceThatTheCellStates) {
  make(kMap + ", mount: {pose: {xyz: [0.5, 0, 0]}}");
  // The cube from (1, 0, 0) to (1.1, 0.1, 0.1) of the map's frame.
  add_map(Type::kOctomap, map_message(one_cube({10, 0, 0}), kStart), kStart);
  const auto frames = settle(kStart + 1000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 1u);
  const PairReport pair = cart(frames, kStart + 1'000'000);
  EXPECT_NEAR(pair.lower, 1.5 - 0.1, 1e-6);
  EXPECT_LE(pair.lower, 1.4);
  EXPECT_NEAR(pair.upper, 1.4, 1e-6);
  // The same map under a newer stamp is that of a map that nothing has changed.
  add_map(Type::kOctomap, map_message(one_cube({10, 0, 0}), kStart + kFrame), kStart + kFrame);
  EXPECT_EQ(settle(kStart + kFrame + 1000).size(), 1u);
}

// A map may be from before the daemon's start. The cube is within the arm.
TEST_F(OctomapsTest, FromBeforeTheFirstJointsHaveTheRobotAsAnObstacle) {
  make(kMap + ", own_shell: 0.05, mount: {pose: {xyz: [0, 0, 0]}}");
  add_joints(0.0, kStart + kFrame);
  add_map(Type::kOctomap, map_message(one_cube({5, 0, 0}), kStart), kStart + kFrame);
  const auto old = settle(kStart + 2 * kFrame);
  ASSERT_EQ(old.size(), 1u);
  EXPECT_EQ(old[0].cloud->size(), 1u);
  add_joints(0.0, kStart + 3 * kFrame);
  add_map(Type::kOctomap, map_message(one_cube({5, 0, 0}), kStart + 3 * kFrame),
          kStart + 3 * kFrame);
  EXPECT_TRUE(settle(kStart + 4 * kFrame).empty());
  EXPECT_EQ(count(FrameFault::kNothingSeen), 1u) << "now it is known to be the arm";
}

// Eight small cubes of one kind are sent as a larger one, and so on. The upper arm touches one of
// 0.8 m, from (0.2, 0.02, -0.1) on.
TEST_F(OctomapsTest, HaveLargeCubesThatAreNotOnlyTheImageOfALinkThatTouchesThem) {
  for (const std::string trusted : {"", ", trusted_shell: 0.9"}) {
    make(kMap + trusted + ", mount: {pose: {xyz: [0.2, 0.02, -0.1]}}");
    add_joints(0.0, kStart);
    add_map(Type::kOctomap,
            map_message(joined(one_cube({0, 0, 0}, 13), one_cube({60, 0, 0})), kStart), kStart);
    const auto frames = settle(kStart + 1000);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].cloud->size(), 1u) << "the other one is left out";
    Pose at;
    at.position = {0.6, 1.2, 0.3};
    const PairReport pair = cart(frames, kStart + 1'000'000, at);
    if (trusted.empty()) {
      EXPECT_LE(pair.lower, 1.2 - 0.82 - 0.1);
      EXPECT_NEAR(pair.lower, 1.2 - 0.82 - 0.1, 1e-6);
    } else {
      EXPECT_GT(pair.lower, 4.0) << "as the cell states";
    }
  }
}

TEST_F(OctomapsTest, ComeFromThePlanningScenesOfMoveIt) {
  make(kMap, "ros2: {world_frame: map}\n");
  test::RosCdr with_map, without;
  clearance::moveit::PlanningScene scene;
  scene.is_diff = true;
  clearance::moveit::put(without, scene);
  scene.has_octomap = true;
  clearance::moveit::put(with_map, scene, one_cube({0, 0, 7}));
  add_map(Type::kPlanningScene, without.bytes(), kStart);
  EXPECT_TRUE(settle(kStart + 30'000'000).empty());
  EXPECT_EQ(count(FrameFault::kOctree), 0u) << "a change of something else";
  // The stamp is 0: the time of sending counts.
  add_map(Type::kPlanningScene, with_map.bytes(), kStart + kFrame);
  const auto frames = settle(kStart + kFrame + 30'000'000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].stamp_ns, kStart + kFrame);
  EXPECT_NEAR(cart(frames, kStart + kFrame + 30'000'000).lower, 0.7 - 0.1, 1e-6);
}

// MoveIt sends the map that it has whenever it sends a whole scene, also after its camera died.
TEST_F(OctomapsTest, WithoutAStampGrowOldThoughTheyAreSentAgain) {
  make(kMap, "ros2: {world_frame: map}\n");
  const auto send = [&](const std::string& tree, std::int64_t sent_ns) {
    clearance::moveit::PlanningScene scene;
    scene.is_diff = true;
    scene.has_octomap = true;
    test::RosCdr cdr;
    clearance::moveit::put(cdr, scene, tree);
    add_map(Type::kPlanningScene, cdr.bytes(), sent_ns);
    return settle(sent_ns + 30'000'000);
  };
  const auto first = send(one_cube({0, 0, 7}), kStart);
  ASSERT_EQ(first.size(), 1u);
  for (int second = 1; second <= 3; ++second)
    EXPECT_TRUE(send(one_cube({0, 0, 7}), kStart + second * 1'000'000'000LL).empty());
  EXPECT_EQ(count(FrameFault::kFrozen), 3u);
  EXPECT_EQ(cart(first, kStart + 1'000'000'000).status, PairStatus::kConverged);
  EXPECT_EQ(cart(first, kStart + 3'000'000'000).status, PairStatus::kUnknown);
  // A changed cell keeps the map with the time that it had, and needs no other.
  const auto before = std::move(sensors);
  sensors = std::make_unique<Sensors>(cell, *before, SourceNumbers(cell.scene));
  const auto again = settle(kStart + 3'500'000'000LL);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].stamp_ns, kStart);
  EXPECT_NEAR(cart(again, kStart + 30'000'000).lower, 0.7 - 0.1, 1e-6);
  EXPECT_TRUE(send(one_cube({0, 0, 7}), kStart + 3'600'000'000LL).empty());
  // A map that has changed is always a new one.
  for (unsigned second = 4; second < 8; ++second) {
    const std::int64_t sent_ns = kStart + second * 1'000'000'000LL;
    const auto next = send(one_cube({0, 0, 7 + second}), sent_ns);
    ASSERT_EQ(next.size(), 1u);
    EXPECT_EQ(next[0].stamp_ns, sent_ns);
  }
}

TEST_F(OctomapsTest, AreRefusedByCauseIfTheyAreDamagedOrEmpty) {
  make(kMap + kAbove);
  std::int64_t stamp = kStart;
  const auto refuses = [&](const std::string& bytes, const std::string& id, FrameFault fault) {
    const std::uint64_t before = count(fault);
    stamp += kFrame;
    add_map(Type::kOctomap, map_message(bytes, stamp, id), stamp);
    EXPECT_TRUE(settle(stamp + 1000).empty());
    EXPECT_EQ(count(fault), before + 1) << text(fault);
  };
  const std::string good = one_cube({1, 2, 3});
  refuses(good.substr(0, 9), "OcTree", FrameFault::kOctree);
  refuses(good, "SemanticOcTree", FrameFault::kFormChanged);
  refuses("", "OcTree", FrameFault::kNothingSeen);
  refuses(one_cube({1000, 0, 0}).substr(0, 30) + std::string(2, '\0'), "OcTree",
          FrameFault::kNothingSeen);
  refuses(std::string("\x00\x80", 2), "OcTree", FrameFault::kCannotBuild);  // an eighth of the tree
  make(kMap + kAbove);
  refuses(good, "SemanticOcTree", FrameFault::kOctree);
}

TEST_F(OctomapsTest, OfAnotherFrameOrResolutionThanTheFirstAreRefusedUntilTheFirstComesAgain) {
  make(kMap + ", mount: {pose: {xyz: [0, 0, 0]}}");
  std::int64_t stamp = kStart;
  const auto frames = [&](const std::string& frame, double resolution) {
    stamp += kFrame;
    add_map(Type::kOctomap, map_message(one_cube({5, 0, 0}), stamp, "OcTree", frame, resolution),
            stamp);
    return settle(stamp + 1000).size();
  };
  ASSERT_EQ(frames("camera", 0.1), 1u);
  EXPECT_EQ(frames("base", 0.1), 0u);
  EXPECT_EQ(count(FrameFault::kFrameChanged), 1u);
  EXPECT_EQ(frames("camera", 0.2), 0u);
  EXPECT_EQ(count(FrameFault::kFormChanged), 1u);
  EXPECT_EQ(frames("camera", 0.1), 1u);
}

// The ball around the reaches of both robots is larger than what a map of this range can hold.
TEST_F(OctomapsTest, AreNotRefusedWhereRobotsAreFartherApartThanTheRange) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: left, urdf: scara.urdf, prefix: left_}\n"
      "  - {name: right, urdf: scara.urdf, prefix: right_, base: {pose: {xyz: [27, 0, 0]}}}\n"
      "sensors:\n  - {name: eye, " +
          kMap +
          ", reach: 0, mount: {pose: {xyz: [0, 0, 0]}}}\n"
          "pairs: [{between: [left, eye]}, {between: [right, eye]}]\n",
      folder / "cell.yaml");
  ASSERT_EQ(cell.scene.sensors[0].crop.size(), 2u);
  sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
  const std::string both = joined(one_cube({30, 0, 0}), one_cube({270, 0, 0}));
  add_map(Type::kOctomap, map_message(both, kStart), kStart);
  const auto frames = settle(kStart + 1000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 1u);
  EXPECT_EQ(sensors->status(0).cropped, 1u);
}

// A cube that is 100 m away is beyond the range of 10 m. It is not dropped: the distance is at
// least that to the range's end.
TEST_F(OctomapsTest, BeyondTheRangeAreKnownToBeThere) {
  make(kMap + ", mount: {pose: {xyz: [0, 0, 0]}}");
  const std::string both = joined(one_cube({90, 0, 0}), one_cube({90, 0, 1000}));
  add_map(Type::kOctomap, map_message(both, kStart), kStart);
  const auto frames = settle(kStart + 1000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 1u);
  EXPECT_EQ(sensors->status(0).cropped, 1u);
  Monitor monitor(cell.scene);
  EXPECT_TRUE(monitor.show(0, frames[0]));
  // At 9.5 m along z, the ball of 0.1 m is 0.4 m from the end of the range.
  const Report& report =
      monitor.tick(std::vector{test::sample(0, test::at(0, 0, 9.5), kStart)}, kStart + 1'000'000);
  const auto pair = std::ranges::find_if(
      report.pairs, [&](const PairReport& each) { return cell.scene.pairs[each.pair].first == 0; });
  ASSERT_NE(pair, report.pairs.end());
  EXPECT_NEAR(pair->lower, 0.4, 1e-6);
  EXPECT_GT(pair->upper, 9.0);
  // Beside the far cube, which begins at 100 m: however far from the map, something may be there.
  for (const double z : {12.0, 25.0, 99.0}) {
    Monitor far_off(cell.scene);
    EXPECT_TRUE(far_off.show(0, frames[0]));
    const Report& beyond =
        far_off.tick(std::vector{test::sample(0, test::at(9, 0, z), kStart)}, kStart + 1'000'000);
    const auto of_cart = std::ranges::find_if(beyond.pairs, [&](const PairReport& each) {
      return cell.scene.pairs[each.pair].first == 0;
    });
    ASSERT_NE(of_cart, beyond.pairs.end());
    EXPECT_LE(of_cart->lower, 0.9) << z;
    EXPECT_FALSE(beyond.lower_all > 0.9) << z;
  }
}

}  // namespace
}  // namespace clearance::sensors_test
