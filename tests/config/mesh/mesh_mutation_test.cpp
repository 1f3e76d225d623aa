// Oracle: whatever the bytes of a mesh file, one of two results is allowed. A cell with it is
// refused with the file's name and a reason. Otherwise its part lies within the limits stated in
// config/KEYS.md, and is the same each time it is read. The test makes the meshes itself: boxes
// as programs export them. Seeds are fixed, and a failure prints its seed.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>

#include "config/mesh/mesh_file.hpp"
#include "core/shapes.hpp"
#include "tests/config/cells.hpp"
#include "tests/config/mesh/box_meshes.hpp"
#include "tests/shared/mutation.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

class MeshMutation : public testing::TestWithParam<BoxMesh> {};

// Each mutation needs a child process: 2 to 5 ms, and 15 ms if assimp reads OBJ. All formats take
// several seconds. A crash can be detected only so.
std::uint32_t mutations_of(const BoxMesh& mesh) {
#if defined(__SANITIZE_ADDRESS__)
  return mesh.extension == "obj" ? 10 : 50;
#else
  return mesh.extension == "obj" ? 60 : 400;
#endif
}

TEST_P(MeshMutation, IsRefusedByNameOrWithinTheLimits) {
  const BoxMesh& mesh = GetParam();
  const auto mutations = static_cast<std::uint32_t>(repeats(mutations_of(mesh)));
  test::ScratchFolder folder;
  const std::string cell = cell_text("objects:\n  - {name: a, mesh: {file: mesh." + mesh.extension +
                                     ", max_parts: 1}}\n  - {name: b, sphere: {radius: 1}}\n"
                                     "pairs: [{between: [a, b]}]\n");
  test::write_text(folder / ("mesh." + mesh.extension), mesh.bytes);
  ASSERT_EQ("", errors_of(cell, folder / "cell.yaml"));

  int accepted = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < mutations; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::string bytes = test::mutated_numbers(mesh.bytes, random);
    test::write_text(folder / ("mesh." + mesh.extension), bytes);
    const CellResult result = parse_cell(cell, folder / "cell.yaml");
    if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
      ++refused;
      ASSERT_EQ(1u, errors->size());
      ASSERT_NE(std::string::npos, errors->front().text.find("found a mesh"))
          << errors->front().text;
      continue;
    }
    ++accepted;
    const ConvexBody& shape = std::get<Cell>(result).scene.objects.at(0).parts.at(0).shape;
    for (const Vertex& vertex : shape.vertices) {
      ASSERT_LE(vertex.position.cwiseAbs().maxCoeff(), 100.0);
    }
    if (seed % 5 != 0) continue;
    const auto once = std::get<TriangleMesh>(read_mesh(bytes, mesh.extension));
    const auto twice = std::get<TriangleMesh>(read_mesh(bytes, mesh.extension));
    ASSERT_EQ(once.vertices, twice.vertices);
    ASSERT_EQ(once.triangles, twice.triangles);
  }
  EXPECT_GT(accepted, 0);
  EXPECT_GT(refused, static_cast<int>(mutations) / 10);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshMutation, testing::ValuesIn(box_meshes()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace clearance
