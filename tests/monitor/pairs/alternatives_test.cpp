// Whether the closest points are the only ones. Oracles: closed forms for boxes, capsules and balls
// at chosen angles; in random poses, how far the closest points move when one body turns a little.
#include "monitor/pairs/alternatives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/distance.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/interface/gradient_rows.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

// Joints that turn one body about every axis.
const std::array kEveryTurn{Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())};

Pose turned(const Vec3& axis, double angle, const Vec3& position) {
  Pose pose;
  pose.position = position;
  pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
  return pose;
}

// Two parts in the world.
struct Placed {
  Placed(Part a, Part b, const Pose& world_from_b)
      : scene(
            test::cell_of({test::moving("a", {std::move(a)}), test::moving("b", {std::move(b)})})),
        parts(parts_of(scene)) {
    place_at({}, parts[0]);
    place_at(world_from_b, parts[1]);
  }
  [[nodiscard]] DistanceResult closest() const {
    TrackingState cold;
    return distance(*parts[0].shape, *parts[1].shape, parts[0].world_from_part,
                    parts[1].world_from_part, cold);
  }
  [[nodiscard]] double tilt(std::span<const Vec3> turns = kEveryTurn) const {
    const DistanceResult found = closest();
    EXPECT_EQ(found.status, DistanceStatus::kConverged);
    return tilt_of(parts[0], parts[1], {found.point_on_a, found.point_on_b, found.normal}, turns);
  }

  Scene scene;
  std::vector<PosedPart> parts;
};

Part cube() { return test::block({0.5, 0.5, 0.5}); }

TEST(Tilt, OfACubeOverAFloorIsTheAngleOfItsLowestFaceOrEdge) {
  for (const double angle : {0.0, 1e-5, 0.01, 0.2}) {
    // About x + y, the lowest feature is a vertex whose two lower edges rise alike.
    const Placed cell(test::floor(), cube(), turned({1, 1, 0}, angle, {0, 0, 2}));
    EXPECT_NEAR(cell.tilt(), std::sin(angle) * std::sqrt(0.5), 0.1 * angle + 1e-12) << angle;
    // About x, an edge stays parallel to the floor.
    EXPECT_LE(Placed(test::floor(), cube(), turned({1, 0, 0}, angle, {0, 0, 2})).tilt(), 1e-12);
  }
}

TEST(Tilt, IsNothingBetweenParallelFacesEdgesAndAxes) {
  EXPECT_EQ(Placed(cube(), cube(), turned({1, 0, 0}, 0.0, {2, 0.3, 0.2})).tilt(), 0.0);
  EXPECT_LE(Placed(test::capsule(1, 0.1), test::capsule(1, 0.2), test::at(0.3, 1, 0)).tilt(),
            1e-12);
  EXPECT_LE(Placed(test::capsule(1, 0.1), cube(), test::at(0.1, 0, 2)).tilt(), 1e-12);
}

TEST(Tilt, OfCrossingAxesIsTheirAngle) {
  for (const double angle : {0.001, 0.1, 1.0, 1.5}) {
    const Placed cell(test::capsule(2, 0.1), test::capsule(2, 0.1),
                      turned({0, 0, 1}, angle, {0, 0, 1}));
    EXPECT_NEAR(cell.tilt(), std::sin(angle), 1e-9);
  }
}

TEST(Tilt, OfABallIsOneAndOfACurvedBodyIsNotKnown) {
  EXPECT_EQ(Placed(test::ball(0.1), test::floor(), test::at(0, 0, -1)).tilt(), 1.0);
  EXPECT_EQ(Placed(cube(), test::ball(0.1), test::at(2, 0, 0)).tilt(), 1.0);
  const Part can{"can", test::made(cylinder(0.2, 1.0)), {}};
  EXPECT_TRUE(std::isnan(Placed(can, cube(), test::at(2, 0, 0)).tilt()));
}

TEST(Tilt, LeavesOutLinesThatNoJointTurns) {
  // The edge along z is parallel to the other cube's face, and joints turn about z only.
  const Placed cell(cube(), cube(), turned({0, 0, 1}, 0.1, {2, 0, 0}));
  EXPECT_LE(cell.tilt(), 1e-12);
  EXPECT_NEAR(cell.tilt(std::array{Vec3(Vec3::UnitZ())}), std::sin(0.1), 1e-9);
  EXPECT_EQ(cell.tilt({}), 1.0) << "joints that only slide";
}

TEST(Tilt, IsNotKnownOfCurvedBodiesAndOfPrismsWithoutEnd) {
  const HalfSpace rows[] = {{{1, 1, 0}, 0.5}, {{-1, 1, 0}, 0.5}, {{0, -1, 0}, 0.5}};
  const Part can{"can", test::made(cylinder(0.1, 0.4)), {}};
  const Part prism{"prism", test::made(polyhedron_from_halfspaces(rows)), {}};
  for (const Part& part : {can, prism}) {
    EXPECT_TRUE(std::isnan(Placed(part, cube(), test::at(0, 3, 0)).tilt())) << part.name;
    EXPECT_TRUE(std::isnan(Placed(cube(), part, test::at(0, 3, 0)).tilt())) << part.name;
  }
}

// Joints that turn about the normal alone do not tilt a face. About any axis across it they do.
TEST(Tilt, OfParallelFacesIsNothingUnlessNoJointTiltsThem) {
  const Placed beside(cube(), cube(), test::at(2, 0.3, 0.2)),
      above(cube(), cube(), test::at(0.3, 0.2, 2));
  for (int axis = 0; axis < 3; ++axis) {
    const std::array turns{Vec3(Vec3::Unit(axis))};
    EXPECT_EQ(beside.tilt(turns), axis == 0 ? 1.0 : 0.0) << axis;
    EXPECT_EQ(above.tilt(turns), axis == 2 ? 1.0 : 0.0) << axis;
  }
}

// If both bodies recede from the closest points steeply, a small turn moves these by little.
TEST(Tilt, IsSmallWhereASmallTurnMovesTheClosestPointsFar) {
  constexpr double kTurn = 1e-4;
  Random random(31);
  int jumps = 0, steady = 0, flat = 0, flat_and_jump = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 position = random.uniform(1.9, 3.0) * random.direction();
    Pose pose = turned(random.direction(), random.chance(0.5) ? 5e-5 : 2.0, position);
    if (random.chance(0.3)) pose.orientation.setIdentity();
    Part other = random.chance(0.5) ? cube() : test::capsule(1.0, 0.1);
    const Placed cell(cube(), std::move(other), pose);
    const DistanceResult before = cell.closest();
    const double tilt = cell.tilt();
    double moved = 0.0;
    for (const Vec3& axis : kEveryTurn) {
      for (const double turn : {-kTurn, kTurn}) {
        Placed after = cell;
        after.parts[1].shape = cell.parts[1].shape;
        Pose other_pose = pose;
        other_pose.orientation = Eigen::AngleAxisd(turn, axis) * pose.orientation;
        place_at(other_pose, after.parts[1]);
        moved = std::max(moved, (after.closest().point_on_a - before.point_on_a).norm());
      }
    }
    jumps += moved > 0.1;
    steady += moved < 0.01;
    if (moved > 0.1) {
      ASSERT_LE(tilt, 20.0 * kTurn) << i;
    }
    flat += tilt == 0.0;
    flat_and_jump += tilt == 0.0 && moved > 0.01;
  }
  EXPECT_GT(flat_and_jump, 0.9 * flat);
  EXPECT_GT(jumps, 200);
  EXPECT_GT(steady, 500);
}

// An arm of two links, and a cart of two balls before its finger.
class Alternatives : public testing::Test {
 protected:
  Alternatives() {
    scene.gradients = true;
    Object& cart = scene.objects[1];
    cart.parts = {test::ball(0.1, test::at(0, 0.3, 0)), test::ball(0.1, test::at(0, -0.3, 0))};
    for (std::uint32_t object = 2; object < scene.objects.size(); ++object)
      scene.pairs.push_back({1, object, true});
    std::ranges::sort(scene.pairs, {},
                      [](const ObjectPair& p) { return std::pair(p.first, p.second); });
    for (Zone& zone : scene.zones) zone.pairs = {0};
  }
  const Report& tick(const Vec3& cart, double shoulder = 0.0) {
    if (!monitor) monitor.emplace(scene);
    now += test::kTick;
    PoseSample sample;
    sample.object = 1;
    sample.stamp_ns = now;
    sample.world_from_object.position = cart;
    return monitor->tick({&sample, 1}, test::joints(shoulder, 0.0, 0.1, now), now);
  }
  // The alternative for the pair of these objects.
  GradientAlternative between(std::uint32_t first, std::uint32_t second, const Report& report) {
    const GradientRows rows = gradient_rows(scene);
    for (std::size_t r = 0; r < rows.rows.size(); ++r) {
      const ObjectPair& pair = scene.pairs[report.pairs[rows.rows[r].published].pair];
      if (pair.first == first && pair.second == second) return report.gradients.alternatives[r];
    }
    ADD_FAILURE() << "no such row";
    return {};
  }

  static constexpr std::uint32_t kWall = 0, kCart = 1, kUpper = 3, kFinger = 5;
  Scene scene = test::scara_cell();
  std::optional<Monitor> monitor;
  std::int64_t now = test::kStart;
};

// The finger's ball is at x = 2.1. Each ball of the cart is 0.5 m from there.
TEST_F(Alternatives, TwoPartsAtOneDistanceAreOneOfSeveral) {
  const GradientAlternative tie = between(kCart, kFinger, tick({2.5, 0, 0}));
  EXPECT_EQ(tie.status, GradientStatus::kOneOfSeveral);
  EXPECT_LE(tie.farther, 1e-12);
  const GradientAlternative near = between(kCart, kFinger, tick({2.5, 0.001, 0}));
  EXPECT_EQ(near.status, GradientStatus::kUnique);
  EXPECT_NEAR(near.farther, std::hypot(0.4, 0.301) - std::hypot(0.4, 0.299), 1e-9);
}

TEST_F(Alternatives, FartherPartsAreAtLeastAsFarAsTheySay) {
  Random random(32);
  for (int i = 0; i < 500; ++i) {
    const Vec3 cart = Vec3(2.1, 0, 0) + random.in_box(1.0), finger(2.1, 0, 0);
    const double left = (cart + Vec3(0, 0.3, 0) - finger).norm() - 0.15;
    const double right = (cart - Vec3(0, 0.3, 0) - finger).norm() - 0.15;
    const GradientAlternative found = between(kCart, kFinger, tick(cart));
    if (found.status == GradientStatus::kUnknown) continue;
    ASSERT_LE(found.farther, std::abs(left - right) + 1e-12);
    if (std::abs(left - right) > 0.2) {
      ASSERT_GT(found.farther, 0.0);
    }
  }
}

TEST_F(Alternatives, AFaceParallelToTheWallIsOneOfSeveral) {
  EXPECT_EQ(between(kWall, kUpper, tick({2.5, 0, 0}, 0.0)).status, GradientStatus::kOneOfSeveral);
  const GradientAlternative turned = between(kWall, kUpper, tick({2.5, 0, 0}, 0.01));
  EXPECT_EQ(turned.status, GradientStatus::kUnique);
  EXPECT_NEAR(turned.tilt, std::sin(0.01), 1e-9);
  EXPECT_EQ(turned.farther, kInfinity) << "both have one part";
}

TEST_F(Alternatives, OverlappingPairsAreComparedByTheirPartsOnly) {
  const GradientAlternative found = between(kCart, kFinger, tick({2.1, 0.3, 0}));
  EXPECT_EQ(found.status, GradientStatus::kPartsCompared);
  EXPECT_TRUE(std::isnan(found.tilt));
}

TEST_F(Alternatives, OfACurvedBodyAreComparedByTheirPartsOnly) {
  scene.objects[kCart].parts = {{"can", test::made(cylinder(0.1, 0.4)), {}}};
  const Report& report = tick({2.5, 0, 0});
  const GradientAlternative found = between(kCart, kFinger, report);
  EXPECT_EQ(found.status, GradientStatus::kPartsCompared);
  EXPECT_TRUE(std::isnan(found.tilt));
  for (const PairReport& pair : report.pairs) EXPECT_EQ(pair.status, PairStatus::kConverged);
}

TEST_F(Alternatives, AreUnknownWhereRatesAre) {
  tick({2.5, 0, 0});
  const GradientAlternative late =
      between(kCart, kFinger, monitor->tick({}, {}, now += 100 * test::kTick));
  EXPECT_EQ(late.status, GradientStatus::kUnknown);
  EXPECT_TRUE(std::isnan(late.farther) && std::isnan(late.tilt));
}

// The finger is a point between both balls of the cart, or the cart is one between two of the
// finger: one of the closest points is the same, and the other is not.
TEST_F(Alternatives, APointBetweenTwoPartsIsClosestToBothOfThem) {
  scene.objects[kFinger].parts = {test::ball(0.0)};
  EXPECT_EQ(between(kCart, kFinger, tick({2.5, 0, 0})).status, GradientStatus::kOneOfSeveral);
  std::swap(scene.objects[kFinger].parts, scene.objects[kCart].parts);
  monitor.emplace(scene);
  EXPECT_EQ(between(kCart, kFinger, tick({2.5, 0, 0})).status, GradientStatus::kOneOfSeveral);
}

// Two blocks of the finger share a face, whose edge is the closest to the cart. A third is 0.3 m
// behind them.
TEST_F(Alternatives, PartsThatShareTheClosestPointAreOnePlace) {
  scene.objects[kCart].parts = {test::ball(0.0)};
  const Vec3 half(0.1, 0.1, 0.1);
  scene.objects[kFinger].parts = {test::block(half, test::at(0, 0.1, 0)),
                                  test::block(half, test::at(0, -0.1, 0))};
  const GradientAlternative both = between(kCart, kFinger, tick({2.5, 0, 0}));
  EXPECT_EQ(both.farther, kInfinity);
  EXPECT_EQ(both.status, GradientStatus::kUnique);
  for (const std::size_t place : {0, 1, 2}) {
    Scene with_third = scene;
    auto& parts = with_third.objects[kFinger].parts;
    parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(place),
                 test::block(half, test::at(-0.3, 0, 0)));
    monitor.emplace(with_third);
    const GradientAlternative third = between(kCart, kFinger, tick({2.5, 0, 0}));
    EXPECT_GT(third.farther, 0.0) << place;
    EXPECT_LE(third.farther, 0.3 + 1e-12) << place;
    EXPECT_EQ(third.status, GradientStatus::kUnique) << place;
  }
}

TEST_F(Alternatives, OfThreePartsTheSecondCountsInWhicheverOrderTheyAre) {
  const std::array<Vec3, 3> places{Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(0.5, 0, 0)};
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    auto& parts = scene.objects[kCart].parts;
    parts.clear();
    for (const std::size_t i : order) parts.push_back(test::ball(0.1, {.position = places[i]}));
    monitor.emplace(scene);
    tick({2.5, 0, 0});
    const GradientAlternative found = between(kCart, kFinger, tick({2.5, 0, 0}));
    EXPECT_EQ(found.status, GradientStatus::kUnique);
    EXPECT_NEAR(found.farther, 0.2, 1e-9);
  } while (std::ranges::next_permutation(order).found);
}

}  // namespace
}  // namespace clearance
