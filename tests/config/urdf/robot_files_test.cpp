#include "config/urdf/robot_files.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

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
       {"package://../other/a.stl", "package://./other/a.stl", "package://..",
        "package://arm/../other/a.stl", "package://arm/meshes/../../other/a.stl",
        "package://arm//etc/passwd", "package://named/..", "package://named/../arm/a.stl"}) {
    EXPECT_EQ(find(name), std::nullopt) << name;
    EXPECT_NE(files_.why_not_found(name, PackagesFrom::kCell).find("leads out of its package"),
              std::string::npos)
        << name;
  }
}

TEST_F(RobotFilesTest, SayThatANameHasNoPackage) {
  for (const std::string name : {"package:///other/a.stl", "package://"}) {
    EXPECT_EQ(find(name), std::nullopt) << name;
    EXPECT_NE(files_.why_not_found(name, PackagesFrom::kCell).find("names no package"),
              std::string::npos)
        << name;
  }
}

// Sets a variable of the environment while it lives, or unsets it with nullptr.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Environment() { set(before_ ? before_->c_str() : nullptr); }
  void set(const char* value) const {
    value == nullptr ? unsetenv(name_) : setenv(name_, value, 1);
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST_F(RobotFilesTest, SaysWhereItLookedForAPackage) {
  const Environment prefixes("AMENT_PREFIX_PATH", nullptr);
  const auto why = [this](PackagesFrom from) {
    return files_.why_not_found("package://gone/a.stl", from);
  };
  const std::string above = (folder_ / "arm/urdf").string() + ", the folders above it, and ";
  EXPECT_EQ(why(PackagesFrom::kCell), "no directory for the package 'gone' in " + above +
                                          "AMENT_PREFIX_PATH, which names none; expected packages: "
                                          "{gone: DIRECTORY}, or PREFIX/share/gone with PREFIX in "
                                          "AMENT_PREFIX_PATH");
  prefixes.set("/opt/ros:/ws");
  EXPECT_EQ(why(PackagesFrom::kCommandLine),
            "no directory for the package 'gone' in " + above +
                "AMENT_PREFIX_PATH's /opt/ros/share, /ws/share; expected --package gone=DIRECTORY, "
                "or PREFIX/share/gone with PREFIX in AMENT_PREFIX_PATH");
  files_.root = folder_ / "arm";
  EXPECT_EQ(why(PackagesFrom::kCell), "no directory for the package 'gone' in " +
                                          (folder_ / "arm").string() +
                                          " and its folders; expected packages: {gone: DIRECTORY}");
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
