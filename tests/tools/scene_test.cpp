// clearance-scene itself: what it writes, and how it ends.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/shared/child_process.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::ChildProcess;

class SceneProgram : public testing::Test {
 protected:
  SceneProgram() {
    std::ofstream(directory_ / "robot.urdf") << "<robot name=\"two\">\n"
                                                "<link name=\"a\"><collision><geometry><sphere "
                                                "radius=\"0.1\"/></geometry></collision></link>\n"
                                                "<link name=\"b\"><collision><geometry><box "
                                                "size=\"1 1 1\"/></geometry></collision></link>\n"
                                                "</robot>\n";
  }

  int run(std::vector<std::string> arguments) {
    ChildProcess program(std::string(CLEARANCE_BIN) + "/clearance-scene", std::move(arguments));
    const int status = program.wait();
    output_ = program.output();
    return status;
  }

  std::string file(const std::string& name) const { return (directory_ / name).string(); }

  test::ScratchFolder directory_;
  std::string output_;
};

TEST_F(SceneProgram, WritesACellThatIsGood) {
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("two: 2 objects (2 moving, 0 fixed)"), std::string::npos) << output_;
  EXPECT_TRUE(std::filesystem::exists(file("cell.yaml")));
}

// Three balls in a row on two joints.
std::string chain_urdf() {
  std::string urdf = "<robot name=\"chain\">\n";
  for (const char* link : {"a", "b", "c"}) {
    urdf += std::string("<link name=\"") + link +
            "\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>\n";
  }
  return urdf +
         "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/></joint>\n"
         "<joint name=\"k\" type=\"revolute\"><parent link=\"b\"/><child link=\"c\"/></joint>\n"
         "</robot>\n";
}

TEST_F(SceneProgram, SaysWhichNeighboursItLeavesOutWithoutAnSrdf) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  EXPECT_EQ(run({"--from-urdf", file("chain.urdf"), "-o", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("note: no SRDF: neighbours are left out, and every other pair of links is "
                         "watched: a - b, b - c"),
            std::string::npos)
      << output_;
  EXPECT_NE(output_.find("1 pair"), std::string::npos) << output_;
}

TEST_F(SceneProgram, RefusesTheSrdfOfAnotherRobotAndWritesNothing) {
  std::ofstream(directory_ / "chain.urdf") << chain_urdf();
  std::ofstream(directory_ / "other.srdf")
      << "<robot name=\"other\">\n<disable_collisions link1=\"a\" link2=\"x\"/>\n</robot>\n";
  EXPECT_EQ(run({"--from-urdf", file("chain.urdf"), "--srdf", file("other.srdf"), "-o",
                 file("cell.yaml")}),
            1);
  EXPECT_NE(output_.find("other.srdf:1: found the robot 'other'"), std::string::npos) << output_;
  EXPECT_NE(output_.find("other.srdf:2: found the link 'x'"), std::string::npos) << output_;
  EXPECT_FALSE(std::filesystem::exists(file("cell.yaml")));
}

TEST_F(SceneProgram, WritesOverAFileOnlyWhenForced) {
  std::ofstream(file("cell.yaml")) << "precious";
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml")}), 1);
  EXPECT_NE(output_.find("exists; --force overwrites it"), std::string::npos) << output_;
  EXPECT_EQ(std::filesystem::file_size(file("cell.yaml")), 8u);
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml"), "--force"}), 0)
      << output_;
}

TEST_F(SceneProgram, ACellThatIsNoGoodIsWrittenAndExplained) {
  std::ofstream(directory_ / "alone.urdf")
      << "<robot name=\"alone\"><link name=\"a\"><collision><geometry><sphere "
         "radius=\"0.1\"/></geometry>"
         "</collision></link></robot>\n";
  EXPECT_EQ(run({"--from-urdf", file("alone.urdf"), "-o", file("cell.yaml")}), 3);
  EXPECT_NE(output_.find("cell.yaml:"), std::string::npos) << output_;
}

TEST_F(SceneProgram, WhatCannotBeReadOrWrittenEndsWithOne) {
  std::ofstream(directory_ / "broken.urdf") << "<robot";
  EXPECT_EQ(run({"--from-urdf", file("broken.urdf"), "-o", file("cell.yaml")}), 1);
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("nowhere/cell.yaml")}), 1);
}

TEST_F(SceneProgram, WritesAWarehouseOfAsManyObjectsAsAskedFor) {
  EXPECT_EQ(run({"--warehouse", "61", "-o", file("warehouse.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("warehouse_61: 61 objects (12 moving, 49 fixed)"), std::string::npos)
      << output_;
}

// A cell of a block of two parts, 1 m apart, and a floor.
constexpr const char* kTwoParts = R"(name: two_parts
units: {length: m, angle: rad}
objects:
  - name: block
    parts:
      - box: {size: [1, 1, 1]}
      - {box: {size: [1, 1, 1]}, pose: {xyz: [2, 0, 0]}}
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: -5}}
pairs: [{between: [block, floor]}]
)";

TEST_F(SceneProgram, ReportsTheModelsOfEachObjectAndTheirErrors) {
  std::ofstream(directory_ / "cell.yaml") << kTwoParts;
  ASSERT_EQ(run({"--report", file("cell.yaml"), "--json"}), 0) << output_;
  const auto objects = nlohmann::json::parse(output_);
  ASSERT_EQ(objects.size(), 2u);
  const auto& block = objects[0];
  EXPECT_EQ(block["object"], "block");
  EXPECT_EQ(block["full"]["parts"], 2);
  EXPECT_EQ(block["full"]["facets"], 12);
  EXPECT_EQ(block["hull"]["facets"], 6);
  EXPECT_GE(block["hull"]["error"], 0.5);  // halfway between the two
  EXPECT_LE(block["hull"]["error"], 0.5 / 0.98);
  EXPECT_GE(block["sphere"]["radius"], 1.5);
  EXPECT_FALSE(objects[1].contains("sphere"));
  EXPECT_FALSE(objects[1].contains("hull"));

  ASSERT_EQ(run({"--report", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("block "), std::string::npos) << output_;
  EXPECT_NE(output_.find("2 objects, 1 with a hull"), std::string::npos) << output_;
}

TEST_F(SceneProgram, ReportsTheErrorsOfACellThatIsNoGood) {
  std::ofstream(directory_ / "cell.yaml") << "name: empty\n";
  EXPECT_EQ(run({"--report", file("cell.yaml")}), 3);
  EXPECT_NE(output_.find("cell.yaml:"), std::string::npos) << output_;
}

TEST_F(SceneProgram, WrongUsageEndsWithTwo) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"--warehouse", "100"}), 2);
  EXPECT_EQ(run({"--warehouse", "10", "-o", file("cell.yaml")}), 2);
  EXPECT_EQ(run({"--report", "x.yaml", "--warehouse", "100"}), 2);
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml"), "--package", "x"}), 2);
}

}  // namespace
}  // namespace clearance
