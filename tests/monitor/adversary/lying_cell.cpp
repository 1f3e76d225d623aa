#include "tests/monitor/adversary/lying_cell.hpp"

#include <fmt/format.h>

#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test::lies {
namespace {

// Reach of the arm: 2.1 m from its shoulder.
const std::string kBallRobot = R"(<robot name="balls">
  <link name="foot"><collision><geometry><sphere radius="0.12"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.4 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.3 0 0"/><geometry><sphere radius="0.09"/></geometry></collision></link>
  <link name="wrist"><collision><origin xyz="0.1 0.15 0"/><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="tip"><collision><origin xyz="0.1 0.1 0"/><geometry><sphere radius="0.06"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><origin xyz="0 0 0.4"/><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" velocity="1.5"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0.7 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1.5"/></joint>
  <joint name="spin" type="continuous"><origin xyz="0.6 0 0"/><parent link="lower"/><child link="wrist"/><axis xyz="1 0 0"/><limit velocity="2"/></joint>
  <joint name="push" type="prismatic"><origin xyz="0.2 0 0"/><parent link="wrist"/><child link="tip"/><axis xyz="1 0 0"/><limit lower="0" upper="0.4" velocity="0.5"/></joint>
</robot>
)";

std::string key(const char* name, const std::string& value) {
  return *name == '\0' ? "" : std::string(", ") + name + ": " + value;
}

std::string at(const std::array<double, 3>& place) {
  return fmt::format("xyz: [{}, {}, {}]", place[0], place[1], place[2]);
}

std::string cell_text_of_lies() {
  const std::string frozen = key(kJointFrozenKey, std::to_string(kFrozenLimit / kMs));
  const std::string ball =
      ", groups: [balls], frozen_limit_ms: 100, sphere: {radius: 0.1, centre: [0.15, 0, 0]}}\n";
  return "name: lies\nunits: {length: m, angle: rad}\nbudget: 4000\n"
         "ros2: {world_frame: map}\n"
         "defaults: {age_limit_ms: 20, max_speed: 2}\n"
         "robots:\n"
         "  - {name: arm, urdf: balls.urdf, prefix: arm_, joint_states: /arm/joint_states, base: "
         "{frame: base_link, age_limit_ms: 40" +
         key(kBaseSpeedKey, std::to_string(kBaseSpeed)) + "}" + frozen +
         "}\n"
         "  - {name: post, urdf: balls.urdf, prefix: post_, joint_states: /post/joint_states, "
         "base: {pose: {xyz: [2.6, 0.4, 0]}}" +
         frozen +
         "}\n"
         "objects:\n  - {name: ball0" +
         ball + "  - {name: ball1" + ball + "  - {name: ball2" + ball +
         "  - {name: follower, frame: follower_link" + ball +
         "  - {name: rock, fixed: true, pose: {xyz: [1.0, 1.3, 0.3]}, sphere: {radius: 0.2}}\n"
         "  - {name: part, fixed: true, pose: {" +
         at(kPartPlace) +
         "}, sphere: {radius: 0.05}}\n"
         "sensors:\n"
         "  - {name: eye, points: /eye/points, most_points: 4, depth_along: ray, depth_error: "
         "{constant: 0.002}, range: [0.1, 8], most_shell: 0.02, age_limit_ms: 100, max_speed: "
         "0.001, mount: {frame: "
         "eye_link, max_speed: 1, max_turn_speed: 1}}\n"
         "  - {name: lens, depth_image: /lens/image, size: [16, 12], depth_error: {constant: "
         "0.01}, "
         "range: [0.3, 8], most_shell: 0.02, age_limit_ms: 100, max_speed: 0.6, mount: {pose: {" +
         at(kLensPlace) +
         ", rpy: [3.141592653589793, 0, 0]}}}\n"
         "  - {name: map, octomap: /map, range: 12, most_points: 8, most_shell: 0.02, "
         "age_limit_ms: "
         "250, max_speed: 0.6, mount: {pose: {" +
         at(kMapPlace) +
         "}}}\n"
         "pairs:\n"
         "  - between: [arm, eye]\n  - between: [post, eye]\n  - between: [balls, eye]\n"
         "  - between: [arm, balls]\n  - between: [post, balls]\n  - between: [balls, balls]\n"
         "  - between: [balls, rock]\n  - between: [arm, post]\n  - between: [arm, rock]\n"
         "  - between: [arm, arm]\n  - between: [arm, lens]\n  - between: [balls, lens]\n"
         "  - between: [arm, map]\n  - between: [balls, map]\n  - between: [balls, part]\n"
         "  - between: [post, part]\n"
         "zones:\n"
         "  - {name: people, between: [ball0, arm], enter_below: 0.5, leave_above: 0.6, "
         "separation: "
         "{human: ball0, human_speed_measured: true, human_acceleration: 3, reaction_time_ms: 40, "
         "stopping_time_ms: 250, stopping_distance: 0.125, stopping_speed: 1, intrusion_distance: "
         "0.1}}\n"
         "  - {name: arm, between: [arm, balls], enter_below: 0.3, leave_above: 0.35}\n"
         "  - {name: post, between: [post, balls], enter_below: 0.3, leave_above: 0.35}\n"
         "  - {name: robots, between: [arm, post], enter_below: 0.4, leave_above: 0.45}\n"
         "  - {name: rock, between: [balls, rock], enter_below: 0.3, leave_above: 0.35}\n"
         "  - {name: balls, between: [balls, balls], enter_below: 0.4, leave_above: 0.45}\n"
         "  - {name: seen, between: [arm, eye], enter_below: 1.2, leave_above: 1.25}\n"
         "  - {name: near, between: [balls, eye], enter_below: 1.2, leave_above: 1.25}\n"
         "  - {name: plate, between: [balls, lens], enter_below: 2, leave_above: 2.05}\n"
         "  - {name: walker, between: [balls, map], enter_below: 1.5, leave_above: 1.55}\n"
         "  - {name: part, between: [balls, part], enter_below: 0.8, leave_above: 0.85}\n";
}

}  // namespace

const char* name(Channel channel) {
  constexpr std::array kNames{"ball0",   "ball1", "ball2",    "arm",    "post",
                              "odom",    "base",  "follower", "eye",    "points",
                              "picture", "map",   "commands", "partner"};
  return kNames[static_cast<std::size_t>(channel)];
}

const char* body_name(std::size_t body) {
  constexpr std::array<const char*, kBodies> kNames{
      "ball0",     "ball1",     "ball2",   "follower",  "rock",       "arm_foot",   "arm_upper",
      "arm_lower", "arm_wrist", "arm_tip", "post_foot", "post_upper", "post_lower", "post_wrist",
      "post_tip",  "eye",       "lens",    "map",       "part"};
  return kNames[body];
}

Cell lying_cell() {
  static const ScratchFolder folder;
  write_text(folder / "balls.urdf", kBallRobot);
  return read_good(cell_text_of_lies(), folder / "cell.yaml");
}

}  // namespace clearance::test::lies
