// Planning scenes in both forms of MoveIt's text format.
#include "config/urdf/planning_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <variant>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;

const std::string kKitchen = R"(kitchen
* table top
1 2 0.5
0 0 0.70711 0.70711
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
1
corner
1 0.5 0
0 0 0 1
* ball
0 0 2
0 0 0 1
1
sphere
0.25
0 0 0
0 0 0 1
0 0 0 0
0
.
)";

PlanningScene scene_from(const std::string& text) {
  auto read = read_planning_scene(text);
  if (const auto* fault = std::get_if<PlanningSceneFault>(&read)) {
    ADD_FAILURE() << fault->line << ": " << fault->reason;
    return {};
  }
  return std::get<PlanningScene>(std::move(read));
}

std::string fault_of(const std::string& text) {
  const auto read = read_planning_scene(text);
  const auto* fault = std::get_if<PlanningSceneFault>(&read);
  return fault == nullptr ? "" : std::to_string(fault->line) + ": " + fault->reason;
}

TEST(PlanningScene, HasItsObjectsShapesAndPlaces) {
  const PlanningScene scene = scene_from(kKitchen);
  EXPECT_EQ(scene.name, "kitchen");
  ASSERT_EQ(scene.objects.size(), 2u);
  const Object& table = scene.objects[0];
  EXPECT_EQ(table.name, "table top");
  EXPECT_TRUE(table.fixed);
  EXPECT_EQ(table.world_from_object.position, Vec3(1, 2, 0.5));
  EXPECT_NEAR(table.world_from_object.orientation.norm(), 1.0, 1e-15);
  ASSERT_EQ(table.parts.size(), 2u);
  EXPECT_EQ(table.parts[0].name, "box0");
  EXPECT_EQ(table.parts[0].shape.facets.size(), 6u);
  EXPECT_NEAR(table.parts[0].shape.bounding_radius, 0.5 * Vec3(2, 1, 0.1).norm(), 1e-12);
  EXPECT_EQ(table.parts[1].name, "cylinder1");
  EXPECT_NEAR(table.parts[1].shape.bounding_radius, std::hypot(0.05, 0.25), 1e-12);
  EXPECT_EQ(table.parts[1].object_from_part.position, Vec3(0.9, 0, -0.35));
  EXPECT_EQ(scene.objects[1].parts[0].shape.radius, 0.25);
  EXPECT_TRUE(scene.notes.empty());
}

// Before 2020, objects had no pose and no subframes.
TEST(PlanningScene, MayBeOfTheOlderForm) {
  const PlanningScene scene = scene_from(
      "old\n* a\n1\nbox\n1 1 1\n1 2 3\n0 0 0 1\n0 0 0 0\n* b\n1\ncone\n0.5 1\n0 0 0\n0 0 0 1\n"
      "0 0 0 0\n.\n");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].world_from_object.position, Vec3::Zero());
  EXPECT_EQ(scene.objects[0].parts[0].object_from_part.position, Vec3(1, 2, 3));
}

TEST(PlanningScene, SaysWhatItMakesOfMeshesAndPlanes) {
  const PlanningScene scene = scene_from(
      "s\n* rock\n1\nmesh\n4 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 2\n0 1 3\n0 2 3\n1 2 3\n"
      "0 0 0\n0 0 0 1\n0 0 0 0\n* ground\n1\nplane\n0 0 1 0.25\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].parts[0].shape.facets.size(), 4u);
  const ConvexBody& ground = scene.objects[1].parts[0].shape;
  ASSERT_TRUE(ground.is_half_space());
  EXPECT_EQ(ground.facets[0].normal, Vec3::UnitZ());
  EXPECT_EQ(ground.facets[0].offset, -0.25);
  EXPECT_THAT(scene.notes,
              testing::ElementsAre("meshes are their convex hulls: rock",
                                   "planes are solid on the side that their normals point away "
                                   "from: ground"));
}

TEST(PlanningScene, FaultsAreNamedWithTheirLine) {
  EXPECT_EQ(fault_of(""),
            "1: found ''; expected '* NAME' of an object, or '.' at the end, as in a "
            ".scene file (YAML has to be in a .yaml file)");
  EXPECT_THAT(fault_of("s\n* a\n1\nocttree\n"), mistake_at("4", "'octtree'"));
  EXPECT_THAT(fault_of("s\n* a\n1\nbox\n1 1 wide\n"), mistake_at("5", "'wide'"));
  EXPECT_THAT(fault_of("s\n* a\n1\nbox\n1 1 0\n0 0 0\n0 0 0 1\n"), mistake_at("5", "box"));
  EXPECT_THAT(fault_of("s\n* a\n1\nsphere\n1\n0 0 0\n0 0 0 2\n"), mistake_at("7", "2.000000"));
  EXPECT_THAT(fault_of("s\n* a\n-1\n"), mistake_at("3", "-1"));
  EXPECT_THAT(fault_of("s\n* a\n1e300\n"), mistake_at("3", "1e+300"));
}

// A file that is cut off at any point is refused, and causes no crash.
TEST(PlanningScene, CutOffAnywhereIsRefused) {
  const std::size_t whole = kKitchen.rfind('.');
  for (std::size_t length = 0; length < whole; ++length)
    EXPECT_NE(fault_of(kKitchen.substr(0, length)), "") << length;
}

TEST(PlanningScene, IsAGroupOfFixedObjectsInACell) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "kitchen.scene") << kKitchen;
  const std::string cell =
      "name: test\nunits: {length: mm, angle: deg}\n"
      "scenes: [{file: kitchen.scene, group: kitchen, pose: {xyz: [0, 0, 100]}}]\n"
      "objects: [{name: hand, sphere: {radius: 50}}]\n"
      "pairs: [{between: [hand, kitchen]}]\n";
  const Scene scene = scene_of(cell, folder / "cell.yaml");
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[1].name, "table top");
  EXPECT_TRUE(scene.objects[1].fixed);
  EXPECT_EQ(scene.objects[1].world_from_object.position, Vec3(1, 2, 0.6));
  EXPECT_EQ(scene.pairs.size(), 2u);
  // The revision of the cell depends also on that of the file.
  std::ofstream(folder / "kitchen.scene", std::ios::app) << "\n";
  EXPECT_NE(scene.revision, scene_of(cell, folder / "cell.yaml").revision);
  std::ofstream(folder / "kitchen.scene") << "kitchen\n* a\n1\nboxes\n.\n";
  EXPECT_THAT(errors_of(cell, folder / "cell.yaml"),
              mistake_at(":3:17", "kitchen.scene:4", "'boxes'"));
}

}  // namespace
}  // namespace clearance
