#include "config/urdf/robot_files.hpp"

#include <gtest/gtest.h>

#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

class RobotFilesTest : public testing::Test {
 protected:
  RobotFilesTest() {
    std::filesystem::create_directories(folder_ / "arm/meshes");
    std::filesystem::create_directories(folder_ / "other");
  }
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& name) const {
    return files_.find(name);
  }

  test::ScratchFolder folder_;
  RobotFiles files_{folder_ / "arm/urdf/arm.urdf", {{"named", folder_ / "other"}}};
};

TEST_F(RobotFilesTest, FindAPathWithinItsPackage) {
  EXPECT_EQ(find("package://arm/meshes/a.stl"), folder_ / "arm/meshes/a.stl");
  EXPECT_EQ(find("package://arm/urdf/../meshes/a.stl"), folder_ / "arm/meshes/a.stl");
  EXPECT_EQ(find("package://named/a.stl"), folder_ / "other/a.stl");
  EXPECT_EQ(find("package://gone/a.stl"), std::nullopt);
}

TEST_F(RobotFilesTest, FindNothingThatLeadsOutOfItsPackage) {
  for (const std::string name :
       {"package://../other/a.stl", "package://./other/a.stl", "package:///other/a.stl",
        "package://..", "package://arm/../other/a.stl", "package://arm/meshes/../../other/a.stl",
        "package://arm//etc/passwd", "package://named/..", "package://named/../arm/a.stl"}) {
    EXPECT_EQ(find(name), std::nullopt) << name;
    EXPECT_NE(files_.why_not_found(name, PackagesFrom::kCell).find("leads out of its package"),
              std::string::npos)
        << name;
  }
}

// With a root, the files are those of another machine.
TEST_F(RobotFilesTest, FindNothingThatLeadsOutOfTheRoot) {
  files_ = {folder_ / "arm/urdf/arm.urdf", {}, folder_ / "arm"};
  const std::string root = (folder_ / "arm").string();
  EXPECT_EQ(find("../meshes/a.stl"), folder_ / "arm/meshes/a.stl");
  EXPECT_EQ(find("file:///meshes/../a.stl"), folder_ / "arm/a.stl");
  EXPECT_EQ(find("package://meshes/a.stl"), folder_ / "arm/meshes/a.stl");
  for (const std::string& name :
       {std::string("../../other/a.stl"), std::string("../../armed/a.stl"),
        std::string("/../other/a.stl"), std::string("file:///meshes/../../other/a.stl"),
        root + "/../other/a.stl", "file://" + root + "/../other/a.stl"}) {
    EXPECT_EQ(find(name), std::nullopt) << name;
    EXPECT_NE(files_.why_not_found(name, PackagesFrom::kCell).find("leads out of the files"),
              std::string::npos)
        << name;
  }
  EXPECT_EQ(find("package://other/a.stl"), std::nullopt) << "a folder above the root";
  std::filesystem::create_directories(folder_ / "arm/kept/other");
  EXPECT_EQ(find("package://other/a.stl"), folder_ / "arm/kept/other/a.stl");
}

}  // namespace
}  // namespace clearance
