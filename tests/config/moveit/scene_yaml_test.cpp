// Planning scenes as YAML, as ROS 2 prints them.
//
// Oracle: the same scene in MoveIt's text format, which another reader reads.
#include "config/moveit/scene_yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;

const std::string kText = R"(kitchen
* table top
1 2 0.5
0 0 0.6 0.8
2
box
2 1 0.1
0 0 -0.05
0 0 0 1
0 0 0 0
cylinder
0.05 0.5
0.9 0 -0.35
0 0 0 1
0.5 0.5 0.5 1
0
* rock
0 0 2
0 0 0 1
1
mesh
4 4
0 0 0
1 0 0
0 1 0
0 0 1
0 1 2
0 1 3
0 2 3
1 2 3
0 0 1
0 0 0 1
0 0 0 0
0
* ground
0 0 0
0 0 0 1
1
plane
0 0 1 0.25
0 0 0
0 0 0 1
0 0 0 0
0
.
)";

const std::string kHeader = "header: {stamp: {sec: 0, nanosec: 0}, frame_id: world}";
const std::string kYaml = R"(name: kitchen
robot_state:
  joint_state:
    header: {stamp: {sec: 1, nanosec: 2}, frame_id: world}
    name: [a]
    position: [0.5]
    velocity: []
    effort: []
  attached_collision_objects: []
  is_diff: false
robot_model_name: panda
fixed_frame_transforms:
- header: {stamp: {sec: 0, nanosec: 0}, frame_id: world}
  child_frame_id: world
  transform:
    translation: {x: 0.0, y: 0.0, z: 0.0}
    rotation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
world:
  collision_objects:
  - )" + kHeader + R"(
    pose:
      position: {x: 1.0, y: 2.0, z: 0.5}
      orientation: {x: 0.0, y: 0.0, z: 0.6, w: 0.8}
    id: table top
    type: {key: '', db: ''}
    primitives:
    - type: 1
      dimensions: [2.0, 1.0, 0.1]
      polygon: {points: []}
    - type: 3
      dimensions: [0.5, 0.05]
      polygon: {points: []}
    primitive_poses:
    - position: {x: 0.0, y: 0.0, z: -0.05}
      orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
    - position: {x: 0.9, y: 0.0, z: -0.35}
      orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
    meshes: []
    operation: "\0"
  - )" + kHeader + R"(
    pose:
      position: {x: 0.0, y: 0.0, z: 2.0}
      orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}
    id: rock
    meshes:
    - triangles:
      - vertex_indices: [0, 1, 2]
      - vertex_indices: [0, 1, 3]
      - vertex_indices: [0, 2, 3]
      - vertex_indices: [1, 2, 3]
      vertices: [{x: 0.0, y: 0.0, z: 0.0}, {x: 1.0, y: 0.0, z: 0.0}, {x: 0.0, y: 1.0, z: 0.0}, {x: 0.0, y: 0.0, z: 1.0}]
    mesh_poses:
    - position: {x: 0.0, y: 0.0, z: 1.0}
    operation: 0
  - )" + kHeader + R"(
    id: ground
    planes:
    - coef: [0.0, 0.0, 1.0, 0.25]
    plane_poses: []
  octomap:
    octomap: {binary: false, id: '', resolution: 0.0, data: []}
is_diff: false
---
)";

class YamlScenes : public testing::Test {
 protected:
  [[nodiscard]] std::string cell(const std::string& file) const {
    return "name: test\nunits: {length: mm, angle: deg}\nscenes: [{file: " + file +
           ", group: kitchen, pose: {xyz: [0, 0, 100]}}]\n"
           "objects: [{name: hand, sphere: {radius: 50}}]\n"
           "pairs: [{between: [hand, kitchen]}]\n";
  }
  Scene read(const std::string& file, const std::string& text) {
    test::write_text(folder_ / file, text);
    return scene_of(cell(file), folder_ / "cell.yaml");
  }
  std::string mistakes(std::string from, const std::string& to) {
    std::string text = kYaml;
    text.replace(text.find(from), from.size(), to);
    test::write_text(folder_ / "kitchen.yaml", text);
    return errors_of(cell("kitchen.yaml"), folder_ / "cell.yaml");
  }
  const test::ScratchFolder folder_;
};

TEST_F(YamlScenes, HaveTheObjectsOfTheSameSceneAsText) {
  const Scene text = read("kitchen.scene", kText), yaml = read("kitchen.yaml", kYaml);
  ASSERT_EQ(yaml.objects.size(), 4u);
  ASSERT_EQ(text.objects.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Object &a = text.objects[i], &b = yaml.objects[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.fixed, b.fixed);
    EXPECT_EQ(a.groups, b.groups);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t p = 0; p < a.parts.size(); ++p) {
      const Pose in_a = compose(a.world_from_object, a.parts[p].object_from_part);
      const Pose in_b = compose(b.world_from_object, b.parts[p].object_from_part);
      EXPECT_LT((in_a.position - in_b.position).norm(), 1e-12) << a.name;
      EXPECT_LT(in_a.orientation.angularDistance(in_b.orientation), 1e-12) << a.name;
      EXPECT_EQ(a.parts[p].shape.anchors.size(), b.parts[p].shape.anchors.size());
      EXPECT_NEAR(a.parts[p].shape.radius, b.parts[p].shape.radius, 1e-15);
      EXPECT_EQ(a.parts[p].shape.is_half_space(), b.parts[p].shape.is_half_space());
    }
  }
  EXPECT_EQ(text.pairs.size(), yaml.pairs.size());
}

// A field of another name would leave the default of the message in its place.
TEST_F(YamlScenes, AreRefusedForAFieldThatIsNotRead) {
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& place,
                           const std::string& word) {
    EXPECT_THAT(mistakes(from, to), mistake_at(":3:17", "kitchen.yaml:" + place, word)) << to;
  };
  refused("primitive_poses:", "primitives_poses:", "", "'primitive_poses'");
  refused("pose:\n", "poses:\n", "21:5:", "'pose'");
  refused("{x: 1.0, y: 2.0, z: 0.5}", "{x: 1.0, y: 2.0, Z: 0.5}", "22:34:", "'Z'");
  refused("z: 0.5}", "x: 0.5}", "22:34:", "again");
  refused("data: []", "data: [1, 2]", "", "octomap");
  refused("is_diff: false\n---", "link_padding: [{link_name: a, padding: 0.02}]\n---", "", "0.02");
  refused("is_diff: false\n---", "link_scale: [{link_name: a, scale: 1.1}]\n---", "", "1.1");
  refused("is_diff: false\n---\n", "is_diff: false\n---\nname: second\n---\n", "", "second");
  EXPECT_EQ(mistakes("is_diff: false\n---", "link_scale: [{link_name: a, scale: 1.0}]\n---"), "");
}

TEST_F(YamlScenes, AreRefusedByFieldAndLine) {
  EXPECT_THAT(mistakes("world:\n", "worlds:\n"),
              mistake_at(":3:17", "kitchen.yaml:18:1:", "'world'"));
  EXPECT_THAT(mistakes("type: 1\n", "type: box\n"), mistake_at(":3:17", "kitchen.yaml:", "'box'"));
  EXPECT_THAT(mistakes("type: 1\n", "type: 7\n"),
              mistake_at(":3:17", "world.collision_objects[0].primitives[0].type", "7"));
  EXPECT_THAT(mistakes("[0.5, 0.05]", "[0.5]"),
              mistake_at(":3:17", "world.collision_objects[0].primitives[1].dimensions"));
  EXPECT_THAT(mistakes("operation: \"\\0\"", "operation: 1"),
              mistake_at(":3:17", "world.collision_objects[0].operation"));
  EXPECT_THAT(
      mistakes("attached_collision_objects: []",
               "attached_collision_objects: [{link_name: hand, object: {id: tool}}]"),
      mistake_at(":3:17", "attached_collision_objects[0].object.header.frame_id", "'hand'"));
  EXPECT_THAT(mistakes("robot_model_name:",
                       "allowed_collision_matrix: {entry_names: [hand]}\nrobot_model_name:"),
              mistake_at(":3:17", "allowed_collision_matrix.entry_values"));
  EXPECT_THAT(mistakes("vertex_indices: [1, 2, 3]", "vertex_indices: [1, 2, 4]"),
              mistake_at(":3:17", "meshes[0].triangles[3]"));
  EXPECT_THAT(mistakes("frame_id: world}\n    id: ground", "frame_id: moon}\n    id: ground"),
              mistake_at(":3:17", "world.collision_objects[2].header.frame_id", "'moon'"));
  EXPECT_THAT(mistakes("is_diff: false\nrobot", "is_diff: [\nrobot"), mistake_at(":3:17"));
}

TEST_F(YamlScenes, HaveObjectsInFramesThatTheyPlaceInOneFrame) {
  std::string text = kYaml;
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("frame_id: world}\n    id: ground", "frame_id: bench}\n    id: ground");
  replace("fixed_frame_transforms:\n",
          "fixed_frame_transforms:\n- header: {frame_id: bench}\n  child_frame_id: world\n"
          "  transform: {translation: {x: 3.0}, rotation: {w: 1.0}}\n");
  const Scene scene = read("kitchen.yaml", text);
  const auto ground = std::ranges::find(scene.objects, "ground", &Object::name);
  ASSERT_NE(ground, scene.objects.end());
  EXPECT_EQ(ground->world_from_object.position, Vec3(3, 0, 0.1));
  replace("child_frame_id: world", "child_frame_id: shelf");
  test::write_text(folder_ / "kitchen.yaml", text);
  EXPECT_THAT(errors_of(cell("kitchen.yaml"), folder_ / "cell.yaml"),
              mistake_at(":3:17", "world.collision_objects[2].header.frame_id", "'shelf'"));
}

// The hand is an object here; links carry likewise. The unit of the cell is mm.
TEST_F(YamlScenes, HaveWhatIsAttachedAndThePairsThatTheMatrixAllows) {
  std::string text = kYaml;
  text.replace(text.find("[]\n  is_diff"), 2,
               "[{link_name: hand, weight: 2.5, touch_links: [rock], object: {header: {frame_id: "
               "hand}, id: tool, "
               "pose: {position: {z: 0.2}, orientation: {w: 1.0}}, "
               "primitives: [{type: 2, dimensions: [0.05]}]}}]");
  text.replace(text.find("robot_model_name:"), 0,
               "allowed_collision_matrix: {entry_names: [hand, ground, nothing], entry_values: "
               "[{enabled: [false, true, true]}, {enabled: [true, false, true]}, "
               "{enabled: [true, true, true]}]}\n");
  const Scene scene = read("kitchen.yaml", text);
  ASSERT_EQ(scene.objects.size(), 5u);
  EXPECT_EQ(scene.objects[4].name, "tool");
  EXPECT_FALSE(scene.objects[4].fixed);
  EXPECT_EQ(scene.objects[4].parts[0].shape.radius, 0.05);
  EXPECT_EQ(scene.objects[4].mass, 2.5);
  ASSERT_EQ(scene.robots.size(), 1u);
  EXPECT_TRUE(scene.robots[0].is_attached);
  EXPECT_EQ(scene.robots[0].base.kind, RobotBase::Kind::kObject);
  EXPECT_LT((scene.robots[0].base.base_from_root.position - Vec3(0, 0, 0.2)).norm(), 1e-15);
  const auto watched = [&](const std::string& a, const std::string& b) {
    return std::ranges::any_of(scene.pairs, [&](const ObjectPair& pair) {
      const std::string &first = scene.objects[pair.first].name,
                        &second = scene.objects[pair.second].name;
      return (first == a && second == b) || (first == b && second == a);
    });
  };
  EXPECT_TRUE(watched("hand", "rock"));
  EXPECT_FALSE(watched("hand", "ground")) << "the matrix allows it";
  EXPECT_TRUE(watched("tool", "ground"));
  EXPECT_FALSE(watched("tool", "rock")) << "it may touch that";
  EXPECT_FALSE(watched("tool", "hand"));
}

// A quadrilateral has no volume; a body of a scene is solid.
TEST_F(YamlScenes, AFlatMeshIsAPlateInBothFormats) {
  std::string text = kText, yaml = kYaml;
  text.replace(text.find("0 1 0\n0 0 1\n0 1 2"), 17, "0 1 0\n1 1 0\n0 1 2");
  yaml.replace(yaml.find("{x: 0.0, y: 0.0, z: 1.0}]"), 24, "{x: 1.0, y: 1.0, z: 0.0}");
  for (const Scene& scene : {read("kitchen.scene", text), read("kitchen.yaml", yaml)}) {
    const ConvexBody& rock = scene.objects[2].parts[0].shape;
    EXPECT_EQ(rock.vertices.size(), 8u);
    for (const Vertex& vertex : rock.vertices)
      EXPECT_NEAR(std::abs(vertex.position.z()), 0.0005, 1e-12);
  }
}

TEST_F(YamlScenes, CutOffAnywhereAreRefusedOrRead) {
  for (std::size_t length = 0; length < kYaml.size(); length += 7)
    static_cast<void>(moveit::read_scene_yaml(kYaml.substr(0, length)));
  EXPECT_TRUE(std::holds_alternative<moveit::SceneYamlFault>(
      moveit::read_scene_yaml(kYaml.substr(0, kYaml.find("world:\n")))));
}

}  // namespace
}  // namespace clearance
