// clearance-scene itself: what it writes, and how it ends.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/shared/child_process.hpp"

namespace clearance {
namespace {

using test::ChildProcess;

class SceneProgram : public testing::Test {
 protected:
  SceneProgram() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "clearance_scene_XXXXXX").string();
    directory_ = mkdtemp(pattern.data());
    std::ofstream(directory_ / "robot.urdf") << "<robot name=\"two\">\n"
                                                "<link name=\"a\"><collision><geometry><sphere "
                                                "radius=\"0.1\"/></geometry></collision></link>\n"
                                                "<link name=\"b\"><collision><geometry><box "
                                                "size=\"1 1 1\"/></geometry></collision></link>\n"
                                                "</robot>\n";
  }
  ~SceneProgram() override { std::filesystem::remove_all(directory_); }

  int run(std::vector<std::string> arguments) {
    ChildProcess program(std::string(CLEARANCE_BIN) + "/clearance-scene", std::move(arguments));
    const int status = program.wait();
    output_ = program.output();
    return status;
  }

  std::string file(const std::string& name) const { return (directory_ / name).string(); }

  std::filesystem::path directory_;
  std::string output_;
};

TEST_F(SceneProgram, WritesACellThatIsGood) {
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml")}), 0) << output_;
  EXPECT_NE(output_.find("two: 2 objects (2 moving, 0 fixed)"), std::string::npos) << output_;
  EXPECT_TRUE(std::filesystem::exists(file("cell.yaml")));
}

TEST_F(SceneProgram, WritesOverAFileOnlyWhenForced) {
  std::ofstream(file("cell.yaml")) << "precious";
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml")}), 1);
  EXPECT_NE(output_.find("is there already; --force writes over it"), std::string::npos) << output_;
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

TEST_F(SceneProgram, WrongUsageEndsWithTwo) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"--from-urdf", file("robot.urdf"), "-o", file("cell.yaml"), "--package", "x"}), 2);
}

}  // namespace
}  // namespace clearance
