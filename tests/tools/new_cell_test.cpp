// clearance-scene new: each cell that it writes is read by the cell's reader, and ticked with its
// joints at zero.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

// A post with an arm that lies flat and reaches below its base; the hand's ball is in the arm, and
// no SRDF of the tests disables that pair.
const std::string kFlatUrdf = R"(<robot name="flat">
  <link name="post"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="turret"><collision><geometry><cylinder radius="0.09" length="0.02"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.3"/></geometry></collision></link>
  <link name="wrist"><collision><geometry><sphere radius="0.04"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="-0.2 0 0"/><geometry><sphere radius="0.04"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="post"/><child link="turret"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1.5"/></joint>
  <joint name="lift" type="revolute"><origin xyz="0.2 0 0"/><parent link="turret"/><child link="arm"/><axis xyz="0 1 0"/><limit lower="-1.25" upper="1" velocity="2"/></joint>
  <joint name="bend" type="continuous"><origin xyz="1.1 0 0"/><parent link="arm"/><child link="wrist"/><axis xyz="0 1 0"/></joint>
  <joint name="push" type="prismatic"><origin xyz="-0.1 0 0"/><parent link="wrist"/><child link="hand"/><axis xyz="1 0 0"/><limit lower="0" upper="0.5" velocity="0.1"/></joint>
</robot>
)";
const std::string kFlatSrdf = R"(<robot name="flat">
  <disable_collisions link1="post" link2="turret" reason="Adjacent"/>
  <disable_collisions link1="turret" link2="arm" reason="Adjacent"/>
  <disable_collisions link1="arm" link2="wrist" reason="Adjacent"/>
  <disable_collisions link1="wrist" link2="hand" reason="Adjacent"/>
</robot>
)";

class NewCell : public testing::Test {
 protected:
  NewCell() {
    test::write_text(folder_ / "flat.urdf", kFlatUrdf);
    test::write_text(folder_ / "flat.srdf", kFlatSrdf);
    std::filesystem::create_directory(folder_ / "cells");
    const std::string shipped = test::places::sources() + "/config/cells/seven_joint_arm/arm";
    std::filesystem::copy(shipped + ".urdf", folder_ / "arm.urdf");
    std::filesystem::copy(shipped + ".srdf", folder_ / "arm.srdf");
    std::filesystem::copy(shipped + ".urdf", folder_ / "alone.urdf");
    std::filesystem::create_directory(folder_ / "bare");
    std::filesystem::rename(folder_ / "alone.urdf", folder_ / "bare/alone.urdf");
  }

  int run(std::vector<std::string> words, const std::string& path = "") {
    words.insert(words.begin(), "new");
    const std::string all = path.empty() ? std::getenv("PATH") : path;
    test::ChildProcess program(test::places::programs() + "/clearance-scene", std::move(words),
                               {.environment = {{"PATH", all}}});
    const int status = program.wait();
    output_ = program.output();
    return status;
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::string written() const { return test::read_text(folder_ / "cells/cell.yaml"); }

  // Writes the cell, and expects that it is read without a mistake and that nothing touches in it.
  void expect_a_good_start(const std::string& robots, const std::string& bodies) {
    SCOPED_TRACE(robots + " on " + bodies);
    std::vector<std::string> words = {"--robots", robots, "-o", file("cells/cell.yaml"), "--force"};
    if (!bodies.empty()) words.insert(words.end(), {"--on", bodies});
    ASSERT_EQ(run(words), 0) << output_;
    const Cell cell = read_good(written(), folder_ / "cells/cell.yaml");
    const Scene& scene = cell.scene;
    const std::int64_t now = 1'000'000'000;
    std::vector<JointSample> joints;
    for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
      JointSample& joint = joints.emplace_back();
      joint.variable = i;
      joint.position = std::clamp(0.0, scene.variables[i].lower, scene.variables[i].upper);
      joint.stamp_ns = now;
    }
    std::vector<PoseSample> poses;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].name != "person") continue;
      PoseSample& pose = poses.emplace_back();
      pose.object = i;
      pose.stamp_ns = now;
      pose.world_from_object = cell.simulation.movers.at(0).centre;
    }
    EXPECT_EQ(poses.size(), bodies.find("person") == std::string::npos ? 0u : 1u);
    expect_the_machine_out_of_reach(scene, joints);
    Monitor monitor(scene);
    TickTime time;
    time.now_ns = now;
    const Report& report = monitor.tick(poses, joints, time);
    if (bodies.find("camera") == std::string::npos) {
      EXPECT_GT(report.lower_all, 0.0) << written();
      return;
    }
    // What the camera sees is not known without a picture.
    for (const PairReport& pair : report.pairs) {
      const ObjectPair& of = scene.pairs[pair.pair];
      if (scene.objects[of.first].is_seen() || scene.objects[of.second].is_seen()) continue;
      EXPECT_GT(pair.lower, 0.0) << written();
    }
    EXPECT_EQ(scene.sensors.size(), 1u);
  }

  // In the middle of all ranges, and in drawn positions, nothing is near machine and door.
  static void expect_the_machine_out_of_reach(const Scene& scene, std::vector<JointSample> joints) {
    Random random(13);
    for (std::uint64_t i = 0; i < repeats(50); ++i) {
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const JointVariable& limits = scene.variables[j];
        const bool is_limited = std::isfinite(limits.lower) && std::isfinite(limits.upper);
        const double share = i == 0 ? 0.5 : random.uniform(0.0, 1.0);
        joints[j].position =
            is_limited ? limits.lower + share * (limits.upper - limits.lower) : 6.0 * (share - 0.5);
      }
      Monitor monitor(scene);
      TickTime time;
      time.now_ns = joints.empty() ? 1 : joints[0].stamp_ns;
      monitor.tick({}, joints, time);
      for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
        for (const std::uint32_t object : {scene.pairs[p].first, scene.pairs[p].second}) {
          const std::string& name = scene.objects[object].name;
          if (name == "machine" || name == "door") {
            EXPECT_GT(monitor.pair_at_least(p, 0.1).lower, 0.1) << i;
          }
        }
      }
    }
  }

  test::ScratchFolder folder_;
  std::string output_;
};

// Two choices of bodies for each robot, in turn, and all of them in tools/check --all.
TEST_F(NewCell, IsReadAndNothingTouchesInItForEachRobotWithEachChoiceOfBodies) {
  std::uint64_t robot = 0;
  for (const std::string& robots :
       {file("arm.urdf"), file("flat.urdf"), file("bare/alone.urdf"),
        file("arm.urdf") + "," + file("arm.urdf"), file("flat.urdf") + "," + file("arm.urdf")}) {
    ++robot;
    for (std::uint64_t i = 0; i < repeats(8); ++i) {
      const std::uint64_t choice = (2 * robot + 5 * i) % 8;
      std::string bodies;
      for (std::uint64_t of = 0; of < 3; ++of) {
        if (((choice >> of) & 1) == 0) continue;
        bodies += (bodies.empty() ? "" : ",") +
                  std::vector<std::string>{"table", "machine", "person,camera"}[of];
      }
      expect_a_good_start(robots, bodies);
    }
  }
  expect_a_good_start(file("arm.urdf"), "camera");
}

TEST_F(NewCell, GivesRobotsOfOneFileNamesPrefixesAndPlacesOfTheirOwn) {
  const std::string arm = file("arm.urdf");
  ASSERT_EQ(run({"--robots", arm + "," + arm, "-o", file("cells/cell.yaml")}), 0) << output_;
  const Scene scene = scene_of(written(), folder_ / "cells/cell.yaml");
  ASSERT_EQ(scene.robots.size(), 2u);
  EXPECT_EQ(scene.robots[0].prefix, scene.robots[0].name + "_");
  EXPECT_NE(scene.robots[0].name, scene.robots[1].name);
  EXPECT_GE(
      (scene.robots[0].base.base_from_root.position - scene.robots[1].base.base_from_root.position)
          .norm(),
      0.6);
  EXPECT_THAT(output_, HasSubstr("clearanced --check "));
}

TEST_F(NewCell, TakesAllowedPairsFromTheSrdfBesideTheUrdfOrProposesOne) {
  ASSERT_EQ(run({"--robots", file("arm.urdf"), "-o", file("cells/cell.yaml")}), 0) << output_;
  EXPECT_THAT(written(), HasSubstr("srdf: \"../arm.srdf\""));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cells/arm.srdf"));
  ASSERT_EQ(run({"--robots", file("bare/alone.urdf"), "-o", file("cells/alone.yaml")}), 0)
      << output_;
  EXPECT_THAT(test::read_text(folder_ / "cells/alone.yaml"), HasSubstr("srdf: \"alone.srdf\""));
  EXPECT_THAT(test::read_text(folder_ / "cells/alone.srdf"), HasSubstr("reason=\"Adjacent\""));
  ASSERT_EQ(run({"--robots", file("bare/alone.urdf") + "," + file("arm.srdf"), "-o",
                 file("cells/named.yaml")}),
            0)
      << output_;
  EXPECT_THAT(test::read_text(folder_ / "cells/named.yaml"), HasSubstr("srdf: \"../arm.srdf\""));
}

TEST_F(NewCell, SaysWhatTheUrdfSaysOfJointsAndWhichPairsTouchUnlikeInTheSrdf) {
  ASSERT_EQ(run({"--robots", file("flat.urdf"), "--on", "table", "-o", file("cells/cell.yaml")}), 0)
      << output_;
  EXPECT_THAT(written(), HasSubstr("#   \"lift\": {velocity: 2, limits: [-1.25, 1]}"));
  EXPECT_THAT(written(), HasSubstr("#   \"bend\": {}  # no velocity"));
  EXPECT_THAT(written(), HasSubstr("between: [\"arm\", \"hand\"], reason: \"touches at zero"));
  EXPECT_THAT(written(), HasSubstr("between: [\"turret\", \"table\"]"));
  // The arm reaches 0.15 m below the base.
  const Scene scene = scene_of(written(), folder_ / "cells/cell.yaml");
  EXPECT_NEAR(scene.robots[0].base.base_from_root.position.z(), 0.75 + 0.15 + 0.05, 0.002);
}

TEST_F(NewCell, OverwritesNothingUnasked) {
  test::write_text(folder_ / "cells/cell.yaml", "precious");
  EXPECT_EQ(run({"--robots", file("arm.urdf"), "-o", file("cells/cell.yaml")}), 1);
  EXPECT_THAT(output_, HasSubstr("exists; --force overwrites it"));
  EXPECT_EQ(written(), "precious");
  EXPECT_EQ(run({"--robots", file("arm.urdf"), "-o", file("arm.urdf"), "--force"}), 2);
}

TEST_F(NewCell, WritesNoCellOfARobotThatCannotBeRead) {
  test::write_text(folder_ / "broken.urdf", "<robot name='r'>\n<link/></robot>");
  EXPECT_EQ(run({"--robots", file("arm.urdf") + "," + file("broken.urdf"), "-o",
                 file("cells/cell.yaml")}),
            3);
  EXPECT_THAT(output_, HasSubstr("broken.urdf:2:1: found"));
  std::string urdf = kFlatUrdf;
  urdf.replace(urdf.find("<sphere radius=\"0.04\"/>"), 23,
               "<mesh filename=\"package://no_such_package/a.stl\"/>");
  test::write_text(folder_ / "packaged.urdf", urdf);
  EXPECT_EQ(run({"--robots", file("packaged.urdf"), "-o", file("cells/cell.yaml")}), 3);
  EXPECT_THAT(output_, HasSubstr("no directory for the package 'no_such_package'"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cells/cell.yaml"));
  EXPECT_EQ(run({"--robots", file("arm.urdf"), "--on", "tabel"}), 2);
  EXPECT_EQ(run({"--robots", file("arm.urdf"), "--xacro", "a:=b"}), 2);
  EXPECT_EQ(run({"--robots", ","}), 2);
}

// A program in the place of xacro that shows how it is called. It can fail, too.
class NewCellOfXacro : public NewCell {
 protected:
  void place_xacro(const std::string& script) {
    std::filesystem::create_directory(folder_ / "bin");
    test::write_text(folder_ / "bin/xacro", "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder_ / "bin/xacro", std::filesystem::perms::owner_all);
    test::write_text(folder_ / "flat.urdf.xacro", kFlatUrdf);
  }
  int run_xacro(const std::string& path) {
    return run({"--robots", file("flat.urdf.xacro"), "--xacro", "a:=1; touch " + file("hacked"),
                "--xacro", "b:=$HOME", "-o", file("cells/cell.yaml")},
               path);
  }
};

TEST_F(NewCellOfXacro, ExpandsItByTheProgramWithoutAShell) {
  place_xacro("printf '%s\\n' \"$@\" > \"$(dirname \"$0\")/called\"; cp \"$3\" \"$2\"");
  ASSERT_EQ(run_xacro(file("bin") + ":" + std::getenv("PATH")), 0) << output_;
  const std::string called = test::read_text(folder_ / "bin/called");
  EXPECT_EQ(called, "-o\n" + file("cells/flat.urdf.part") + "\n" + file("flat.urdf.xacro") +
                        "\na:=1; touch " + file("hacked") + "\nb:=$HOME\n");
  EXPECT_FALSE(std::filesystem::exists(file("hacked")));
  EXPECT_EQ(test::read_text(folder_ / "cells/flat.urdf"), kFlatUrdf);
  EXPECT_THAT(written(), HasSubstr("urdf: \"flat.urdf\""));
  EXPECT_THAT(written(), HasSubstr("srdf: \"../flat.srdf\""));
}

TEST_F(NewCellOfXacro, ShowsTheErrorsOfTheProgramAndKeepsNothing) {
  place_xacro("echo half > \"$2\"; echo 'undefined argument c' >&2; exit 2");
  EXPECT_EQ(run_xacro(file("bin") + ":" + std::getenv("PATH")), 1);
  EXPECT_THAT(output_, HasSubstr("xacro ended with status 2: undefined argument c"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "cells"));
}

TEST_F(NewCellOfXacro, SaysHowToInstallTheProgram) {
  place_xacro("");
  std::filesystem::create_directory(folder_ / "nothing");
  EXPECT_EQ(run_xacro(file("nothing")), 1);
  EXPECT_THAT(output_, HasSubstr("found no program 'xacro' in PATH"));
  EXPECT_THAT(output_, HasSubstr("pip install xacro"));
  EXPECT_THAT(output_, Not(HasSubstr("cell.yaml:")));
}

TEST_F(NewCellOfXacro, FindsPackagesFromTheXacroFileOn) {
  place_xacro("cp \"$3\" \"$2\"");
  std::filesystem::create_directories(folder_ / "ws/things/meshes");
  std::filesystem::create_directories(folder_ / "ws/things/urdf");
  test::write_text(
      folder_ / "ws/things/meshes/a.obj",
      "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  std::string urdf = kFlatUrdf;
  urdf.replace(urdf.find("<sphere radius=\"0.04\"/>"), 23,
               "<mesh filename=\"package://things/meshes/a.obj\"/>");
  test::write_text(folder_ / "ws/things/urdf/thing.xacro", urdf);
  EXPECT_EQ(run({"--robots", file("ws/things/urdf/thing.xacro"), "-o", file("cells/cell.yaml")},
                file("bin") + ":" + std::getenv("PATH")),
            0)
      << output_;
  EXPECT_THAT(written(), HasSubstr("\"things\": \"../ws/things"));
}

}  // namespace
}  // namespace clearance
