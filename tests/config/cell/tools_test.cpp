// Robots that carry robots: the groups, the pairs and the joints of tools.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/tool_cell.hpp"

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kGripperDock =
    "base: {pose: {xyz: [1.6716, 0.7833, 0]}}\n    joints: {finger: {position: 0.01}}";
const std::string kTorchDock =
    "base: {pose: {xyz: [1.6716, -0.7833, 0]}}\n    joints: {tilt: {position: 0.2}}";

// The cell of the tools, with other texts in it.
class Tools : public testing::Test {
 protected:
  Tools() { test::write_tools(folder_); }
  void put(const std::string& what, const std::string& text) {
    ASSERT_NE(text_.find(what), std::string::npos) << what;
    text_.replace(text_.find(what), what.size(), text);
  }
  [[nodiscard]] Scene scene() const { return scene_of(text_, folder_ / "cell.yaml"); }
  [[nodiscard]] std::string errors() const { return errors_of(text_, folder_ / "cell.yaml"); }
  static const Object& object(const Scene& scene, const std::string& name) {
    return *std::ranges::find(scene.objects, name, &Object::name);
  }
  static const JointVariable& variable(const Scene& scene, const std::string& name) {
    return *std::ranges::find(scene.variables, name, &JointVariable::name);
  }
  static bool has_pair(const Scene& scene, const std::string& a, const std::string& b) {
    return std::ranges::any_of(scene.pairs, [&](const ObjectPair& pair) {
      const std::string &first = scene.objects[pair.first].name,
                        &second = scene.objects[pair.second].name;
      return (first == a && second == b) || (first == b && second == a);
    });
  }

  test::ScratchFolder folder_;
  std::string text_ = test::kToolCell;
};

TEST_F(Tools, CountAsTheirCarrierWhileItCarriesThem) {
  Scene docked = scene();
  EXPECT_THAT(object(docked, "g_left").groups, ElementsAre("gripper"));
  put(kGripperDock, "attached: {to: flange, pose: {xyz: [0.01, 0, 0]}}");
  const Scene attached = scene();
  EXPECT_THAT(object(attached, "g_left").groups, ElementsAre("gripper", "arm"));
  EXPECT_EQ(attached.zones[0].pairs.size(), docked.zones[0].pairs.size() + 3);
  const Robot& gripper = attached.robots[1];
  EXPECT_EQ(gripper.base.kind, RobotBase::Kind::kLink);
  EXPECT_EQ(attached.robots[0].links[gripper.base.link].name, "flange");
  EXPECT_EQ(gripper.base.base_from_root.position, Vec3(0.01, 0, 0));
}

TEST_F(Tools, CarryTools) {
  put(kGripperDock, "attached: {to: flange}");
  put(kTorchDock, "attached: {to: g_palm}");
  EXPECT_THAT(object(scene(), "t_tip").groups, ElementsAre("torch", "gripper", "arm"));
}

TEST_F(Tools, AreNamedWhereARuleNamesTheLinkThatCarriesThem) {
  put("between: [arm, person], enter_below", "between: [wrist, person], enter_below");
  EXPECT_EQ(scene().zones[0].pairs.size(), 1u);
  put(kGripperDock, "attached: {to: wrist}");
  EXPECT_EQ(scene().zones[0].pairs.size(), 4u);
}

TEST_F(Tools, HaveThePairsOfTheSrdfOfBothOnlyWhileOneCarriesTheOther) {
  const std::pair<std::string, std::string> by_both[] = {
      {"lower", "g_palm"}, {"wrist", "g_left"}, {"wrist", "g_right"}};
  const Scene docked = scene();
  for (const auto& [a, b] : by_both) EXPECT_TRUE(has_pair(docked, a, b)) << a << b;
  put(kGripperDock, "attached: {to: flange}");
  const Scene attached = scene();
  for (const auto& [a, b] : by_both) EXPECT_FALSE(has_pair(attached, a, b)) << a << b;
  EXPECT_FALSE(has_pair(attached, "wrist", "g_palm")) << "they are rigid";
  EXPECT_TRUE(has_pair(attached, "upper", "g_palm"));
  EXPECT_TRUE(has_pair(attached, "g_left", "g_right"));
}

TEST_F(Tools, HaveThePairsOfTheSrdfWithARobotThatCarriesThemByAnother) {
  put(kGripperDock, "attached: {to: flange}");
  put(kTorchDock, "attached: {to: g_palm}");
  EXPECT_FALSE(has_pair(scene(), "wrist", "t_neck"));
  EXPECT_TRUE(has_pair(scene(), "wrist", "t_tip"));
}

TEST_F(Tools, AreRefusedWithAnSrdfOfOtherLinks) {
  test::write_text(folder_ / "arm_gripper.srdf",
                   "<robot name=\"both\">\n"
                   "  <disable_collisions link1=\"wrist\" link2=\"g_plam\" reason=\"Never\"/>\n"
                   "</robot>\n");
  EXPECT_THAT(errors(), HasSubstr("arm_gripper.srdf:2:"));
  EXPECT_THAT(errors(), HasSubstr("found the link 'g_plam', which neither robot has; expected one "
                                  "of the links of 'arm' or 'gripper'; did you mean 'g_palm'?"));
}

TEST_F(Tools, AreRefusedWithANameThatBothUrdfsHave) {
  std::string urdf = test::kTorchUrdf;
  for (std::size_t at = 0; (at = urdf.find("\"tip\"", at)) != std::string::npos;)
    urdf.replace(at, 5, "\"wrist\"");
  std::string srdf = test::kTorchSrdf;
  srdf.replace(srdf.find("tip"), 3, "wrist");
  test::write_text(folder_ / "torch.urdf", urdf);
  test::write_text(folder_ / "torch.srdf", srdf);
  EXPECT_EQ(errors(), "") << "a name of the cell counts first";
  put("{name: arm, urdf: arm.urdf, srdf: arm.srdf}",
      "{name: arm, urdf: arm.urdf, srdf: arm.srdf, prefix: a_}");
  EXPECT_THAT(errors(), HasSubstr("found the link 'wrist', which each of both robots has"));
}

TEST_F(Tools, AreRefusedWithTheSrdfOfARobotThatIsNoneBeforeThem) {
  put("srdf_with: {arm: arm_gripper.srdf}", "srdf_with: {amr: arm_gripper.srdf}");
  EXPECT_THAT(errors(), HasSubstr("found the unknown robot 'amr'; expected one that stands before "
                                  "this one; did you mean 'arm'?"));
}

TEST_F(Tools, AreRefusedWithABaseBesideACarrier) {
  put(kGripperDock, kGripperDock + "\n    attached: {to: flange}");
  EXPECT_THAT(errors(), HasSubstr("found 'attached' of a robot with a 'base'"));
}

TEST_F(Tools, AreRefusedOnALinkThatIsNoneBeforeThem) {
  put(kGripperDock, "attached: {to: flage}");
  EXPECT_THAT(errors(), HasSubstr("found the unknown name 'flage'"));
  EXPECT_THAT(errors(), HasSubstr("did you mean 'flange'?"));
}

TEST_F(Tools, HaveJointsThatStandWhereTheCellSays) {
  const Scene docked = scene();
  EXPECT_TRUE(variable(docked, "g_finger").is_held());
  EXPECT_EQ(variable(docked, "g_finger").held, 0.01);
  EXPECT_FALSE(variable(docked, "elbow").is_held());
  put("position: 0.01", "position: 0.05");
  EXPECT_THAT(errors(), HasSubstr("found the position 0.05 of 'g_finger'; expected one within its "
                                  "limits, from 0 to 0.04"));
}

TEST_F(Tools, ThatAreAbsentMakeAllTheirLinksAbsentAndWhatTheseCarry) {
  put(kGripperDock, "absent: true");
  put("  - {name: person,",
      "  - {name: part, attached: {to: g_left}, sphere: {radius: 0.01}}\n"
      "  - {name: person,");
  const Scene away = scene();
  for (const char* name : {"g_palm", "g_left", "g_right", "part"})
    EXPECT_TRUE(object(away, name).absent) << name;
  EXPECT_FALSE(object(away, "t_tip").absent);
  EXPECT_FALSE(variable(away, "g_finger").is_read);
  EXPECT_TRUE(variable(away, "t_tilt").is_read);
}

TEST_F(Tools, WithoutShapesAtTheLinkMakeWhatItCarriesAbsentToo) {
  put(kTorchDock, "absent: true");
  put("  - {name: person,",
      "  - {name: wire, attached: {to: t_base}, sphere: {radius: 0.01}}\n"
      "  - {name: person,");
  EXPECT_TRUE(object(scene(), "wire").absent);
}

}  // namespace
}  // namespace clearance
