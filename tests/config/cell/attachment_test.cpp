// Attached and absent objects, and objects with the body of a template, as a cell states them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

const std::string kUrdf = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="palm"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="tip"/>
  <link name="finger"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="swing" type="revolute"><origin xyz="2 0 0"/><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="bolt" type="fixed"><origin xyz="1 0 0"/><parent link="hand"/><child link="palm"/></joint>
  <joint name="frame" type="fixed"><origin xyz="1 0 0"/><parent link="palm"/><child link="tip"/></joint>
  <joint name="grip" type="prismatic"><origin xyz="1 0 0"/><parent link="palm"/><child link="finger"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1"/></joint>
</robot>
)";

class Attachments : public testing::Test {
 protected:
  Attachments() { test::write_text(folder_ / "arm.urdf", kUrdf); }

  // The objects begin in line 5.
  static std::string cell(const std::string& objects, const std::string& rest) {
    return "name: test\nunits: {length: m, angle: deg}\n"
           "robots: [{name: arm, urdf: arm.urdf}]\nobjects:\n" +
           objects + rest;
  }
  [[nodiscard]] Scene scene(const std::string& objects, const std::string& rest = kRules) const {
    return scene_of(cell(objects, rest), folder_ / "cell.yaml");
  }
  [[nodiscard]] std::string errors(const std::string& objects,
                                   const std::string& rest = kRules) const {
    return errors_of(cell(objects, rest), folder_ / "cell.yaml");
  }

  inline static const std::string kRules =
      "pairs: [{between: [arm, arm]}, {between: [arm, post]}]\n";
  inline static const std::string kPost =
      "  - {name: post, fixed: true, pose: {xyz: [0, 9, 0]}, sphere: {radius: 1}}\n";
  inline static const std::string kPart =
      "  - {name: part, attached: {to: palm, pose: {xyz: [0, 0.5, 0]}}, sphere: {radius: 0.2}}\n";
  test::ScratchFolder folder_;
};

const Object& named(const Scene& scene, const std::string& name) {
  return *std::ranges::find(scene.objects, name, &Object::name);
}

// The objects that are watched against this one.
std::set<std::string> watched_with(const Scene& scene, const std::string& name) {
  std::set<std::string> others;
  for (const ObjectPair& pair : scene.pairs) {
    const std::string &a = scene.objects[pair.first].name, &b = scene.objects[pair.second].name;
    if (a == name) others.insert(b);
    if (b == name) others.insert(a);
  }
  return others;
}

TEST_F(Attachments, AreLastAndMoveWithTheirLink) {
  const Scene read = scene(kPart + kPost);
  ASSERT_EQ(read.robots.size(), 2u);
  const Robot& carried = read.robots[1];
  EXPECT_TRUE(carried.is_attached);
  EXPECT_FALSE(read.robots[0].is_attached);
  EXPECT_EQ(carried.name, "part");
  EXPECT_EQ(carried.base.kind, RobotBase::Kind::kLink);
  EXPECT_EQ(carried.base.robot, 0u);
  EXPECT_EQ(read.robots[0].links[carried.base.link].name, "palm");
  EXPECT_EQ(carried.base.base_from_root.position, Vec3(0, 0.5, 0));
  EXPECT_EQ(carried.links[0].object, read.objects.size() - 1);
  EXPECT_EQ(read.objects.back().name, "part");
  EXPECT_GT(read.objects.back().pose_error, 0.0);
  EXPECT_EQ(read.objects.back().max_speed, kInfinity);
  EXPECT_EQ(summary(read).find("2 robots"), std::string::npos) << summary(read);
}

TEST_F(Attachments, AreWatchedAsTheirCarrierExceptWithinTheRigidAssembly) {
  const Scene read = scene(kPart + kPost);
  EXPECT_THAT(named(read, "part").groups, ElementsAre("arm"));
  EXPECT_THAT(watched_with(read, "part"), UnorderedElementsAre("base", "finger", "post"));
}

TEST_F(Attachments, LinksWithoutShapesCarryToo) {
  const Scene read =
      scene("  - {name: part, attached: {to: tip}, sphere: {radius: 0.2}}\n" + kPost);
  EXPECT_THAT(watched_with(read, "part"), UnorderedElementsAre("base", "finger", "post"));
}

TEST_F(Attachments, MayTouchObjectsAndGroups) {
  const std::string part =
      "  - {name: part, attached: {to: palm, touch: [finger, things]}, sphere: {radius: 0.2}}\n";
  const std::string other =
      "  - {name: other, groups: [things], fixed: true, sphere: {radius: 0.1}}\n";
  const Scene read = scene(part + other + kPost,
                           kRules.substr(0, kRules.size() - 2) + ", {between: [arm, things]}]\n");
  EXPECT_THAT(watched_with(read, "part"), UnorderedElementsAre("base", "post"));
  EXPECT_THAT(watched_with(read, "other"), UnorderedElementsAre("hand", "palm", "finger"));
}

// A rule that names an object means what is attached to it, too, and what is attached to that. The
// order in the file does not matter.
TEST_F(Attachments, CountWhereARuleOrAZoneNamesTheirCarrier) {
  const std::string chain =
      "  - {name: lid, attached: {to: part}, sphere: {radius: 0.1}}\n" + kPart + kPost;
  const Scene read = scene(chain,
                           "pairs: [{between: [arm, arm]}, {between: [palm, post]}]\n"
                           "zones: [{name: near, between: [palm, post], enter_below: 1, "
                           "leave_above: 2}]\n");
  EXPECT_THAT(watched_with(read, "post"), UnorderedElementsAre("palm", "part", "lid"));
  EXPECT_EQ(read.zones[0].pairs.size(), 3u);
  EXPECT_THAT(watched_with(read, "lid"), UnorderedElementsAre("base", "finger", "post"));
}

// An exception for the carrier says nothing of what it carries.
TEST_F(Attachments, ExceptionsThatNameTheCarrierAreTheCarriersAlone) {
  const Scene read = scene(kPart + kPost, kRules +
                                              "allowed_collisions: [{between: [palm, post], "
                                              "reason: the post touches the palm}]\n");
  EXPECT_THAT(watched_with(read, "post"), testing::Contains("part"));
  EXPECT_THAT(watched_with(read, "post"), testing::Not(testing::Contains("palm")));
}

TEST_F(Attachments, OnWhatNothingMovesAreFixed) {
  const Scene read = scene(
      "  - {name: sign, attached: {to: base, pose: {xyz: [0, 0, 3]}}, sphere: {radius: 0.2}}\n"
      "  - {name: lamp, attached: {to: sign, pose: {xyz: [0, 0, 1]}}, sphere: {radius: 0.2}}\n" +
      kPost);
  EXPECT_TRUE(named(read, "lamp").fixed);
  EXPECT_EQ(named(read, "lamp").world_from_object.position, Vec3(0, 0, 4));
  EXPECT_EQ(read.robots.size(), 1u);
  EXPECT_THAT(watched_with(read, "lamp"), UnorderedElementsAre("hand", "palm", "finger"));
}

TEST_F(Attachments, OfAnAbsentCarrierAreAbsent) {
  const Scene read = scene(
      "  - {name: cart, groups: [arm], absent: true, sphere: {radius: 0.2}}\n"
      "  - {name: load, attached: {to: cart}, sphere: {radius: 0.2}}\n"
      "  - {name: gone, attached: {to: post}, absent: true, sphere: {radius: 0.2}}\n" +
      kPost);
  EXPECT_TRUE(named(read, "cart").absent);
  EXPECT_TRUE(named(read, "load").absent);
  EXPECT_TRUE(named(read, "gone").absent);
  EXPECT_FALSE(named(read, "post").absent);
}

TEST_F(Attachments, OnAMovingObjectMayStateTheirSpeed) {
  const std::string cart = "  - {name: cart, groups: [arm], sphere: {radius: 0.2}}\n";
  const Scene read =
      scene(cart + "  - {name: load, attached: {to: cart}, max_speed: 3, sphere: {radius: 0.2}}\n" +
            kPost);
  EXPECT_EQ(named(read, "load").max_speed, 3.0);
  EXPECT_THAT(
      errors("  - {name: part, attached: {to: palm}, max_speed: 3, sphere: {radius: 1}}\n" + kPost),
      mistake_at("cell.yaml:5:51", "max_speed"));
}

TEST_F(Attachments, MistakesAreRefusedWhereTheyStand) {
  const auto part = [](const std::string& attached, const std::string& more = "") {
    return "  - {name: part, attached: " + attached + more + ", sphere: {radius: 0.2}}\n" + kPost;
  };
  EXPECT_THAT(errors(part("{to: pam}")), mistake_at("cell.yaml:5:33", "pam", "palm"));
  EXPECT_THAT(errors(part("{to: part}")), mistake_at("cell.yaml:5:33", "part", "circle"));
  EXPECT_THAT(errors("  - {name: a, attached: {to: b}, sphere: {radius: 0.2}}\n"
                     "  - {name: b, attached: {to: c}, sphere: {radius: 0.2}}\n"
                     "  - {name: c, attached: {to: a}, sphere: {radius: 0.2}}\n" +
                     kPost),
              mistake_at("cell.yaml:7:30", "'a'", "circle"));
  EXPECT_THAT(errors(part("{to: palm, touch: [fingr]}")),
              mistake_at("cell.yaml:5:47", "fingr", "finger"));
  EXPECT_THAT(errors(part("{pose: {}}")), mistake_at("cell.yaml:5:28", "'to'"));
  EXPECT_THAT(errors(part("{to: palm, at: 1}")), mistake_at("cell.yaml:5:39", "'at'"));
  EXPECT_THAT(errors(part("{to: palm}", ", fixed: true")), mistake_at("cell.yaml:5:47", "fixed"));
  EXPECT_THAT(errors(part("{to: palm}", ", source: x")), mistake_at("cell.yaml:5:48", "source"));
  EXPECT_THAT(errors(part("{to: palm}", ", pose: {}")), mistake_at("cell.yaml:5:46", "pose"));
  EXPECT_THAT(errors("  - {name: part, attached: {to: palm}, half_space: {normal: [0, 0, 1], "
                     "offset: 0}}\n" +
                     kPost),
              mistake_at("cell.yaml:5:52", "unbounded"));
  EXPECT_THAT(errors(kPart + kPost,
                     kRules + "allowed_collisions: [{between: [part, palm], reason: glued}]\n"),
              mistake_at("cell.yaml:8:22", "part", "palm"));
}

const std::string kTemplates =
    "templates:\n"
    "  - {name: ball, sphere: {radius: 0.2}, groups: [things], margin: 0.1}\n"
    "  - name: cross\n"
    "    parts: [{box: {size: [1, 0.1, 0.1]}}, {name: up, box: {size: [0.1, 0.1, 1]}}]\n"
    "  - {name: ground, half_space: {normal: [0, 0, 1], offset: 0}}\n";

std::string with_templates(const std::string& objects) {
  return cell_text(kTemplates + "objects:\n" + objects +
                   "  - {name: other, sphere: {radius: 1}}\n"
                   "pairs: [{between: [things, other]}]\n");
}

TEST(Templates, GiveObjectsTheirShapeGroupsAndMargin) {
  const Scene scene = scene_of(with_templates(
      "  - {name: a, template: ball}\n"
      "  - {name: b, template: cross, groups: [things], fixed: true, pose: {xyz: [1, 0, 0]}}\n"
      "  - {name: c, template: ball, margin: 0.3, attached: {to: a}}\n"
      "  - {name: d, template: ground, fixed: true, groups: [things]}\n"));
  EXPECT_EQ(named(scene, "a").parts.at(0).name, "sphere");
  EXPECT_EQ(named(scene, "a").parts.at(0).shape.radius, 0.2);
  EXPECT_THAT(named(scene, "a").groups, ElementsAre("things"));
  EXPECT_EQ(named(scene, "a").margin, 0.1);
  EXPECT_EQ(named(scene, "c").margin, 0.3);
  ASSERT_EQ(named(scene, "b").parts.size(), 2u);
  EXPECT_EQ(named(scene, "b").parts[1].name, "up");
  EXPECT_EQ(named(scene, "b").world_from_object.position, Vec3(1, 0, 0));
  EXPECT_EQ(scene.objects.size(), 5u) << "templates are no objects";
}

TEST(Templates, MistakesAreRefusedWhereTheyStand) {
  const auto errors = [](const std::string& object) {
    return errors_of(with_templates("  - {name: a, groups: [things], " + object + "}\n"));
  };
  EXPECT_THAT(errors("template: ground"), mistake_at("cell.yaml:10:43", "ground", "unbounded"));
  EXPECT_THAT(errors("template: bal"), mistake_at("cell.yaml:10:43", "bal", "ball"));
  EXPECT_THAT(errors("template: ball, sphere: {radius: 1}"),
              mistake_at("cell.yaml:10:57", "sphere"));
  EXPECT_THAT(errors("template: ball, parts: []"), mistake_at("cell.yaml:10:56", "parts"));
  const std::string rest = kBoxes;
  EXPECT_THAT(errors_of(cell_text("templates: [{name: a, sphere: {radius: -1}}]\n" + rest)),
              mistake_at("cell.yaml:4:40", "0"))
      << "a template that no object uses is read, too";
  EXPECT_THAT(
      errors_of(cell_text("templates: [{name: a, sphere: {radius: 1}, fixed: true}]\n" + rest)),
      mistake_at("cell.yaml:4:44", "fixed"));
  EXPECT_THAT(errors_of(cell_text("templates: [{name: a}]\n" + rest)),
              mistake_at("cell.yaml:4:13", "shape"));
  EXPECT_THAT(
      errors_of(cell_text(
          "templates: [{name: a, sphere: {radius: 1}}, {name: a, sphere: {radius: 2}}]\n" + rest)),
      mistake_at("cell.yaml:4:52", "'a'"));
}

TEST(AbsentObjects, MayBeFixedOrMoving) {
  const Scene scene =
      scene_of(cell_text("objects:\n"
                         "  - {name: a, absent: true, sphere: {radius: 1}}\n"
                         "  - {name: b, fixed: true, absent: true, sphere: {radius: 1}}\n"
                         "  - {name: c, absent: false, sphere: {radius: 1}}\n"
                         "pairs: [{between: [a, b]}, {between: [a, c]}]\n"));
  EXPECT_TRUE(scene.objects[0].absent);
  EXPECT_TRUE(scene.objects[1].absent);
  EXPECT_FALSE(scene.objects[2].absent);
  EXPECT_THAT(errors_of(cell_text("objects: [{name: a, absent: 1, sphere: {radius: 1}}]\n"
                                  "pairs: [{between: [a, a]}]\n")),
              mistake_at("cell.yaml:4:29", "1"));
}

}  // namespace
}  // namespace clearance
