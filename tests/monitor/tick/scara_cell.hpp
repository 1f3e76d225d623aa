// A cell with a robot of three joints, and its joint states.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "monitor/inputs/joint_batch.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

// Two links of one metre that swing about z, and a finger that slides out of the second.
inline const std::string kScaraUrdf = R"(<robot name="scara">
  <link name="foot"><collision><origin xyz="0 0 -1"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="finger"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2"/></joint>
  <joint name="elbow" type="continuous"><origin xyz="1 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/></joint>
  <joint name="push" type="prismatic"><origin xyz="1 0 0"/><parent link="lower"/><child link="finger"/><axis xyz="1 0 0"/><limit lower="0" upper="0.2" velocity="0.5"/></joint>
</robot>
)";

// Objects: wall, cart, foot, upper, lower, finger.
inline const std::string kScaraRest =
    "objects:\n"
    "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
    "  - {name: cart, may_jump: true, sphere: {radius: 0.1}}\n"
    "pairs:\n"
    "  - between: [arm, wall]\n"
    "  - between: [cart, wall]\n"
    "  - between: [arm, arm]\n"
    "zones:\n"
    "  - {name: near, between: [upper, wall], enter_below: 3.5, leave_above: 3.6}\n";

// The robots left and right, with topics and stamps of their own.
inline Cell two_scara_arms() {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  return read_good(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: left, urdf: scara.urdf, prefix: left_, joint_states: /left/joint_states}\n"
      "  - {name: right, urdf: scara.urdf, prefix: right_, base: {pose: {xyz: [9, 0, 0]}}, "
      "stamps: sent}\n"
      "pairs: [{between: [left, right]}]\n",
      folder / "cell.yaml");
}

// Two arms with joints on one topic of ROS 2, which state their stops on /left/stopping and
// /right/stopping. Positions older than 20 ms are late.
inline Cell two_stopping_arms() {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const auto arm = [](const std::string& name, const std::string& rest) {
    return "  - {name: " + name + ", urdf: scara.urdf, prefix: " + name +
           "_, age_limit_ms: 20, stopping: {reaction_ms: 40, time_ms: 200, stated_on: /" + name +
           "/stopping}" + rest + "}\n";
  };
  return read_good("name: test\nunits: {length: m, angle: rad}\nrobots:\n" + arm("left", "") +
                       arm("right", ", base: {pose: {xyz: [9, 0, 0]}}") +
                       "pairs: [{between: [left, right]}]\n",
                   folder / "cell.yaml");
}

// `base` contains further keys of the robot.
inline Scene scara_cell(const std::string& base = "") {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: "
      "scara.urdf" +
          base + "}]\n" + kScaraRest,
      folder / "cell.yaml");
}

inline JointSample joint(std::uint32_t variable, double position, std::int64_t stamp_ns) {
  JointSample sample;
  sample.variable = variable;
  sample.position = position;
  sample.stamp_ns = stamp_ns;
  return sample;
}

inline std::array<JointSample, 3> joints(double shoulder, double elbow, double push,
                                         std::int64_t now) {
  return {joint(0, shoulder, now), joint(1, elbow, now), joint(2, push, now)};
}

}  // namespace clearance::test
