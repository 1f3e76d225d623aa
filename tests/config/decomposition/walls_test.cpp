#include "config/decomposition/walls.hpp"

#include <gtest/gtest.h>

#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

Walls walls_of_crate(const TriangleMesh& crate, double margin) {
  const OpenSpace space(crate, 0.01);
  return walls_of(ConvexCell::around(crate), space, space.points(0.005), 24, margin);
}

TEST(Walls, OfACrateAreFive) {
  const TriangleMesh crate = drawn::crate();
  const Walls walls = walls_of_crate(crate, 1e-9);
  EXPECT_EQ(5u, walls.cells.size());
}

// Narrowed cells stand for cells that lost a triangle to rounding.
TEST(Walls, ThatDoNotHoldTheMeshAreNone) {
  const TriangleMesh crate = drawn::crate();
  const Walls walls = walls_of_crate(crate, -1e-3);
  EXPECT_TRUE(walls.cells.empty());
  ASSERT_TRUE(walls.rest);
  EXPECT_TRUE(walls.rest->is_whole());
}

}  // namespace
}  // namespace clearance
