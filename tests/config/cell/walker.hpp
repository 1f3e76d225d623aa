// A robot with every type of joint, and cells with it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {

// Every type of joint, with the leaf written first, because the order of a file has no meaning.
inline const std::string kWalkerUrdf = R"(<robot name="walker">
  <link name="foot"><collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="mast"><collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision>
                    <collision><geometry><mesh filename="package://walker_description/tip.obj" scale="0.001 0.001 0.001"/></geometry></collision></link>
  <link name="left"/> <link name="right"/> <link name="puck"/> <link name="ball"/>
  <joint name="slide" type="prismatic"><origin xyz="1 0 0"/><parent link="arm"/><child link="hand"/><axis xyz="3 0 0"/><limit lower="0" upper="0.3" velocity="0.5"/></joint>
  <joint name="bolt" type="fixed"><origin xyz="0 0 0.05" rpy="0 0 1.5707963267948966"/><parent link="foot"/><child link="mast"/></joint>
  <joint name="hip" type="revolute"><origin xyz="0 0 1"/><parent link="mast"/><child link="arm"/><axis xyz="0 0 -2"/><limit lower="-1" upper="2" velocity="1.5"/></joint>
  <joint name="grip" type="continuous"><parent link="hand"/><child link="left"/><limit velocity="3"/></joint>
  <joint name="grip2" type="revolute"><parent link="hand"/><child link="right"/><limit lower="-1" upper="1" velocity="1"/><mimic joint="grip" multiplier="-2" offset="0.25"/></joint>
  <joint name="table" type="planar"><parent link="hand"/><child link="puck"/><axis xyz="1 0 0"/></joint>
  <joint name="free" type="floating"><parent link="hand"/><child link="ball"/></joint>
</robot>
)";

inline const std::string kWalkerSrdf = R"(<robot name="walker">
  <disable_collisions link1="arm" link2="mast" reason="Adjacent"/>
  <disable_collisions link1="foot" link2="mast" reason="Adjacent"/>
</robot>
)";

class Robots : public testing::Test {
 protected:
  Robots() {
    std::filesystem::create_directories(folder_ / "walker_description");
    test::write_text(folder_ / "walker_description/walker.urdf", kWalkerUrdf);
    test::write_text(folder_ / "walker_description/walker.srdf", kWalkerSrdf);
    test::write_text(
        folder_ / "walker_description/tip.obj",
        "v 0 0 0\nv 200 0 0\nv 0 200 0\nv 0 0 200\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  }

  // A cell with these robots and objects, in which all pairs are watched.
  static std::string cell(const std::string& robots, const std::string& rest) {
    return "name: test\nunits: {length: m, angle: deg}\nrobots:\n" + robots + rest;
  }
  Scene scene(const std::string& robots, const std::string& rest) {
    return scene_of(cell(robots, rest), folder_ / "cell.yaml");
  }
  std::string errors(const std::string& robots, const std::string& rest) {
    return errors_of(cell(robots, rest), folder_ / "cell.yaml");
  }

  test::ScratchFolder folder_;
};

inline const std::string kWalker =
    "  - {name: walker, urdf: walker_description/walker.urdf, srdf: "
    "walker_description/walker.srdf}\n";
inline const std::string kSelf = "pairs: [{between: [walker, walker]}]\n";

inline bool watched(const Scene& scene, const std::string& a, const std::string& b) {
  return std::ranges::any_of(scene.pairs, [&](const ObjectPair& pair) {
    const std::string &first = scene.objects[pair.first].name,
                      &second = scene.objects[pair.second].name;
    return (first == a && second == b) || (first == b && second == a);
  });
}

}  // namespace clearance
