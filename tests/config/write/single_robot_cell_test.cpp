#include "config/write/single_robot_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// Mistakes of the tree, of joints, of meshes and of shapes are found in different stages; the last
// lines have two digits.
const std::string kHead = R"(<robot name="arm">
  <link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
)";
const std::string kBlank = "\n\n\n\n\n";

class SingleRobot : public testing::Test {
 protected:
  std::vector<std::string> errors(const std::string& urdf, const std::string& name = "arm.urdf") {
    test::write_text(folder_ / name, urdf);
    const CellResult read = read_single_robot({.urdf = folder_ / name});
    std::vector<std::string> texts;
    if (const auto* found = std::get_if<std::vector<CellError>>(&read)) {
      for (const CellError& error : *found) texts.push_back(error.text);
    }
    return texts;
  }
  // Begins with this line of the URDF, and with nothing else.
  [[nodiscard]] auto at(int line, int column, const std::string& name = "arm.urdf") const {
    return StartsWith((folder_ / name).string() + ":" + std::to_string(line) + ":" +
                      std::to_string(column) + ": found ");
  }

  test::ScratchFolder folder_;
};

TEST_F(SingleRobot, MistakesOfTheElementsNameTheLinesOfTheUrdfByNumber) {
  EXPECT_THAT(
      errors(
          kHead +
          R"(  <link name="b"><collision><geometry><box size="1 1 -1"/></geometry></collision></link>)" +
          kBlank +
          R"(
  <joint name="j1" type="fixed"><parent link="a"/><child link="c"/></joint>
  <joint name="j2" type="fixed"><parent link="a"/><child link="d"/></joint>
</robot>)"),
      ElementsAre(at(3, 44), at(9, 3), at(10, 3)));
}

TEST_F(SingleRobot, MistakesOfTheJointsNameTheLinesOfTheUrdfByNumber) {
  EXPECT_THAT(errors(kHead + R"(  <link name="b"/> <link name="c"/>
  <joint name="j1" type="revolute"><parent link="a"/><child link="b"/></joint>)" +
                     kBlank + kBlank +
                     R"(<joint name="j2" type="turning"><parent link="a"/><child link="c"/></joint>
</robot>)"),
              ElementsAre(at(4, 3), at(14, 1)));
}

TEST_F(SingleRobot, MistakesOfMeshesNameTheLinesOfTheUrdfByNumber) {
  test::write_text(folder_ / "damaged.stl", "solid x");
  const auto link = [](const std::string& name, const std::string& mesh) {
    return "<link name=\"" + name + "\"><collision><geometry><mesh filename=\"" + mesh +
           "\"/></geometry></collision></link>\n<joint name=\"of_" + name +
           "\" type=\"continuous\"><parent link=\"a\"/><child link=\"" + name + "\"/></joint>\n";
  };
  EXPECT_THAT(
      errors(kHead + link("b", "gone.stl") + kBlank + link("c", "package://nix/c.stl") +
             link("d", "damaged.stl") + "</robot>"),
      ElementsAre(at(3, 37), AllOf(at(10, 37), HasSubstr("--package nix=DIRECTORY")), at(12, 37)));
}

TEST_F(SingleRobot, AFileThatIsMissingIsNamedWithoutALine) {
  const CellResult read = read_single_robot({.urdf = folder_ / "gone.urdf"});
  const auto& found = std::get<std::vector<CellError>>(read);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].text, StartsWith((folder_ / "gone.urdf").string() + ": found "));
}

// Links that macros make are missing, and every joint of theirs would be a mistake of its own.
TEST_F(SingleRobot, AFileThatXacroHasToExpandGivesOneLineWithTheCommand) {
  const std::string rest = R"(
  <joint name="j1" type="fixed"><parent link="a"/><child link="x_l"/></joint>
  <joint name="j2" type="fixed"><parent link="a"/><child link="y_l"/></joint>
</robot>)";
  const auto helps = [&](int line, int column) {
    return ElementsAre(
        AllOf(at(line, column, "arm.urdf.xacro"), HasSubstr("xacro arm.urdf.xacro > arm.urdf")));
  };
  const std::string macro =
      R"(<xacro:macro name="m" params="p"><link name="${p}_l"/></xacro:macro>)";
  EXPECT_THAT(errors(kHead + macro + rest, "arm.urdf.xacro"), helps(3, 1));
  const std::string within = R"(<link name="b"><xacro:if value="1"><visual/></xacro:if></link>)";
  EXPECT_THAT(errors(kHead + within + rest, "arm.urdf.xacro"), helps(3, 16));
  const std::string value = R"(<link name="b"><inertial><mass value="${m}"/></inertial></link>)";
  EXPECT_THAT(errors(kHead + "\n" + value + rest, "arm.urdf.xacro"), helps(4, 26));
}

TEST_F(SingleRobot, WhatIsForOtherProgramsNeedsNoXacro) {
  const auto link = [](const std::string& name, const std::string& parent) {
    return "<link name=\"" + name +
           "\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>"
           "<joint name=\"of_" +
           name + "\" type=\"continuous\"><parent link=\"" + parent + "\"/><child link=\"" + name +
           "\"/></joint>\n";
  };
  const std::string plugin = "<gazebo><plugin filename=\"$(find x)\"/></gazebo></robot>";
  EXPECT_THAT(errors(kHead + link("b", "a") + link("c", "b") + plugin), ElementsAre());
}

}  // namespace
}  // namespace clearance
