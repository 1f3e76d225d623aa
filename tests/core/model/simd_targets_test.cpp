// A query must return the same bits from every caller and with every instruction set.
#include "tests/shared/vector_widths.hpp"

#include <gtest/gtest.h>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

constexpr std::uint64_t kFirstSeed = 300, kWidthSeeds = 6;

struct Walk {
  ConvexBody a, b;
  std::vector<std::pair<Pose, Pose>> poses;
  std::string name;
};

// Hard motions, and hard cases treated as motions of one step.
template <class Visit>
void for_each_walk(const Visit& visit) {
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kWidthSeeds; ++seed) {
    for (const hard::MotionFamily& family : hard::motion_families()) {
      Random random(seed);
      const hard::HardMotion motion = family.make(random, 60);
      visit(Walk{test::made(motion.a), test::made(motion.b), motion.poses,
                 family.name + std::string(" seed ") + std::to_string(seed)});
    }
    for (const hard::CaseFamily& family : hard::case_families()) {
      Random random(seed);
      const hard::HardCase c = family.make(random);
      visit(Walk{test::made(c.a),
                 test::made(c.b),
                 {{c.pose_a, c.pose_b}, {c.pose_a, c.pose_b}},
                 family.name + std::string(" seed ") + std::to_string(seed)});
    }
  }
}

std::vector<DistanceResult> follow(const Walk& walk) {
  std::vector<DistanceResult> results;
  TrackingState state;
  for (const auto& [a, b] : walk.poses) results.push_back(distance(walk.a, walk.b, a, b, state));
  return results;
}

TEST(Distance, OfTwoPosesIsThatOfTheirRelativePoseToTheBit) {
  for_each_walk([](const Walk& walk) {
    TrackingState state, other;
    for (const auto& [a, b] : walk.poses) {
      EXPECT_TRUE(same_bits(distance(walk.a, walk.b, a, b, state),
                            distance(walk.a, walk.b, relative_pose(a, b), other)))
          << walk.name;
    }
  });
}

TEST(Distance, HasTheSameBitsAtEveryVectorWidth) {
  for_each_walk([](const Walk& walk) {
    const std::vector<DistanceResult> expected = follow(walk);
    for (const std::int64_t width : vector_widths()) {
      const OnlyWith only(width);
      const std::vector<DistanceResult> found = follow(walk);
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_TRUE(same_bits(found[k], expected[k])) << walk.name << ", step " << k;
      }
    }
  });
}

}  // namespace
}  // namespace clearance
