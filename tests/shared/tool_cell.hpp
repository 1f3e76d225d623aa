// An arm and two tools with joints, a gripper and a torch. All shapes are balls, so that places of
// their centres and distances have closed forms, which share nothing with the project.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "core/pose.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

inline constexpr const char* kToolArmUrdf = R"(<robot name="arm">
  <link name="foot"><collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="wrist"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="flange"/>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="4"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="1 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="4"/></joint>
  <joint name="roll" type="revolute"><origin xyz="1 0 0"/><parent link="lower"/><child link="wrist"/><axis xyz="1 0 0"/><limit lower="-3" upper="3" velocity="4"/></joint>
  <joint name="mount" type="fixed"><origin xyz="0.05 0 0"/><parent link="wrist"/><child link="flange"/></joint>
</robot>
)";
inline constexpr const char* kToolArmSrdf = R"(<robot name="arm">
  <disable_collisions link1="foot" link2="upper" reason="Adjacent"/>
  <disable_collisions link1="upper" link2="lower" reason="Adjacent"/>
  <disable_collisions link1="lower" link2="wrist" reason="Adjacent"/>
</robot>
)";

// The right finger mimics the left one.
inline constexpr const char* kGripperUrdf = R"(<robot name="gripper">
  <link name="palm"><collision><origin xyz="0.06 0 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0.03 0 0"/><geometry><sphere radius="0.015"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.03 0 0"/><geometry><sphere radius="0.015"/></geometry></collision></link>
  <joint name="finger" type="prismatic"><origin xyz="0.12 0.02 0"/><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="0.5"/></joint>
  <joint name="other" type="prismatic"><origin xyz="0.12 -0.02 0"/><parent link="palm"/><child link="right"/><axis xyz="0 1 0"/><limit lower="-0.04" upper="0" velocity="0.5"/><mimic joint="finger" multiplier="-1"/></joint>
</robot>
)";
inline constexpr const char* kGripperSrdf = R"(<robot name="gripper">
  <disable_collisions link1="palm" link2="left" reason="Adjacent"/>
  <disable_collisions link1="palm" link2="right" reason="Adjacent"/>
</robot>
)";
// Names of the cell, and of the URDF.
inline constexpr const char* kArmGripperSrdf = R"(<robot name="arm_with_gripper">
  <disable_collisions link1="wrist" link2="g_palm" reason="Adjacent"/>
  <disable_collisions link1="lower" link2="g_palm" reason="Never"/>
  <disable_collisions link1="wrist" link2="left" reason="Never"/>
  <disable_collisions link1="right" link2="wrist" reason="Never"/>
</robot>
)";

// The root has no shape.
inline constexpr const char* kTorchUrdf = R"(<robot name="torch">
  <link name="base"/>
  <link name="neck"><collision><origin xyz="0.1 0 0"/><geometry><sphere radius="0.03"/></geometry></collision></link>
  <link name="tip"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  <joint name="tilt" type="revolute"><origin xyz="0.02 0 0"/><parent link="base"/><child link="neck"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" velocity="3"/></joint>
  <joint name="end" type="fixed"><origin xyz="0.2 0 0"/><parent link="neck"/><child link="tip"/></joint>
</robot>
)";
inline constexpr const char* kTorchSrdf = R"(<robot name="torch">
  <disable_collisions link1="neck" link2="tip" reason="Adjacent"/>
</robot>
)";
inline constexpr const char* kArmTorchSrdf = R"(<robot name="arm_with_torch">
  <disable_collisions link1="wrist" link2="neck" reason="Adjacent"/>
</robot>
)";

inline constexpr const char* kToolCell = R"(name: tools
units: {length: m, angle: rad}
commands: {from: [planner]}
capacity: {pairs: 60}
objects:
  - {name: person, max_speed: 3, sphere: {radius: 0.3}}
robots:
  - {name: arm, urdf: arm.urdf, srdf: arm.srdf}
  - name: gripper
    urdf: gripper.urdf
    srdf: gripper.srdf
    prefix: g_
    srdf_with: {arm: arm_gripper.srdf}
    base: {pose: {xyz: [1.6716, 0.7833, 0]}}
    joints: {finger: {position: 0.01}}
  - name: torch
    urdf: torch.urdf
    srdf: torch.srdf
    prefix: t_
    srdf_with: {arm: arm_torch.srdf}
    base: {pose: {xyz: [1.6716, -0.7833, 0]}}
    joints: {tilt: {position: 0.2}}
pairs:
  - {between: [arm, person], publish: true}
  - {between: [gripper, person], publish: true}
  - {between: [torch, person], publish: true}
  - {between: [arm, arm], publish: true}
  - {between: [arm, gripper], publish: true}
  - {between: [arm, torch], publish: true}
  - {between: [gripper, torch], publish: true}
  - {between: [gripper, gripper], publish: true}
zones:
  - {name: stop, between: [arm, person], enter_below: 0.2, leave_above: 0.3}
)";

// Writes the files of the cell beside it.
inline void write_tools(const ScratchFolder& folder, const std::string& cell = kToolCell) {
  const std::map<std::string, std::string> texts = {{"arm.urdf", kToolArmUrdf},
                                                    {"arm.srdf", kToolArmSrdf},
                                                    {"gripper.urdf", kGripperUrdf},
                                                    {"gripper.srdf", kGripperSrdf},
                                                    {"torch.urdf", kTorchUrdf},
                                                    {"torch.srdf", kTorchSrdf},
                                                    {"arm_gripper.srdf", kArmGripperSrdf},
                                                    {"arm_torch.srdf", kArmTorchSrdf},
                                                    {"cell.yaml", cell}};
  for (const auto& [name, text] : texts) write_text(folder / name, text);
}

// Where everything is, computed by the sum of angles.
struct ToolArm {
  double shoulder = 0.0, elbow = 0.0, roll = 0.0;

  [[nodiscard]] Vec3 along(double angle, double length) const {
    return {length * std::cos(angle), length * std::sin(angle), 0.0};
  }
  [[nodiscard]] Pose flange() const {
    const double end = shoulder + elbow;
    return {along(shoulder, 1.0) + along(end, 1.05),
            Eigen::Quaterniond(Eigen::AngleAxisd(end, Vec3::UnitZ()) *
                               Eigen::AngleAxisd(roll, Vec3::UnitX()))};
  }
  // The centres of the balls of the arm.
  void add_centres(std::map<std::string, Vec3>& centres) const {
    const double end = shoulder + elbow;
    centres["foot"] = Vec3(0, 0, -0.5);
    centres["upper"] = along(shoulder, 0.5);
    centres["lower"] = along(shoulder, 1.0) + along(end, 0.5);
    centres["wrist"] = along(shoulder, 1.0) + along(end, 1.0);
  }
};

// The centres of the balls of the tools, by the pose of their root and their joint.
inline void add_gripper(const Pose& root, double finger, std::map<std::string, Vec3>& centres) {
  const auto at = [&](double x, double y) {
    return Vec3(root.position + root.orientation * Vec3(x, y, 0.0));
  };
  centres["g_palm"] = at(0.06, 0.0);
  centres["g_left"] = at(0.15, 0.02 + finger);
  centres["g_right"] = at(0.15, -0.02 - finger);
}
inline void add_torch(const Pose& root, double tilt, std::map<std::string, Vec3>& centres) {
  const auto at = [&](double length) {
    return Vec3(root.position + root.orientation * Vec3(0.02 + length * std::cos(tilt), 0.0,
                                                        -length * std::sin(tilt)));
  };
  centres["t_neck"] = at(0.1);
  centres["t_tip"] = at(0.2);
}

inline double ball_radius(const std::string& name) {
  static const std::map<std::string, double> kRadii = {
      {"person", 0.3},  {"foot", 0.1},     {"upper", 0.08},    {"lower", 0.08},  {"wrist", 0.06},
      {"g_palm", 0.05}, {"g_left", 0.015}, {"g_right", 0.015}, {"t_neck", 0.03}, {"t_tip", 0.01}};
  return kRadii.at(name);
}

}  // namespace clearance::test
