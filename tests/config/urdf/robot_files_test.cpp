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
    return RobotFiles{folder_ / "arm/urdf/arm.urdf", {{"named", folder_ / "other"}}}.find(name);
  }

  test::ScratchFolder folder_;
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
    EXPECT_NE(why_not_found(name, PackagesFrom::kCell).find("leads out of its package"),
              std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace clearance
