// Robots as public files describe them: without sizes, limits or collision shapes, with an SRDF of
// another name, or with more pairs than a report carries.
#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/config/cell/walker.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;

using OddRobots = Robots;

// Public files have markers without size; urdfdom and MoveIt load them.
TEST_F(OddRobots, ShapesWithoutSizeArePointsLinesAndPlatesAndAreNamed) {
  const auto hand_with = [&](const std::string& shape) {
    std::string text = kWalkerUrdf;
    const std::string from = "<sphere radius=\"0.1\"/>";
    text.replace(text.find(from), from.size(), shape);
    test::write_text(folder_ / "walker_description/walker.urdf", text);
    const Scene cell = scene(kWalker, kSelf);
    EXPECT_THAT(cell.robots.front().notes,
                testing::Contains(testing::AllOf(HasSubstr("'hand'"), HasSubstr("line 5"),
                                                 HasSubstr("no size"))));
    return cell.objects[3].parts[0].shape;
  };
  for (const char* point :
       {"<sphere radius=\"0\"/>", "<box size=\"0 0 0\"/>", "<cylinder radius=\"0\" length=\"0\"/>",
        "<capsule radius=\"0.0\" length=\"0.0\"/>"}) {
    const ConvexBody shape = hand_with(point);
    EXPECT_EQ(shape.vertices.size(), 1u) << point;
    EXPECT_EQ(shape.radius, 0.0) << point;
  }
  EXPECT_EQ(hand_with("<capsule radius=\"0.2\" length=\"0\"/>").radius, 0.2);
  EXPECT_EQ(hand_with("<cylinder radius=\"0\" length=\"0.4\"/>").vertices.size(), 2u);
  EXPECT_NEAR(hand_with("<box size=\"0 2 2\"/>").bounding_radius, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(hand_with("<cylinder radius=\"2\" length=\"0\"/>").bounding_radius, 2.0, 1e-6);
}

TEST_F(OddRobots, ANegativeVelocityLimitIsRefusedUnlessTheCellReplacesIt) {
  std::string text = kWalkerUrdf;
  text.replace(text.find("velocity=\"1.5\""), 14, "velocity=\"-1\"");
  test::write_text(folder_ / "walker_description/walker.urdf", text);
  EXPECT_THAT(errors(kWalker, kSelf), mistake_at("walker.urdf:10", "-1", "'hip'", "joints:"));
  const std::string stated =
      "  - {name: walker, prefix: p_, urdf: walker_description/walker.urdf, joints: {hip: "
      "{velocity: 1.25}}}\n";
  EXPECT_EQ(scene(stated, kSelf).variables[0].max_speed, 1.25);
  std::string aged = stated;
  aged.replace(aged.find("1.25"), 4, "1.25, age_limit_ms: 9");
  EXPECT_EQ(scene(aged, kSelf).variables[0].age_limit_ns, 9'000'000);
  EXPECT_NE(scene(stated, kSelf).variables[0].age_limit_ns, 9'000'000);
  EXPECT_THAT(errors("  - {name: walker, urdf: walker_description/walker.urdf, joints: {hip: "
                     "{age_limit_ms: 9}}}\n",
                     kSelf),
              mistake_at("walker.urdf:10", "'hip'"));
}

TEST_F(OddRobots, WhatAFixedJointSaysOfAxisAndLimitsIsNotRead) {
  std::string text = kWalkerUrdf;
  text.replace(text.find("<parent link=\"foot\"/>"), 0,
               "<axis xyz=\"0 zero 0\"/><limit lower=\"none\"/><mimic joint=\"hip\"/>");
  test::write_text(folder_ / "walker_description/walker.urdf", text);
  EXPECT_EQ(errors(kWalker, kSelf), "");
}

// MoveIt takes such a file, and Kinova ships one.
TEST_F(OddRobots, AnSrdfOfAnotherNameIsNotedWhereItsLinksExist) {
  std::string text = kWalkerSrdf;
  text.replace(text.find("\"walker\""), 8, "\"other\"");
  test::write_text(folder_ / "walker_description/walker.srdf", text);
  const Scene cell = scene(kWalker, kSelf);
  EXPECT_FALSE(watched(cell, "arm", "mast"));
  EXPECT_THAT(cell.robots.front().notes,
              testing::Contains(testing::AllOf(
                  HasSubstr("walker.srdf:1:1: found the robot 'other'"), HasSubstr("'walker'"))));
  test::write_text(folder_ / "walker_description/walker.srdf",
                   text.replace(text.find("\"foot\""), 6, "\"fot\""));
  EXPECT_THAT(errors(kWalker, kSelf), mistake_at("walker.srdf:1:1", "'other'"));
  EXPECT_THAT(errors(kWalker, kSelf), mistake_at("walker.srdf:3:3", "'fot'"));
}

TEST_F(OddRobots, AContinuousJointThatMustNotWrapIsNoted) {
  const auto no_wrapping =
      testing::Contains(testing::AllOf(HasSubstr("'grip'"), HasSubstr("must not wrap")));
  EXPECT_THAT(scene(kWalker, kSelf).robots.front().notes, testing::Not(no_wrapping));
  std::string text = kWalkerUrdf;
  const std::string twice = "multiplier=\"-2\"";
  test::write_text(folder_ / "walker_description/walker.urdf",
                   text.replace(text.find(twice), twice.size(), "multiplier=\"0.5\""));
  const Scene cell = scene(kWalker, kSelf);
  EXPECT_THAT(cell.robots.front().notes, no_wrapping);
  EXPECT_FALSE(cell.variables[2].wraps);
}

TEST_F(OddRobots, AMissingPackageIsToldOnceAndAnEmptyOneAsSuch) {
  std::string text = kWalkerUrdf;
  const std::string from = "package://walker_description/tip.obj";
  const std::size_t at = text.find(from);
  const std::string mesh =
      "<mesh filename=\"package://gone/a.stl\"/></geometry></collision>"
      "<collision><geometry><mesh filename=\"package://gone/b.stl\"/>"
      "</geometry></collision><collision><geometry><mesh filename=\"";
  text.replace(text.find("<mesh filename"), 16, mesh);
  test::write_text(folder_ / "walker_description/walker.urdf", text);
  const std::string told = errors(kWalker, kSelf);
  EXPECT_THAT(told, mistake_at("walker.urdf:6", "'gone'", "packages: {gone: DIRECTORY}"));
  EXPECT_THAT(told, testing::Not(HasSubstr("b.stl")));
  text = kWalkerUrdf;
  test::write_text(folder_ / "walker_description/walker.urdf",
                   text.replace(at, from.size(), "package:///tip.obj"));
  EXPECT_THAT(errors(kWalker, kSelf), mistake_at("walker.urdf:6", "names no package"));
}

TEST_F(OddRobots, LinksWithVisualShapesOnlyAreNamedAndTheCellMayTakeThem) {
  std::string text = kWalkerUrdf;
  const std::string from = "<link name=\"left\"/>";
  text.replace(text.find(from), from.size(),
               "<link name=\"left\"><visual><origin xyz=\"0 0 1\"/><geometry><sphere "
               "radius=\"0.3\"/></geometry><material name=\"red\"/></visual></link>");
  test::write_text(folder_ / "walker_description/walker.urdf", text);
  const Scene without = scene(kWalker, kSelf);
  EXPECT_THAT(without.robots.front().notes,
              testing::Contains(testing::AllOf(HasSubstr("'left'"), HasSubstr("visual"),
                                               testing::Not(HasSubstr("'right'")))));
  const auto taking = [](const std::string& links) {
    return "  - {name: walker, urdf: walker_description/walker.urdf, visual_as_collision: [" +
           links + "]}\n";
  };
  const Scene with = scene(taking("left"), kSelf);
  ASSERT_EQ(with.objects.size(), without.objects.size() + 1);
  const auto left = std::ranges::find(with.objects, "left", &Object::name);
  ASSERT_NE(left, with.objects.end());
  EXPECT_EQ(left->parts[0].shape.radius, 0.3);
  EXPECT_EQ(left->parts[0].object_from_part.position, Vec3(0, 0, 1));
  EXPECT_TRUE(watched(with, "left", "foot"));
  EXPECT_THAT(with.robots.front().notes, testing::Not(testing::Contains(HasSubstr("'left'"))));
  for (const char* other : {"right", "arm", "lefd", "nothing"}) {
    EXPECT_THAT(errors(taking(other), kSelf),
                mistake_at("cell.yaml:4:80", std::string("'") + other + "'", "'left'"))
        << other;
  }
  const std::string shape = "<sphere radius=\"0.3\"/>";
  test::write_text(folder_ / "walker_description/walker.urdf",
                   text.replace(text.find(shape), shape.size(), "<sphere raduis=\"0.3\"/>"));
  EXPECT_THAT(errors(taking("left"), kSelf), mistake_at("walker.urdf:7", "radius"));
  EXPECT_EQ(errors(kWalker, kSelf), "") << "a look is for pictures only";
}

// Objects on one body never move to each other, as two fixed objects do not.
TEST_F(OddRobots, WhatStandsOnOneBodyIsNotWatched) {
  const std::string robots =
      "  - {name: one, prefix: a_, urdf: walker_description/walker.urdf, base: {on: cart}}\n"
      "  - {name: two, prefix: b_, urdf: walker_description/walker.urdf, base: {on: cart}}\n";
  const std::string rest =
      "objects:\n  - {name: cart, box: {size: [1, 1, 1]}}\n"
      "  - {name: rock, fixed: true, pose: {xyz: [5, 0, 0]}, box: {size: [1, 1, 1]}}\n"
      "pairs: [{between: [one, cart]}, {between: [one, two]}, {between: [one, one]}, {between: "
      "[cart, rock]}]\n"
      "allowed_collisions: [{between: [cart, a_foot], reason: it stands there}]\n";
  const Scene cell = scene(robots, rest);
  EXPECT_FALSE(watched(cell, "cart", "a_foot"));
  EXPECT_FALSE(watched(cell, "cart", "a_mast"));
  EXPECT_FALSE(watched(cell, "a_foot", "b_mast"));
  EXPECT_TRUE(watched(cell, "cart", "a_arm"));
  EXPECT_TRUE(watched(cell, "a_foot", "b_arm"));
  EXPECT_TRUE(watched(cell, "a_foot", "a_hand")) << "a robot's own pairs are its description's";
  EXPECT_TRUE(watched(cell, "cart", "rock"));
}

// 100 sliders in a row, 1 m from each other: 4950 pairs.
TEST_F(OddRobots, OfMorePairsThanAReportCarriesThoseOfZonesAndTheNearestArePublished) {
  std::string urdf = "<robot name=\"row\"><link name=\"base\"/>";
  for (int i = 0; i < 100; ++i) {
    urdf += fmt::format(
        "<link name=\"l{0}\"><collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry>"
        "</collision></link><joint name=\"j{0}\" type=\"prismatic\"><parent link=\"base\"/><child "
        "link=\"l{0}\"/><origin xyz=\"0 {1} 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"{2}\" "
        "upper=\"{2}\" velocity=\"1\"/></joint>",
        i, 3 * i, -2 * i);
  }
  test::write_text(folder_ / "row.urdf", urdf + "</robot>");
  const std::string robot = "  - {name: row, urdf: row.urdf}\n";
  const std::string rest =
      "pairs: [{between: [row, row]}]\n"
      "zones: [{name: ends, between: [l0, l99], enter_below: 0.1, leave_above: 0.2}]\n";
  const Scene cell = scene(robot, rest);
  ASSERT_EQ(cell.pairs.size(), 4950u);
  int published = 0;
  double farthest = 0.0, nearest_left = 100.0;
  for (const ObjectPair& pair : cell.pairs) {
    const double apart = std::abs(std::stod(cell.objects[pair.first].name.substr(1)) -
                                  std::stod(cell.objects[pair.second].name.substr(1)));
    published += pair.publish ? 1 : 0;
    if (apart == 99.0) {
      EXPECT_TRUE(pair.publish) << "of a zone";
    } else {
      double& side = pair.publish ? farthest : nearest_left;
      side = pair.publish ? std::max(side, apart) : std::min(side, apart);
    }
  }
  EXPECT_EQ(published, 4096);
  EXPECT_LE(farthest, nearest_left);
  EXPECT_THAT(cell.robots.front().notes, testing::Contains(HasSubstr("reports carry 4096")));
  EXPECT_THAT(errors(robot, "pairs: [{between: [row, row], publish: true}]\n"),
              mistake_at("cell.yaml:5:8", "4950", "4096"));
}

}  // namespace
}  // namespace clearance
