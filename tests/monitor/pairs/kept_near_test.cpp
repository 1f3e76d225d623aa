// Pairs that a robot's build keeps near. Oracle: closed forms of boxes and a sphere, and postures
// drawn at random with new queries.
#include "monitor/pairs/kept_near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "monitor/bodies/forward_kinematics.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using Names = std::set<std::string>;

Names names_kept(const Scene& scene, double metres) {
  Names names;
  for (const std::uint32_t pair : kept_nearer(scene, metres)) {
    names.insert(scene.objects[scene.pairs[pair].first].name + " " +
                 scene.objects[scene.pairs[pair].second].name);
  }
  return names;
}

// Neighbours are not watched. Stretched, the lower link begins 1 m beside the foot and 0.85 m above
// it; the finger is 1.25 m from the upper link when it has slid out.
TEST(KeptNear, NamesTheLinksThatNoPostureTakesFartherApart) {
  const Scene scene = test::scara_cell();
  const double foot_to_lower = std::hypot(1.0, 0.85);
  EXPECT_EQ(names_kept(scene, 1.249), Names());
  EXPECT_FALSE(names_kept(scene, foot_to_lower - 1e-3).contains("foot lower"));
  EXPECT_TRUE(names_kept(scene, foot_to_lower + 0.05).contains("foot lower"));
  EXPECT_EQ(names_kept(scene, 1e3), Names({"upper finger", "foot lower"}))
      << "foot and finger have three joints between them, the wall is no link";
  EXPECT_EQ(names_kept(scene, 0.0), Names());
}

TEST(KeptNear, NoPostureIsAsFarApartAsIsRuledOut) {
  const Scene scene = test::scara_cell();
  std::mt19937_64 engine(10);
  std::vector<TrackedVariable> variables(scene.variables.size());
  for (TrackedVariable& variable : variables) variable.input.has_value = true;
  ForwardKinematics kinematics(scene.robots);
  std::map<std::uint32_t, Pose> pose;
  std::map<std::uint32_t, double> farthest;
  for (int i = 0; i < 20'000; ++i) {
    const auto share = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    variables[0].position = -3.0 + 6.0 * share();
    variables[1].position = -3.2 + 6.4 * share();
    variables[2].position = 0.2 * share();
    kinematics.place(variables, {});
    for (std::size_t link = 0; link < scene.robots[0].links.size(); ++link)
      pose[scene.robots[0].links[link].object] = kinematics.links(0)[link].pose;
    for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
      const auto [a, b, publish] = scene.pairs[pair];
      if (!pose.contains(a) || !pose.contains(b)) continue;
      const auto truth = test::fresh_distance(scene.objects[a], pose[a], scene.objects[b], pose[b]);
      farthest[pair] = std::max(farthest[pair], truth.lower);
    }
  }
  int kept = 0;
  for (double metres = 0.02; metres < 3.0; metres += 0.02) {
    for (const std::uint32_t pair : kept_nearer(scene, metres)) {
      EXPECT_LT(farthest[pair], metres) << pair;
      ++kept;
    }
  }
  EXPECT_GT(kept, 100);
}

// Objects 2 to 5 are foot, upper, lower and finger; variables and joints are shoulder, elbow, push.
TEST(KeptNear, CountsATurnWithoutLimitsAsAFullOneAndASlideWithoutLimitsAsNoBuild) {
  constexpr double kEnough = 1e3;
  const Names both{"upper finger", "foot lower"};
  struct Limits {
    std::size_t variable;
    double lower, upper, multiplier;
    Names kept;
  };
  const Limits rows[] = {
      {0, -3.0, kInfinity, 1.0, both},          {0, -kInfinity, 3.0, 1.0, both},
      {0, -kInfinity, kInfinity, -1.0, both},   {0, -kInfinity, 3.0, 2.0, {"upper finger"}},
      {1, -kInfinity, kInfinity, 2.0, {}},      {1, -9.0, 9.0, 2.0, both},
      {2, 0.0, kInfinity, 1.0, {"foot lower"}}, {2, -kInfinity, 0.2, 1.0, {"foot lower"}}};
  for (const Limits& row : rows) {
    Scene scene = test::scara_cell();
    scene.variables[row.variable].lower = row.lower;
    scene.variables[row.variable].upper = row.upper;
    scene.robots[0].joints[row.variable].multiplier = row.multiplier;
    EXPECT_EQ(names_kept(scene, kEnough), row.kept) << row.variable << ", " << row.upper;
  }
}

// The upper link ends at 0.9 m, and the finger begins at 1.95 m.
TEST(KeptNear, OfLinksThatNoJointMovesIsTheirDistance) {
  Scene scene = test::scara_cell();
  scene.robots[0].joints[1].type = scene.robots[0].joints[2].type = JointType::kFixed;
  EXPECT_FALSE(names_kept(scene, 1.05 - 1e-6).contains("upper finger"));
  EXPECT_TRUE(names_kept(scene, 1.05 + 1e-6).contains("upper finger"));
}

TEST(KeptNear, OfLinksOfSeveralPartsIsTheDistanceOfTheNearestTwo) {
  for (const std::ptrdiff_t place : {0, 1}) {
    Scene scene = test::scara_cell();
    scene.robots[0].joints[1].type = scene.robots[0].joints[2].type = JointType::kFixed;
    for (const std::size_t object : {3u, 5u}) {
      auto& parts = scene.objects[object].parts;
      parts.insert(parts.begin() + place, test::ball(0.01, test::at(0, 50.0, 0)));
    }
    EXPECT_FALSE(names_kept(scene, 1.05 - 1e-6).contains("upper finger"));
    EXPECT_TRUE(names_kept(scene, 1.05 + 1e-6).contains("upper finger"));
  }
}

// One variable bends both joints alike. Stretched is still the farthest that foot and lower link
// come apart, and no third variable is between foot and finger.
TEST(KeptNear, CountsJointsOfOneVariableOnce) {
  Scene scene = test::scara_cell();
  scene.robots[0].joints[1].variable = 0;
  const double foot_to_lower = std::hypot(1.0, 0.85);
  EXPECT_FALSE(names_kept(scene, foot_to_lower - 1e-3).contains("foot lower"));
  EXPECT_TRUE(names_kept(scene, foot_to_lower + 0.05).contains("foot lower"));
  EXPECT_TRUE(names_kept(scene, 1e3).contains("foot finger"));
}

// A finger that may be anywhere in the plane, a link without a shape or without an end, a link that
// is not watched, other objects, and the links of two robots.
TEST(KeptNear, NamesNoPairOfWhichTheBuildSaysNothing) {
  Scene planar = test::scara_cell();
  planar.robots[0].joints[1].type = JointType::kPlanar;
  EXPECT_EQ(names_kept(planar, 1e3), Names());
  Scene shapeless = test::scara_cell();
  shapeless.objects[4].parts.clear();
  EXPECT_EQ(names_kept(shapeless, 1e3), Names({"upper finger"}));
  Scene endless = test::scara_cell();
  endless.objects[4].parts = {test::floor()};
  EXPECT_EQ(names_kept(endless, 1e3), Names({"upper finger"}));
  Scene unnamed = test::scara_cell();
  unnamed.robots[0].links[3].object = RobotLink::kNoObject;
  EXPECT_EQ(names_kept(unnamed, 1e3), Names({"foot lower"}));
  Scene turned = test::scara_cell();
  for (ObjectPair& pair : turned.pairs) std::swap(pair.first, pair.second);
  EXPECT_EQ(names_kept(turned, 1e3), Names({"finger upper", "lower foot"}));
  EXPECT_EQ(names_kept(test::two_scara_arms().scene, 1e3), Names());
  EXPECT_EQ(names_kept(test::cell_of({test::moving("a", {}), test::moving("b", {})}), 1e3),
            Names());
}

// The finger is as far from the upper link in each posture of its last joint, so that no share of
// the range is proved by less than the slack. Once, such a proof would not have ended.
TEST(KeptNear, GivesUpAProofThatTakesTooLong) {
  Scene scene = test::scara_cell();
  scene.robots[0].joints[2].type = JointType::kRevolute;  // about its own axis
  scene.variables[2].lower = -3.0;
  scene.variables[2].upper = 3.0;
  const double farthest = 1.05;  // stretched
  EXPECT_FALSE(names_kept(scene, farthest + 1e-8).contains("upper finger"));
  EXPECT_TRUE(names_kept(scene, farthest + 0.05).contains("upper finger"));
}

TEST(KeptNear, TellsOfTheFirstPairsByNameAndOfTheRestByTheirNumber) {
  const Scene scene = test::scara_cell();
  ASSERT_GE(scene.pairs.size(), 6u);
  const std::string four = kept_nearer_text(scene, 0.5, {0, 1, 2, 3});
  EXPECT_TRUE(four.starts_with("left out of 0.5 m: ")) << four;
  EXPECT_EQ(std::ranges::count(four.substr(0, four.find(": the robot")), ','), 3);
  EXPECT_EQ(four.find(" more: "), std::string::npos);
  const std::string six = kept_nearer_text(scene, 0.5, {0, 1, 2, 3, 4, 5});
  EXPECT_NE(six.find(" and 2 more: the robot's own build"), std::string::npos) << six;
}

}  // namespace
}  // namespace clearance
