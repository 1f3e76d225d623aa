#include "config/cell/robot_reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "tests/config/cell/walker.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const Scene& scene, bool fixed) {
  std::vector<std::string> names;
  for (const Object& object : scene.objects) {
    if (object.fixed == fixed) names.push_back(object.name);
  }
  return names;
}

TEST_F(Robots, LinksWithShapesAreObjectsAndWhatNothingMovesIsFixed) {
  const Scene cell = scene(kWalker, kSelf);
  EXPECT_THAT(names_of(cell, true), ElementsAre("foot", "mast"));
  EXPECT_THAT(names_of(cell, false), ElementsAre("arm", "hand"));
  ASSERT_EQ(cell.objects.size(), 4u);
  const Object& mast = cell.objects[1];
  EXPECT_LT((mast.world_from_object.position - Vec3(0, 0, 0.05)).norm(), 1e-15);
  EXPECT_LT((transform(mast.world_from_object, Vec3(1, 0, 0)) - Vec3(0, 1, 0.05)).norm(), 1e-15);
  EXPECT_EQ(mast.parts.front().object_from_part.position, Vec3(0, 0, 0.5));
  const Object& hand = cell.objects[3];
  EXPECT_THAT(hand.groups, ElementsAre("walker"));
  ASSERT_EQ(hand.parts.size(), 2u);
  EXPECT_EQ(hand.parts[0].name, "sphere0");
  EXPECT_EQ(hand.parts[1].name, "mesh1");
  EXPECT_EQ(hand.parts[1].shape.vertices.size(), 4u);
}

TEST_F(Robots, ALinkHasTheMarginThatIsStatedForItAndOthersThatOfTheRobot) {
  std::string robot = kWalker;
  robot.insert(robot.find("urdf:"), "margin: 0.01, ");
  const Scene cell =
      scene(robot, "margins: [{name: hand, margin: 0.03}, {name: left, margin: 1}]\n" + kSelf);
  EXPECT_EQ(cell.objects[3].margin, 0.03);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(cell.objects[i].margin, 0.01) << i;
  EXPECT_THAT(errors(robot, "margins: [{name: hant, margin: 0.03}]\n" + kSelf),
              testing::HasSubstr("'hand'"));
  EXPECT_THAT(
      errors(robot, "margins: [{name: hand, margin: 1}, {name: hand, margin: 1}]\n" + kSelf),
      testing::HasSubstr("again"));
  EXPECT_THAT(errors(robot, "margins: [{name: hand, margin: -1}]\n" + kSelf),
              testing::HasSubstr("margin"));
}

TEST_F(Robots, ParentsComeBeforeWhatTheyCarry) {
  const Scene cell = scene(kWalker, kSelf);
  ASSERT_EQ(cell.robots.size(), 1u);
  const Robot& robot = cell.robots.front();
  ASSERT_EQ(robot.links.size(), 8u);
  ASSERT_EQ(robot.joints.size(), 7u);
  EXPECT_EQ(robot.links[0].name, "foot");
  for (std::uint32_t i = 0; i < robot.joints.size(); ++i) EXPECT_LE(robot.joints[i].parent, i);
  EXPECT_EQ(cell.objects[robot.links[3].object].name, robot.links[3].name);
  EXPECT_EQ(robot.links[7].object, RobotLink::kNoObject);
}

TEST_F(Robots, EveryTypeOfJointHasItsVariablesAndLimits) {
  const Scene cell = scene(kWalker, kSelf);
  std::vector<std::string> names;
  for (const JointVariable& variable : cell.variables) names.push_back(variable.name);
  EXPECT_THAT(names, ElementsAre("hip", "slide", "grip", "table/x", "table/y", "table/theta",
                                 "free/trans_x", "free/trans_y", "free/trans_z", "free/rot_x",
                                 "free/rot_y", "free/rot_z", "free/rot_w"));
  EXPECT_EQ(cell.variables[0].lower, -1.0);
  EXPECT_EQ(cell.variables[0].upper, 2.0);
  EXPECT_EQ(cell.variables[0].max_speed, 1.5);
  EXPECT_EQ(cell.variables[0].age_limit_ns, 20'000'000);
  EXPECT_EQ(cell.variables[1].max_speed, 0.5);
  EXPECT_EQ(cell.variables[2].upper, kInfinity);
  EXPECT_EQ(cell.variables[2].max_speed, 3.0);
  EXPECT_EQ(cell.variables[3].max_speed, kInfinity);
  for (const RobotJoint& joint : cell.robots.front().joints) {
    if (joint.name == "hip") {
      EXPECT_EQ(joint.axis, Vec3(0, 0, -1));
    }
    if (joint.name == "slide") {
      EXPECT_EQ(joint.axis, Vec3(1, 0, 0));
    }
    if (joint.name == "grip") {
      EXPECT_EQ(joint.axis, Vec3(1, 0, 0)) << "the default of URDF";
    }
    if (joint.name == "table") {
      EXPECT_LT((joint.plane_x.cross(joint.plane_y) - joint.axis).norm(), 1e-15) << "right-handed";
    }
    if (joint.name != "grip2") continue;
    EXPECT_EQ(joint.variable, 2u);
    EXPECT_EQ(joint.multiplier, -2.0);
    EXPECT_EQ(joint.offset, 0.25);
  }
}

// Where nothing is stated, leaps are still not plausible.
TEST_F(Robots, JointsHaveSpeedsThatArePlausibleAndTolerancesOfTheirLimits) {
  const Scene cell = scene(
      "  - {name: walker, urdf: walker_description/walker.urdf, frozen_limit_ms: 50, joints: "
      "{slide: "
      "{limits: [-0.1, 0.9], frozen_limit_ms: 70, velocity: 0.25}}}\n",
      kSelf);
  const std::vector<JointVariable>& all = cell.variables;
  EXPECT_EQ(all[0].plausible_speed(), 1.5);
  EXPECT_NEAR(all[0].limit_tolerance, 0.03, 1e-12) << "1 % of 3 rad";
  EXPECT_EQ(all[0].frozen_limit_ns, 50'000'000);
  EXPECT_FALSE(all[0].wraps);
  EXPECT_EQ(all[1].plausible_speed(), 0.25);
  EXPECT_EQ(all[1].lower, -0.1);
  EXPECT_EQ(all[1].upper, 0.9);
  EXPECT_NEAR(all[1].limit_tolerance, 0.01, 1e-12);
  EXPECT_EQ(all[1].frozen_limit_ns, 70'000'000);
  EXPECT_TRUE(all[2].wraps) << "grip2 mimics it by -2";
  EXPECT_EQ(all[2].limit_tolerance, 0.0);
  EXPECT_EQ(all[3].plausible_speed(), 20.0);
  EXPECT_EQ(all[3].first_of_joint, 3u);
  EXPECT_FALSE(all[4].wraps);
  EXPECT_EQ(all[5].plausible_speed(), 100.0);
  EXPECT_TRUE(all[5].wraps);
  EXPECT_EQ(all[5].first_of_joint, 3u);
  EXPECT_EQ(all[12].plausible_speed(), 50.0) << "an entry of a quaternion";
  EXPECT_EQ(all[12].first_of_joint, 6u);
}

TEST_F(Robots, ABaseThatFollowsAFrameHasLimitsOfItsOwn) {
  const auto with_base = [&](const std::string& base) {
    return scene("  - {name: walker, urdf: walker_description/walker.urdf, source: driver, base: " +
                     base + "}\n",
                 "ros2: {world_frame: map}\n" + kSelf)
        .variables;
  };
  const std::vector<JointVariable> unstated = with_base("{frame: base_link}");
  EXPECT_EQ(unstated[0].plausible_speed(), 5.0);
  EXPECT_EQ(unstated[0].max_speed, kInfinity) << "it bounds no motion that is not seen";
  EXPECT_EQ(unstated[3].plausible_speed(), 3.15);
  EXPECT_EQ(unstated[0].source, "");
  EXPECT_EQ(unstated[7].source, "driver");
  const std::vector<JointVariable> stated = with_base(
      "{frame: base_link, max_speed: 1.5, max_turn_speed: 90, frozen_limit_ms: 300, source: /tf}");
  EXPECT_EQ(stated[2].max_speed, 1.5);
  EXPECT_NEAR(stated[6].max_speed, 0.25 * std::numbers::pi, 1e-12);
  EXPECT_EQ(stated[6].frozen_limit_ns, 300'000'000);
  EXPECT_EQ(stated[6].source, "/tf:bases");
  const std::vector<JointVariable> swinging =
      with_base("{frame: base_link, pose: {xyz: [0, 2, 0]}, max_speed: 1.5, max_turn_speed: 90}");
  EXPECT_NEAR(swinging[0].max_speed, 1.5 + std::numbers::pi, 1e-12) << "the frame's, 2 m away";
  EXPECT_NEAR(swinging[6].max_speed, 0.25 * std::numbers::pi, 1e-12);
}

// grip3 = 3 grip2 + 0.5, where grip2 = -2 grip + 0.25.
TEST_F(Robots, AMimicOfAMimicFollowsTheLastOfTheChain) {
  std::string urdf = kWalkerUrdf;
  urdf.replace(
      urdf.find("</robot>"), 8,
      R"(<link name="tip"/><joint name="grip3" type="revolute"><parent link="right"/><child link="tip"/>
  <limit lower="-1" upper="1" velocity="1"/><mimic joint="grip2" multiplier="3" offset="0.5"/></joint></robot>)");
  test::write_text(folder_ / "walker_description/walker.urdf", urdf);
  const Scene cell = scene(kWalker, kSelf);
  const Robot& robot = cell.robots.at(0);
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(robot.joints, name, &RobotJoint::name);
  };
  EXPECT_EQ(named("grip3").variable, named("grip").variable);
  EXPECT_EQ(named("grip3").multiplier, -6.0);
  EXPECT_EQ(named("grip3").offset, 1.25);
  EXPECT_EQ(named("grip2").multiplier, -2.0);
  EXPECT_EQ(named("grip2").offset, 0.25);
}

TEST_F(Robots, PairsThatTheSrdfDisablesMayTouch) {
  const Scene cell = scene(kWalker, kSelf);
  EXPECT_FALSE(watched(cell, "arm", "mast"));
  EXPECT_TRUE(watched(cell, "arm", "hand"));
  EXPECT_TRUE(watched(cell, "arm", "foot"));
  EXPECT_THAT(cell.robots.front().notes,
              testing::Contains(HasSubstr("1 disabled pair left out: 1 of two fixed links")));
}

// Such a base follows a frame of tf, if the cell says so.
TEST_F(Robots, WhoseSrdfLetsTheBaseMoveSaySoWhereTheCellHasItStill) {
  const auto notes = [this](const std::string& type, const std::string& base) {
    std::string srdf = test::read_text(folder_ / "walker_description/walker.srdf");
    srdf.insert(srdf.find("</robot>"), "<virtual_joint name='v' type='" + type +
                                           "' parent_frame='odom' child_link='foot'/>");
    test::write_text(folder_ / "walker_description/moved.srdf", srdf);
    const Scene cell = scene(
        "  - {name: walker, urdf: walker_description/walker.urdf, srdf: "
        "walker_description/moved.srdf" +
            base + "}\n",
        "ros2: {world_frame: map}\n" + kSelf);
    return cell.robots.front().notes;
  };
  const auto is_said = testing::Contains(HasSubstr("frame 'odom'"));
  EXPECT_THAT(notes("planar", ""), is_said);
  EXPECT_THAT(notes("floating", ""), is_said);
  EXPECT_THAT(notes("fixed", ""), testing::Not(is_said));
  EXPECT_THAT(notes("planar", ", base: {frame: base_link}"), testing::Not(is_said));
  EXPECT_THAT(notes("planar", ", base: {pose: {xyz: [1, 0, 0]}}"), testing::Not(is_said));
}

// Each topic of joint states is a source, and so is tf for their bases.
TEST_F(Robots, ThatCanNeedMoreSourcesThanAreHeardSaySo) {
  const auto is_said = [this](int robots, const std::string& more) {
    std::string list, pairs = "pairs:\n";
    for (int i = 0; i < robots; ++i) {
      list += fmt::format(
          "  - {{name: r{0}, prefix: r{0}_, urdf: walker_description/walker.urdf, joint_states: "
          "/r{0}/joint_states{1}}}\n",
          i, more);
      if (i > 0) pairs += fmt::format("  - {{between: [r0, r{}]}}\n", i);
    }
    const Scene cell = scene(list, "ros2: {world_frame: map}\n" + pairs);
    return testing::Value(cell.robots.front().notes,
                          testing::Contains(HasSubstr("can need 17 sources, but 16 are heard")));
  };
  EXPECT_FALSE(is_said(16, ""));
  EXPECT_TRUE(is_said(17, ""));
  EXPECT_TRUE(is_said(16, ", base: {frame: cart}"));
}

TEST_F(Robots, WithoutAnSrdfNeighboursMayTouchAndAreNamed) {
  const Scene cell = scene("  - {name: walker, urdf: walker_description/walker.urdf}\n", kSelf);
  EXPECT_FALSE(watched(cell, "arm", "mast"));
  EXPECT_FALSE(watched(cell, "arm", "hand"));
  EXPECT_TRUE(watched(cell, "mast", "hand"));
  EXPECT_THAT(
      cell.robots.front().notes,
      testing::Contains("no SRDF: these neighbours are not watched: mast - arm, arm - hand"));
}

TEST_F(Robots, SeveralStandOnEachOtherOnObjectsAndInTheWorld) {
  const std::string robots =
      "  - {name: one, prefix: a_, urdf: walker_description/walker.urdf, base: {on: rock, pose: "
      "{xyz: [0, 0, 1]}}}\n"
      "  - {name: two, prefix: b_, urdf: walker_description/walker.urdf, base: {on: a_left}}\n"
      "  - {name: three, prefix: c_, urdf: walker_description/walker.urdf, base: {on: cart}}\n"
      "  - {name: four, prefix: d_, urdf: walker_description/walker.urdf, base: {on: a_mast}}\n";
  const std::string rest =
      "objects:\n"
      "  - {name: rock, fixed: true, pose: {xyz: [5, 0, 0]}, box: {size: [1, 1, 1]}}\n"
      "  - {name: cart, box: {size: [1, 1, 1]}}\n"
      "pairs:\n"
      "  - between: [one, two]\n"
      "  - between: [three, four]\n"
      "  - between: [cart, rock]\n";
  const Scene cell = scene(robots, rest);
  ASSERT_EQ(cell.robots.size(), 4u);
  EXPECT_EQ(cell.robots[0].base.kind, RobotBase::Kind::kWorld);
  EXPECT_EQ(cell.robots[0].base.base_from_root.position, Vec3(5, 0, 1));
  EXPECT_EQ(cell.robots[1].base.kind, RobotBase::Kind::kLink);
  EXPECT_EQ(cell.robots[cell.robots[1].base.robot].links[cell.robots[1].base.link].name, "a_left");
  EXPECT_EQ(cell.robots[2].base.kind, RobotBase::Kind::kObject);
  EXPECT_EQ(cell.objects[cell.robots[2].base.object].name, "cart");
  EXPECT_LT((cell.robots[3].base.base_from_root.position - Vec3(5, 0, 1.05)).norm(), 1e-12);
  EXPECT_THAT(names_of(cell, true), ElementsAre("rock", "a_foot", "a_mast", "d_foot", "d_mast"));
  EXPECT_EQ(cell.variables[13].name, "b_hip");
  EXPECT_EQ(cell.variables[13].robot, 1u);
}

TEST_F(Robots, MistakesOfTheCellAreNamedAtTheirPlaces) {
  EXPECT_THAT(errors(kWalker + kWalker, kSelf), mistake_at("cell.yaml:5:12", "'walker'"));
  const std::string twice = kWalker + "  - {name: other, urdf: walker_description/walker.urdf}\n";
  EXPECT_THAT(errors(twice, kSelf), mistake_at("cell.yaml:5:12", "'foot'", "'other'", "prefix"));
  EXPECT_THAT(errors("  - {name: walker, urdf: nowhere.urdf}\n", kSelf),
              mistake_at("cell.yaml:4:26", "nowhere.urdf"));
  EXPECT_THAT(errors("  - {name: walker, urdf: package://gone/r.urdf}\n", kSelf),
              mistake_at("cell.yaml:4:26", "'gone'", "packages: {gone: DIRECTORY}"));
  EXPECT_THAT(
      errors("  - {name: walker, urdf: walker_description/walker.urdf, base: {on: cat}}\n", kSelf),
      mistake_at("cell.yaml:4:69", "'cat'"));
  for (const char* limits : {"[1]", "[1, 0]", "[0, high]", "3"}) {
    EXPECT_THAT(errors(std::string("  - {name: walker, urdf: walker_description/walker.urdf, "
                                   "joints: {hip: {limits: ") +
                           limits + "}}}\n",
                       kSelf),
                HasSubstr("cell.yaml:4:"))
        << limits;
  }
  EXPECT_THAT(errors("  - {name: walker, urdf: walker_description/walker.urdf, srfd: x}\n", kSelf),
              mistake_at("cell.yaml:4:58", "'srfd'", "'srdf'"));
}

TEST_F(Robots, MistakesOfTheUrdfAreNamedByItsLines) {
  const auto faults = [&](const std::string& from, const std::string& to) {
    std::string text = kWalkerUrdf;
    text.replace(text.find(from), from.size(), to);
    test::write_text(folder_ / "walker_description/walker.urdf", text);
    return errors(kWalker, kSelf);
  };
  EXPECT_THAT(faults("type=\"planar\"", "type=\"planer\""),
              mistake_at("walker.urdf:13", "'planer'"));
  EXPECT_THAT(faults("<axis xyz=\"1 0 0\"/>", ""), mistake_at("walker.urdf:13", "'table'"));
  EXPECT_THAT(faults("0 0 -2", "0 0 0"), mistake_at("walker.urdf:10", "0 0 0", "'hip'"));
  EXPECT_THAT(faults("lower=\"0\" upper=\"0.3\"", "lower=\"0.4\" upper=\"0.3\""),
              mistake_at("walker.urdf:8", "0.4", "0.3"));
  EXPECT_THAT(faults("<limit lower=\"-1\" upper=\"2\" velocity=\"1.5\"/>", ""),
              mistake_at("walker.urdf:10", "'hip'", "<limit>"));
  EXPECT_THAT(faults("mimic joint=\"grip\"", "mimic joint=\"grip2\""),
              mistake_at("walker.urdf:12", "'grip2'"));
  EXPECT_THAT(faults("mimic joint=\"grip\"", "mimic joint=\"bolt\""),
              mistake_at("walker.urdf:12", "'bolt'"));
  EXPECT_THAT(faults("<link name=\"left\"/>", "<link name=\"left\"/><link name=\"lone\"/>"),
              mistake_at("walker.urdf:1", "lone"));
  EXPECT_THAT(faults("tip.obj", "top.obj"), mistake_at("walker.urdf:6", "top.obj"));
}

TEST_F(Robots, MayBeFollowedByTheTicks) {
  EXPECT_EQ(scene(kWalker, kSelf).tick_on, Scene::kFreeRunning);
  const Scene cell = scene(kWalker, kSelf + "tick: {on: walker}\nrate_hz: 500\n");
  EXPECT_EQ(cell.tick_on, 0u);
  EXPECT_EQ(cell.longest_period(), 0.002 * (1 + 1.0 / 64));
  const std::string objects =
      "objects:\n  - {name: cart, sphere: {radius: 1}}\n"
      "  - {name: rock, fixed: true, sphere: {radius: 1}}\n"
      "pairs: [{between: [walker, walker]}, {between: [cart, rock]}]\n";
  const Scene beside = scene(kWalker, objects + "tick: {on: cart}\n");
  EXPECT_EQ(beside.tick_on, Scene::kFreeRunning);
  EXPECT_EQ(beside.objects.at(beside.tick_on_object).name, "cart");
  EXPECT_THAT(errors(kWalker, objects + "tick: {on: rock}\n"), HasSubstr("poses ticks follow"));
  EXPECT_THAT(errors(kWalker, objects + "tick: {on: left}\n"), HasSubstr("poses ticks follow"))
      << "joints move a link";
  EXPECT_THAT(errors(kWalker, kSelf + "tick: {on: wolker}\n"),
              mistake_at("cell.yaml:6", "'wolker'", "expected a robot or an object", "'walker'"));
  EXPECT_THAT(errors(kWalker, kSelf + "tick: {at: walker}\n"), HasSubstr("'on'"));
}

TEST_F(Robots, AnotherDescriptionIsAnotherRevision) {
  const std::uint64_t before = scene(kWalker, kSelf).revision;
  EXPECT_EQ(scene(kWalker, kSelf).revision, before);
  std::string text = kWalkerUrdf;
  text.replace(text.find("xyz=\"1 0 0\""), 11, "xyz=\"2 0 0\"");
  test::write_text(folder_ / "walker_description/walker.urdf", text);
  EXPECT_NE(scene(kWalker, kSelf).revision, before);
}

}  // namespace
}  // namespace clearance
