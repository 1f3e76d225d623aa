// A robot with revolute, prismatic and mimic joints, and cells in which its stops are stated.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {

// The joint `finger` mimics `grip`, backwards. Speeds in rad/s and m/s. `elbow` has the limits of
// URDF 1.2.
inline const std::string kArmUrdf = R"(<robot name="arm">
  <link name="foot"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="upper"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="fore"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="rail"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="hand"/> <link name="left"/> <link name="right"/>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="3"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="fore"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="4" acceleration="12" deceleration="8"/></joint>
  <joint name="reach" type="prismatic"><origin xyz="0.5 0 0"/><parent link="fore"/><child link="rail"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" velocity="0.5"/></joint>
  <joint name="bolt" type="fixed"><parent link="rail"/><child link="hand"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" velocity="0.2"/></joint>
  <joint name="finger" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 1 0"/>
    <limit lower="-0.1" upper="0" velocity="0.2"/><mimic joint="grip" multiplier="-1"/></joint>
</robot>
)";

class StoppingCells : public testing::Test {
 protected:
  StoppingCells() { test::write_text(folder_ / "arm.urdf", kArmUrdf); }

  // The robot stands in line 4, its stopping in line 5. Lengths in m, angles in deg.
  static std::string cell(const std::string& stopping, const std::string& objects = "",
                          const std::string& zones = "", const std::string& robot = "") {
    return "name: test\nunits: {length: m, angle: deg}\nrobots:\n  - {name: arm, urdf: arm.urdf" +
           robot + (stopping.empty() ? "" : ",\n     stopping: " + stopping) +
           "}\nobjects:\n  - {name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [3, 0, "
           "0]}}\n" +
           objects + "pairs:\n  - {between: [arm, post]}\n" + zones;
  }
  Scene scene(const std::string& text) { return scene_of(text, folder_ / "cell.yaml"); }
  std::string errors(const std::string& text) { return errors_of(text, folder_ / "cell.yaml"); }

  // The index of a joint of the only robot.
  static std::size_t joint(const Scene& scene, const std::string& name) {
    const auto& joints = scene.robots.at(0).joints;
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (joints[i].name == name) return i;
    ADD_FAILURE() << name;
    return 0;
  }
  static const JointStop& stop(const Scene& scene, const std::string& name) {
    return scene.robots.at(0).stopping.joints.at(joint(scene, name));
  }

  test::ScratchFolder folder_;
};

}  // namespace clearance
