// What stays known of a robot when its cell changes.
#include "config/scene/scene_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

// Whether a robot, and positions of it that were sent before the change, are known afterwards.
struct Known {
  bool of_robot, of_samples;
};

class RobotsOfAChangedCell : public testing::Test {
 protected:
  RobotsOfAChangedCell() { test::write_text(folder_ / "arm.urdf", kArm); }

  // `before` and `now`: further keys of the robot.
  Known known(const std::string& before, const std::string& now) const {
    const Scene old = scene(before), changed = scene(now);
    const SceneMap map = scene_map(old, changed);
    const auto is_none = [](std::uint32_t index) { return index == SceneMap::kNone; };
    EXPECT_GT(changed.variables.size(), 0u);
    const bool of_robot = !is_none(map.robots.at(0));
    EXPECT_EQ(std::ranges::none_of(map.variables, is_none), of_robot);
    EXPECT_EQ(std::ranges::all_of(map.variables, is_none), !of_robot);
    const bool of_samples = std::ranges::none_of(map.variables_now, is_none);
    EXPECT_EQ(std::ranges::all_of(map.variables_now, is_none), !of_samples);
    return {of_robot, of_samples};
  }
  void expect(const std::string& before, const std::string& now, bool stays) const {
    const Known found = known(before, now);
    EXPECT_EQ(found.of_robot, stays) << before << " -> " << now;
    EXPECT_EQ(found.of_samples, stays) << before << " -> " << now;
  }

 private:
  static constexpr const char* kArm =
      "<robot name=\"arm\"><link name=\"foot\"/><link name=\"hand\"><collision><geometry>"
      "<sphere radius=\"0.1\"/></geometry></collision></link>"
      "<joint name=\"turn\" type=\"continuous\"><parent link=\"foot\"/><child link=\"hand\"/>"
      "<axis xyz=\"0 0 1\"/></joint></robot>";
  Scene scene(const std::string& keys) const {
    return scene_of(
        "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\n"
        "robots: [{name: one, " +
            keys +
            "}]\nobjects: [{name: post, fixed: true, sphere: {radius: 0.1}}]\n"
            "pairs: [{between: [one, post]}]\n",
        folder_ / "cell.yaml");
  }

  test::ScratchFolder folder_;
};

TEST_F(RobotsOfAChangedCell, StayKnownIfTheSameSenderPlacesThem) {
  expect("urdf: arm.urdf", "urdf: arm.urdf, margin: 0.01", true);
  expect("urdf: arm.urdf", "urdf: arm.urdf, joint_states: /arm/joints", false);
  expect("urdf: arm.urdf, base: {frame: a}", "urdf: arm.urdf, base: {frame: b}", false);
}

// One person leaves and another one gets the same place: where the first one was says nothing.
TEST_F(RobotsOfAChangedCell, AreUnknownIfTheyAreAnotherPerson) {
  const std::string one = "person: {stature: 1.7, error: 0.1, id: b1}";
  expect(one, one + ", margin: 0.01", true);
  expect(one, "person: {stature: 1.7, error: 0.1, id: b2}", false);
  expect(one, "person: {stature: 1.7, error: 0.1}", false);
  expect("person: {stature: 1.7, error: 0.1}", one, false);
}

}  // namespace
}  // namespace clearance
