// Oracle: the octomap library (Debian), which writes the trees as octomap_msgs do and lists their
// leaves.
#include "monitor/intake/octomap_tree.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <tuple>

#include "tests/shared/random.hpp"

namespace clearance::octomap_tree_test {
namespace {

template <class Tree>
Tree drawn(Random& random, double resolution) {
  Tree tree(resolution);
  const double around = random.uniform(0.2, 3.0);
  for (int i = random.integer(1, 300); i > 0; --i) {
    const Vec3 p = around * random.direction() + Vec3(random.uniform(-2, 2), 0.3, 0);
    tree.updateNode(octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                     static_cast<float>(p.z())),
                    random.chance(0.6));
  }
  // Filled cubes, which pruning makes coarser leaves of.
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 8; ++z) {
        const auto at = [&](int k) { return static_cast<octomap::key_type>(32768 + k); };
        tree.updateNode(octomap::OcTreeKey(at(x), at(y), at(z)), true);
      }
    }
  }
  tree.updateInnerOccupancy();
  if (random.chance(0.7)) tree.prune();
  return tree;
}

template <class Tree>
std::string bytes_of(Tree& tree, bool is_binary) {
  std::stringstream out;
  if (is_binary) {
    tree.writeBinaryData(out);
  } else {
    tree.writeData(out);
  }
  return out.str();
}

OctomapView view_of(const std::string& bytes, bool is_binary, double resolution,
                    const char* id = "OcTree") {
  return {is_binary, id, resolution, std::as_bytes(std::span(bytes))};
}

using Leaf = std::tuple<double, double, double, double>;  // the centre and half of the side

template <class Tree>
std::vector<Leaf> leaves(const Tree& tree) {
  std::vector<Leaf> out;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (tree.isNodeOccupied(*leaf))
      out.emplace_back(leaf.getX(), leaf.getY(), leaf.getZ(), 0.5 * leaf.getSize());
  }
  std::ranges::sort(out);
  return out;
}

template <class Tree>
void expect_same(const char* id) {
  std::size_t cubes = 0, coarse = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 53 + 11);
    const double resolution = random.chance(0.5) ? 0.05 : random.uniform(0.01, 0.3);
    Tree tree = drawn<Tree>(random, resolution);
    const std::vector<Leaf> expected = leaves(tree);
    for (const bool is_binary : {true, false}) {
      const std::string bytes = bytes_of(tree, is_binary);
      std::vector<MeasuredPoint> found;
      double excess = 0.0;
      ASSERT_EQ(occupied_cubes(view_of(bytes, is_binary, resolution, id), 100000, found, excess),
                OctomapFault::kNoFault);
      std::ranges::sort(found, {},
                        [](const MeasuredPoint& p) { return std::tuple(p.x, p.y, p.z); });
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        const auto& [x, y, z, half] = expected[i];
        const double off = std::max(
            {std::abs(found[i].x - x), std::abs(found[i].y - y), std::abs(found[i].z - z)});
        EXPECT_LT(off, 1e-5);
        EXPECT_GE(found[i].radius, half) << "it contains the exact cube";
        EXPECT_LT(found[i].radius, half + 1e-5);
        // A corner of the cube is within the excess of the exact one.
        const double corner = std::hypot(off + found[i].radius - half, off + found[i].radius - half,
                                         off + found[i].radius - half);
        EXPECT_LE(corner, excess * (1.0 + 1e-9));
        ++cubes;
        coarse += half > 0.75 * resolution ? 1 : 0;
      }
    }
  }
  EXPECT_GT(cubes, 5000u);
  EXPECT_GT(coarse, 50u);
}

TEST(OctomapTree, HasTheOccupiedLeavesThatTheLibraryHas) {
  expect_same<octomap::OcTree>("OcTree");
  expect_same<octomap::ColorOcTree>("ColorOcTree");
}

// The exact cube of a leaf: its centre is a multiple of half of the resolution.
TEST(OctomapTree, CubesContainTheExactOnesInSpiteOfRounding) {
  for (const double resolution : {0.1, 0.03, 0.05000001}) {
    octomap::OcTree tree(resolution);
    const std::array<int, 3> key{-31337, 20011, 7};
    const auto at = [&](std::size_t k) { return static_cast<octomap::key_type>(32768 + key[k]); };
    tree.updateNode(octomap::OcTreeKey(at(0), at(1), at(2)), true);
    const std::string bytes = bytes_of(tree, true);
    std::vector<MeasuredPoint> found;
    double excess = 0.0;
    ASSERT_EQ(occupied_cubes(view_of(bytes, true, resolution), 10, found, excess),
              OctomapFault::kNoFault);
    ASSERT_EQ(found.size(), 1u);
    const std::array<float, 3> centre{found[0].x, found[0].y, found[0].z};
    for (std::size_t k = 0; k < 3; ++k) {
      const long double low = static_cast<long double>(key[k]) * resolution;
      EXPECT_LE(static_cast<long double>(centre[k]) - found[0].radius, low);
      EXPECT_GE(static_cast<long double>(centre[k]) + found[0].radius, low + resolution);
    }
  }
}

TEST(OctomapTree, CutAndDamagedTreesAreRefusedOrReadWithinTheirBytes) {
  Random random(7);
  octomap::OcTree tree = drawn<octomap::OcTree>(random, 0.1);
  std::vector<MeasuredPoint> found;
  double excess = 0.0;
  for (const bool is_binary : {true, false}) {
    const std::string whole = bytes_of(tree, is_binary);
    for (std::size_t size = 1; size < whole.size(); ++size) {
      EXPECT_EQ(
          occupied_cubes(view_of(whole.substr(0, size), is_binary, 0.1), 100000, found, excess),
          OctomapFault::kCut);
    }
    EXPECT_EQ(occupied_cubes(view_of(whole + "x", is_binary, 0.1), 100000, found, excess),
              OctomapFault::kCut);
    for (int i = 0; i < 3000; ++i) {
      std::string damaged = whole;
      for (int k = random.integer(1, 5); k > 0; --k) {
        damaged[static_cast<std::size_t>(random.integer(0, static_cast<int>(whole.size()) - 1))] =
            static_cast<char>(random.integer(0, 255));
      }
      static_cast<void>(occupied_cubes(view_of(damaged, is_binary, 0.1), 50, found, excess));
      EXPECT_LE(found.size(), 50u);
    }
    // Children without an end.
    EXPECT_EQ(
        occupied_cubes(view_of(std::string(1000, '\xFF'), is_binary, 0.1), 100000, found, excess),
        OctomapFault::kTooDeep);
  }
}

TEST(OctomapTree, OtherKindsAndSizesAreRefusedByCause) {
  std::vector<MeasuredPoint> found;
  double excess = 0.0;
  const std::string bytes(2, '\xAA');  // eight occupied leaves
  EXPECT_EQ(occupied_cubes(view_of(bytes, true, 0.1, "OcTreeStamped"), 9, found, excess),
            OctomapFault::kKind);
  EXPECT_EQ(occupied_cubes(view_of(bytes, true, 0.0), 9, found, excess), OctomapFault::kResolution);
  EXPECT_EQ(occupied_cubes(view_of(bytes, true, std::nan("")), 9, found, excess),
            OctomapFault::kResolution);
  EXPECT_EQ(occupied_cubes(view_of(bytes, true, 0.1), 7, found, excess), OctomapFault::kTooMany);
  EXPECT_EQ(occupied_cubes(view_of(bytes, true, 0.1), 8, found, excess), OctomapFault::kNoFault);
  EXPECT_EQ(found.size(), 8u);
  EXPECT_EQ(occupied_cubes(view_of("", true, 0.1), 8, found, excess), OctomapFault::kNoFault);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace clearance::octomap_tree_test
