#include "config/write/robot_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kRobotUrdf = R"(<?xml version="1.0"?>
<robot name="little">
  <link name="foot"><collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="mast">
    <collision>
      <origin xyz="0 0 0.5" rpy="0 0 0.3"/>
      <geometry><cylinder radius="0.1" length="1"/></geometry>
    </collision>
    <collision><geometry><sphere radius="0.12"/></geometry></collision>
  </link>
  <link name="head"><collision><geometry><mesh filename="package://little_description/head.obj" scale="0.001 0.001 0.001"/></geometry></collision></link>
  <link name="frame"/>
  <joint name="a" type="fixed"><origin xyz="0 0 0.05" rpy="0 0 1.5"/><parent link="foot"/><child link="mast"/></joint>
  <joint name="b" type="revolute"><origin xyz="0 0 1.2"/><parent link="mast"/><child link="head"/></joint>
  <joint name="c" type="fixed"><parent link="head"/><child link="frame"/></joint>
</robot>
)";

const std::string kSrdf = R"(<robot name="little">
  <disable_collisions link1="foot" link2="mast" reason="Adjacent"/>
  <disable_collisions link1="mast" link2="foot" reason="Adjacent"/>
  <disable_collisions link1="frame" link2="foot" reason="Never"/>
  <disable_collisions link1="head" link2="mast" reason="Say &quot;never&quot;"/>
</robot>
)";

// A private package directory for each test, removed afterwards.
class RobotCellFile : public testing::Test {
 protected:
  RobotCellFile() {
    std::filesystem::create_directories(root_ / "little_description" / "urdf");
    std::filesystem::create_directories(root_ / "cells");
    write("little_description/head.obj",
          "v 0 0 0\nv 200 0 0\nv 0 200 0\nv 0 0 200\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    write("little_description/urdf/little.urdf", kRobotUrdf);
    write("little_description/urdf/little.srdf", kSrdf);
    options_.urdf = root_ / "little_description" / "urdf" / "little.urdf";
    options_.srdf = root_ / "little_description" / "urdf" / "little.srdf";
    options_.directory = root_ / "cells";
  }

  void write(const std::string& name, const std::string& text) {
    test::write_text(root_ / name, text);
  }

  RobotCell cell() {
    auto result = robot_cell(options_);
    if (const auto* faults = std::get_if<UrdfFaults>(&result)) {
      ADD_FAILURE() << faults->front().text;
      return {};
    }
    return std::get<RobotCell>(std::move(result));
  }

  Scene scene() { return scene_of(cell().yaml, root_ / "cells" / "little.yaml"); }

  // Returns all faults, one per line.
  std::string fault() {
    const auto result = robot_cell(options_);
    std::string lines;
    if (const auto* faults = std::get_if<UrdfFaults>(&result)) {
      for (const UrdfFault& fault : *faults) lines += fault.text + "\n";
    }
    return lines;
  }

  test::ScratchFolder root_;
  RobotCellOptions options_;
};

TEST_F(RobotCellFile, EveryLinkWithShapesIsAnObjectInItsLinkFrame) {
  const Scene scene = this->scene();
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.name, "little");
  EXPECT_EQ(scene.objects[0].name, "foot");
  EXPECT_FALSE(scene.objects[0].fixed);
  ASSERT_EQ(scene.objects[1].parts.size(), 2u);
  EXPECT_EQ(scene.objects[1].parts[0].object_from_part.position, Vec3(0.0, 0.0, 0.5));
  EXPECT_NEAR(scene.objects[1].parts[0].object_from_part.orientation.z(), std::sin(0.15), 1e-15);
  EXPECT_EQ(scene.objects[1].parts[1].shape.radius, 0.12);
  EXPECT_NEAR(scene.objects[2].parts[0].shape.bounding_radius, 0.2, 1e-12);
}

TEST_F(RobotCellFile, DisabledPairsAreAllowedWithTheirReasons) {
  const Scene scene = this->scene();
  ASSERT_EQ(scene.pairs.size(), 1u);  // foot with head
  EXPECT_EQ(scene.pairs[0].first, 0u);
  EXPECT_EQ(scene.pairs[0].second, 2u);
  EXPECT_THAT(cell().yaml, HasSubstr(R"(between: ["head", "mast"], reason: "Say \"never\"")"));
}

TEST_F(RobotCellFile, WhatIsLeftOutIsSaid) {
  EXPECT_THAT(
      cell().notes,
      ElementsAre(
          HasSubstr("left out: frame"),
          "2 disabled pairs left out: 1 named twice, 1 with a link without collision shapes"));
}

TEST_F(RobotCellFile, ACylinderIsACylinder) {
  const CurvedShape cylinder = scene().objects.at(1).parts.at(0).shape.curved;
  EXPECT_EQ(cylinder.kind, CurvedShape::Kind::kTruncatedCone);
  EXPECT_EQ(cylinder.discs[0], (Disc{-0.5, 0.1}));
  EXPECT_EQ(cylinder.discs[1], (Disc{0.5, 0.1}));
}

TEST_F(RobotCellFile, APackageIsWhereItIsSaidToBe) {
  std::filesystem::create_directories(root_ / "elsewhere");
  std::filesystem::rename(root_ / "little_description" / "head.obj",
                          root_ / "elsewhere" / "head.obj");
  EXPECT_THAT(fault(), mistake_at("little.urdf:11", "head.obj"));
  options_.packages = {{"little_description", root_ / "elsewhere"}};
  EXPECT_THAT(cell().yaml, HasSubstr("file: \"../elsewhere/head.obj\""));
}

TEST_F(RobotCellFile, FaultsNameFileAndLine) {
  const auto with = [&](const std::string& found, const std::string& replacement) {
    std::string text = kRobotUrdf;
    text.replace(text.find(found), found.size(), replacement);
    write("little_description/urdf/little.urdf", text);
    return fault();
  };
  EXPECT_THAT(with("radius=\"0.1\"", "radius=\"wide\""),
              mistake_at("little.urdf:7", "radius=\"wide\""));
  EXPECT_THAT(with("radius=\"0.1\"", "radius=\"-1\""),
              mistake_at("little.urdf:7", "radius=\"-1\""));
  EXPECT_THAT(with("0.4 0.4 0.1", "0.4 0.4"), mistake_at("little.urdf:3", "size=\"0.4 0.4\""));
  EXPECT_THAT(with("<sphere radius=\"0.12\"/>", "<cone/>"), mistake_at("little.urdf:9"));
  EXPECT_THAT(with("name=\"frame\"", "name=\"foot\""), mistake_at("little.urdf:12", "'foot'"));
  EXPECT_THAT(with("child link=\"frame\"", "child link=\"farm\""),
              mistake_at("little.urdf:15", "'farm'"));
  EXPECT_THAT(with("little_description/", "unknown/"),
              mistake_at("little.urdf:11", "--package unknown=DIRECTORY"));
  EXPECT_THAT(with("</robot>", ""), mistake_at("little.urdf:2", "XML"));
  write("little_description/urdf/little.urdf", "<robot name=\"little\"><link name=\"l\"/></robot>");
  EXPECT_THAT(fault(), mistake_at("little.urdf:1"));
}

TEST_F(RobotCellFile, AllFaultsOfBothFilesAreReportedAtOnce) {
  std::string text = kRobotUrdf;
  for (const auto& [found, replacement] : {std::pair("0.4 0.4 0.1", "0.4 0.4"),
                                           {"radius=\"0.1\"", "radius=\"wide\""},
                                           {"<sphere radius=\"0.12\"/>", "<cone/>"},
                                           {"child link=\"frame\"", "child link=\"farm\""}}) {
    text.replace(text.find(found), std::string(found).size(), replacement);
  }
  write("little_description/urdf/little.urdf", text);
  write("little_description/urdf/little.srdf",
        "<robot name=\"little\">\n  <enable_collisions/>\n  <disable_collisions link1=\"foot\"/>\n"
        "</robot>\n");
  const std::string urdf = options_.urdf.string(), srdf = options_.srdf.string();
  EXPECT_EQ(urdf + ":3:47: found size=\"0.4 0.4\"; expected 3 numbers of at least 0\n" +  //
                urdf + ":7:27: found radius=\"wide\"; expected 1 number of at least 0\n" + urdf +
                ":9:26: found <cone> in <geometry>, which is not read and could change a place or "
                "a size; expected 'mesh', 'box', 'sphere', 'cylinder' or 'capsule'\n" +
                urdf + ":15:3: found a joint of the link 'farm', which does not exist\n" + srdf +
                ":2:3: found <enable_collisions> without 'link1'\n" + srdf +
                ":2:3: found <enable_collisions> without 'link2'\n" + srdf +
                ":3:3: found <disable_collisions> without 'link2'\n",
            fault());
}

TEST_F(RobotCellFile, EveryMeshThatIsMissingIsReportedWithItsLine) {
  std::string text = kRobotUrdf;
  text.replace(text.find("<box size=\"0.4 0.4 0.1\"/>"), 25, "<mesh filename=\"foot.stl\"/>");
  text.replace(text.find("head.obj"), 8, "nose.obj");
  write("little_description/urdf/little.urdf", text);
  const std::string fault = this->fault();
  EXPECT_THAT(fault, mistake_at("little.urdf:3", "'foot.stl'"));
  EXPECT_THAT(fault, mistake_at("little.urdf:11", "'package://little_description/nose.obj'"));
}

TEST_F(RobotCellFile, JointsThatMakeALoopAreRefused) {
  std::string text = kRobotUrdf;
  text.replace(text.find("</robot>"), 0,
               "<joint name=\"d\" type=\"fixed\"><parent link=\"frame\"/><child "
               "link=\"foot\"/></joint>\n");
  write("little_description/urdf/little.urdf", text);
  EXPECT_THAT(fault(), mistake_at("little.urdf:16", "'foot'"));
}

TEST_F(RobotCellFile, TheSrdfOfAnotherRobotIsRefused) {
  write("little_description/urdf/little.srdf",
        "<robot name=\"large\">\n"
        "  <disable_collisions link1=\"foot\" link2=\"mast\" reason=\"Adjacent\"/>\n"
        "  <disable_collisions link1=\"foot\" link2=\"boom\" reason=\"Never\"/>\n"
        "  <disable_collisions link1=\"boom\" link2=\"hook\" reason=\"Adjacent\"/>\n"
        "</robot>\n");
  const std::string srdf = options_.srdf.string();
  EXPECT_EQ(srdf + ":1:1: found the robot 'large'; expected 'little', as little.urdf calls it\n" +
                srdf + ":3:3: found the link 'boom'; expected one of the links of little.urdf\n" +
                srdf + ":4:3: found the link 'hook'; expected one of the links of little.urdf\n",
            fault());
}

TEST_F(RobotCellFile, WithoutAnSrdfNeighboursAreLeftOutAndNamed) {
  options_.srdf.clear();
  EXPECT_THAT(cell().notes, ElementsAre(HasSubstr("left out: frame"),
                                        HasSubstr("not watched: foot - mast, mast - head")));
  const Scene scene = this->scene();
  ASSERT_EQ(scene.pairs.size(), 1u);  // foot with head
  EXPECT_EQ(scene.pairs[0].first, 0u);
  EXPECT_EQ(scene.pairs[0].second, 2u);
  EXPECT_THAT(cell().yaml, HasSubstr("reason: \"Adjacent in the URDF\""));
}

// The mast rotates in a bearing that has no shape.
TEST_F(RobotCellFile, WithoutAnSrdfAFrameBetweenTwoLinksMakesThemNeighbours) {
  options_.srdf.clear();
  std::string text = kRobotUrdf;
  text.replace(text.find("<parent link=\"mast\"/>"), 21, "<parent link=\"bearing\"/>");
  text.replace(text.find("</robot>"), 0,
               "<link name=\"bearing\"/><joint name=\"d\" type=\"fixed\"><parent "
               "link=\"mast\"/><child link=\"bearing\"/></joint>\n");
  write("little_description/urdf/little.urdf", text);
  EXPECT_THAT(cell().notes.back(), HasSubstr("watched: foot - mast, mast - head"));
}

// The rules are MoveIt's: pairs disabled by default, without the enabled ones, and pairs disabled
// individually.
TEST_F(RobotCellFile, DefaultsOfAnSrdfHoldButForPairsThatItEnables) {
  write("little_description/urdf/little.srdf",
        "<robot name=\"little\">\n"
        "  <disable_default_collisions link=\"foot\"/>\n"
        "  <enable_collisions link1=\"foot\" link2=\"mast\"/>\n"
        "</robot>\n");
  const Scene scene = this->scene();
  ASSERT_EQ(scene.pairs.size(), 2u);
  EXPECT_EQ(scene.pairs[0].second, 1u);  // foot - mast is enabled, foot - head is not
  EXPECT_EQ(scene.pairs[1].first, 1u);
  EXPECT_THAT(cell().yaml, HasSubstr("reason: \"disabled by default in the SRDF\""));
  EXPECT_THAT(cell().notes, testing::Contains(HasSubstr("1 pair disabled by default")));
  // A pair that is disabled individually stays disabled.
  write("little_description/urdf/little.srdf",
        "<robot name=\"little\">\n"
        "  <disable_default_collisions link=\"head\"/>\n"
        "  <enable_collisions link1=\"foot\" link2=\"mast\"/>\n"
        "  <disable_collisions link1=\"mast\" link2=\"foot\"/>\n"
        "  <enable_collisions link1=\"head\" link2=\"foot\"/>\n"
        "</robot>\n");
  EXPECT_EQ(this->scene().pairs.size(), 1u);
}

TEST_F(RobotCellFile, LinksThatDefaultsNameMustExist) {
  write("little_description/urdf/little.srdf",
        "<robot name=\"little\">\n  <disable_default_collisions link=\"fot\"/>\n</robot>\n");
  EXPECT_THAT(fault(), mistake_at("little.srdf:2", "'fot'"));
}

TEST_F(RobotCellFile, ACapsuleIsOneWithItsEndsAlongZ) {
  std::string text = kRobotUrdf;
  const std::string sphere = "<sphere radius=\"0.12\"/>";
  text.replace(text.find(sphere), sphere.size(), "<capsule radius=\"0.12\" length=\"1\"/>");
  write("little_description/urdf/little.urdf", text);
  const Scene scene = this->scene();
  const ConvexBody& capsule = scene.objects.at(1).parts.at(1).shape;
  EXPECT_EQ(capsule.radius, 0.12);
  ASSERT_EQ(capsule.anchors.size(), 2u);
  EXPECT_EQ((capsule.anchors[0] - capsule.anchors[1]).cwiseAbs(), Vec3(0, 0, 1));
  EXPECT_THAT(cell().yaml,
              HasSubstr("capsule: {from: [0, 0, -0.5], to: [0, 0, 0.5], radius: 0.12}"));
}

}  // namespace
}  // namespace clearance
