#include "config/decomposition/part_search.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "config/decomposition/shells.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

std::vector<ConvexBody> parts_of_box_and_sheet(double tolerance) {
  TriangleMesh mesh;
  drawn::add_box({1.0, 1.0, 1.0}, {1.05, 1.05, 1.05}, mesh);
  drawn::add_quad({Vec3(1.2, 1, 1), Vec3(1.2, 1.05, 1), Vec3(1.2, 1.05, 1.05), Vec3(1.2, 1, 1.05)},
                  mesh);
  const OpenSpace space(mesh, 0.005);
  const std::vector<TriangleMesh> shells = shells_of(mesh);
  std::vector<ConvexCell> cells;
  for (const TriangleMesh& shell : shells) cells.push_back(ConvexCell::around(shell));
  PartSearch search(mesh, space, cells, {.tolerance = tolerance});
  search.search(0.015);
  return search.parts();
}

TEST(PartSearch, GivesAFlatPieceAVolume) { EXPECT_EQ(2u, parts_of_box_and_sheet(0.005).size()); }

// Doubles near 1 m are 2e-16 m apart.
TEST(PartSearch, LeavesNoPieceOutWhereCoordinatesAreTooCoarseForThat) {
  EXPECT_TRUE(parts_of_box_and_sheet(1e-15).empty());
}

// Returns whether the search for parts of the mesh got stuck before it had parts.
bool gets_stuck(const TriangleMesh& mesh) {
  const PartLimits limits;
  const OpenSpace space(mesh, 0.75 * limits.tolerance);
  const ConvexCell whole = ConvexCell::around(mesh);
  PartSearch search(mesh, space, {&whole, 1}, limits);
  const bool found = search.search(0.85 * limits.tolerance);
  EXPECT_NE(found, search.is_stuck());
  return !found;
}

// Every cut of a cup leaves about as much open space, and that of a thin slice the least.
TEST(PartSearch, GetsStuckInACupAndNotInAnL) {
  EXPECT_TRUE(gets_stuck(drawn::cup()));
  EXPECT_FALSE(gets_stuck(drawn::l_shape()));
}

}  // namespace
}  // namespace clearance
