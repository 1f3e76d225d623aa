// The distances that the plug-in for MoveIt asks for, without MoveIt. Oracle: the exact distance of
// two bodies, for an octree that of each of its leaves.
#include "tools/ros2/clearance_moveit/src/pair_query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/shared/exact_oracle.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance_moveit {
namespace {

using clearance::Random;
using clearance::oracle::Body;
using clearance::oracle::exact_distance;
using clearance::oracle::ExactDistance;

constexpr double kNearDistance = 1e-12;  // m, of bodies of 1 m

Body box_of(const Vec3& half) {
  Body body;
  for (unsigned i = 0; i < 8; ++i) {
    body.points.push_back(half.cwiseProduct(
        Vec3((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1)));
  }
  return body;
}

// A box of random size at a random place, for the query and for the oracle.
struct RandomBox {
  explicit RandomBox(Random& random)
      : half(random.uniform(0.05, 0.3), random.uniform(0.05, 0.3), random.uniform(0.05, 0.3)),
        exact(box_of(half)) {
    auto parts = std::make_shared<ShapeParts>();
    parts->bodies.push_back(clearance::test::made(exact));
    parts->boxes.push_back({-half, half});
    part.shape = parts;
    part.body = &parts->bodies.front();
    part.world_from_part = random.pose(0.7);
  }
  [[nodiscard]] Box around() const {
    return placed(part.shape->boxes.front(), part.world_from_part);
  }
  Vec3 half;
  Body exact;
  PosedPart part;
};

// An octree of leaves of several sizes, some of them free.
struct RandomTree {
  explicit RandomTree(Random& random) : tree(std::make_shared<octomap::OcTree>(0.05)) {
    for (int i = 0; i < 30; ++i) add(random.in_box(0.6), true);
    for (int i = 0; i < 30; ++i) add(random.in_box(0.6), false);
    const Vec3 corner = 0.2 * random.in_box(2.0).array().round();
    for (int i = 0; i < 64; ++i) {  // become one leaf
      add(corner + 0.05 * Vec3(i % 4 + 0.5, i / 4 % 4 + 0.5, i / 16 + 0.5), true);
    }
    tree->prune();
    auto parts = std::make_shared<ShapeParts>();
    for (unsigned depth = 0; depth <= tree->getTreeDepth(); ++depth) {
      const Vec3 half = Vec3::Constant(0.5 * tree->getNodeSize(depth));
      parts->bodies.push_back(clearance::test::made(clearance::box(half)));
      parts->boxes.push_back({-half, half});
    }
    parts->octree = tree;
    part.shape = parts;
    part.world_from_part = random.pose(0.5);
  }
  void add(const Vec3& at, bool occupied) { tree->updateNode(at.x(), at.y(), at.z(), occupied); }
  // The exact distance of the nearest occupied leaf.
  [[nodiscard]] double to(const RandomBox& other) const {
    double least = clearance::kInfinity;
    for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
      if (!tree->isNodeOccupied(*leaf)) continue;
      Pose pose = part.world_from_part;
      pose.position = clearance::transform(pose, Vec3(leaf.getX(), leaf.getY(), leaf.getZ()));
      const Body cube = box_of(Vec3::Constant(0.5 * leaf.getSize()));
      least = std::min(least,
                       exact_distance(other.exact, other.part.world_from_part, cube, pose).lower);
    }
    return least;
  }
  std::shared_ptr<octomap::OcTree> tree;
  PosedPart part;
};

// The least distance that query_parts() finds, and the number of its queries. Collisions count as
// 0.
struct Least {
  double distance = clearance::kInfinity;
  int queries = 0;
};
Least least_of(const PosedPart& a, const Box& box_a, const PosedPart& b, const Box& box_b) {
  Least least;
  query_parts(a, box_a, b, box_b, least.distance, Depth::kNotAsked, [&](const Found& found) {
    least.distance = std::min(least.distance, found.distance);
    ++least.queries;
    return true;
  });
  return least;
}

TEST(PairQuery, BoundsTheExactDistanceAndItsPointsAreThatFarApart) {
  Random random(1);
  int apart = 0, meeting = 0;
  for (int i = 0; i < 300; ++i) {
    const RandomBox a(random), b(random);
    const ExactDistance truth =
        exact_distance(a.exact, a.part.world_from_part, b.exact, b.part.world_from_part);
    const Found found = query(*a.part.body, a.part.world_from_part, *b.part.body,
                              b.part.world_from_part, Depth::kAsked);
    EXPECT_EQ(found.collides, truth.cores_meet()) << i;
    if (truth.cores_meet()) {
      ++meeting;
      EXPECT_LE(found.distance, 0.0) << i;
      continue;
    }
    ++apart;
    EXPECT_GE(truth.compare(found.distance), 0) << "above the truth: " << i;
    EXPECT_NEAR(found.distance, truth.lower, kNearDistance) << i;
    const Vec3 between = found.point_b - found.point_a;
    EXPECT_NEAR(between.norm(), truth.lower, kNearDistance) << i;
    EXPECT_NEAR(between.dot(found.normal), truth.lower, kNearDistance) << "from A to B: " << i;
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(meeting, 20);
}

TEST(PairQuery, FindsTheNearestLeafOfAnOctreeAndAsksAboutFewOthers) {
  int queries = 0, apart = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const RandomTree tree(random);
    RandomBox box(random);
    box.part.world_from_part.position *= 2.0;
    const double truth = tree.to(box);
    const Least found = least_of(box.part, box.around(), tree.part, {});
    EXPECT_NEAR(found.distance, std::max(truth, 0.0), kNearDistance) << seed;
    const Least swapped = least_of(tree.part, {}, box.part, box.around());
    EXPECT_NEAR(swapped.distance, std::max(truth, 0.0), kNearDistance) << seed;
    queries += found.queries;
    apart += truth > 0.0 ? 1 : 0;
  }
  EXPECT_GT(apart, 10);
  EXPECT_LT(queries, 20 * 20) << "of about 30 leaves a tree";
}

TEST(PairQuery, AsksNothingOfAnOctreeWithoutOccupiedLeaves) {
  Random random(2);
  RandomTree tree(random);
  tree.tree->clear();
  const RandomBox box(random);
  EXPECT_EQ(least_of(box.part, box.around(), tree.part, {}).queries, 0);
  tree.add({0.1, 0.1, 0.1}, false);
  EXPECT_EQ(least_of(box.part, box.around(), tree.part, {}).queries, 0);
}

TEST(PairQuery, IsACollisionIfNothingStandsForAShape) {
  Random random(3);
  const RandomBox box(random);
  PosedPart none;
  auto parts = std::make_shared<ShapeParts>();
  parts->fault = "the mesh has no triangle";
  none.shape = parts;
  none.world_from_part = clearance::test::at(100, 0, 0);
  for (const auto& [a, b] : {std::pair(none, box.part), std::pair(box.part, none)}) {
    const Least found = least_of(a, {}, b, {});
    EXPECT_EQ(found.queries, 1);
    EXPECT_EQ(found.distance, 0.0);
  }
}

}  // namespace
}  // namespace clearance_moveit
