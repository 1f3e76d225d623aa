// Spheres and capsules, which are points and segments with radii, against exact rationals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/nonsense_state.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using test::at;

oracle::Body sphere(const Vec3& centre, double radius) { return {{}, {centre}, radius}; }
oracle::Body capsule(const Vec3& start, const Vec3& end, double radius) {
  return {{}, {start, end}, radius};
}

void expect_no_faults(const oracle::Body& a, const Pose& pose_a, const oracle::Body& b,
                      const Pose& pose_b, const std::string& what) {
  DistanceJudge judge(a, b);
  ASSERT_TRUE(judge.refusal().empty()) << judge.refusal();
  const oracle::ExactDistance truth = judge.truth(pose_a, pose_b);
  TrackingState state;
  for (const char* query : {" cold", " tracked"}) {
    const DistanceResult r = judge.ask(pose_a, pose_b, state);
    for (const std::string& fault : judge.faults(r, truth, pose_a, pose_b)) {
      ADD_FAILURE() << what << query << ": " << fault;
    }
  }
}

// A point or a segment somewhere near the origin of its frame, with a radius or without.
oracle::Body random_body(Random& random, double size) {
  const double radius = random.chance(0.3) ? 0.0 : random.log_uniform(1e-3, 1.0) * size;
  const Vec3 start = random.chance(0.3) ? Vec3(Vec3::Zero()) : random.in_box(size);
  if (random.chance(0.3)) return sphere(start, radius);
  const double length = std::max(2.0 * kLeastExtent, random.log_uniform(1e-4, 2.0) * size);
  return capsule(start, start + length * random.direction(), radius);
}

TEST(Segments, AreAnsweredWithinRoundingOfTheTruthFromTinyToHuge) {
  Random random(1);
  for (const double size : {1e-10, 1e-3, 1.0, 1e4, 1e11}) {
    for (int i = 0; i < 60; ++i) {
      const oracle::Body a = random_body(random, size), b = random_body(random, size);
      const Pose pose_a = random.pose(2.0 * size), pose_b = random.pose(2.0 * size);
      expect_no_faults(a, pose_a, b, pose_b,
                       "size " + std::to_string(size) + ", case " + std::to_string(i));
    }
  }
}

TEST(Segments, AreAnsweredThatAreParallelOrNearlySo) {
  Random random(2);
  const oracle::Body a = capsule({-1, 0, 0}, {1, 0, 0}, 0.1);
  for (const double length : {0.25, 2.0}) {
    const oracle::Body b = capsule({-length, 0, 0}, {length, 0, 0}, 0.2);
    for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-4}) {
      for (const double along : {0.0, 0.5, 1.0, 1.25, 3.0, 5.0}) {
        const Pose world = random.pose(1.0);
        const Pose pose_b = compose(world, {{along, 1.0, 0.0}, test::turned({0, 0, 1}, tilt)});
        expect_no_faults(a, world, b, pose_b, std::to_string(tilt) + " " + std::to_string(along));
        expect_no_faults(b, pose_b, a, world, "swapped " + std::to_string(tilt));
      }
    }
  }
}

TEST(Segments, AreAnsweredThatCrossTouchOrCoincide) {
  const oracle::Body bare = capsule({-1, 0, 0}, {1, 0, 0}, 0.0);
  const oracle::Body thick = capsule({-1, 0, 0}, {1, 0, 0}, 0.25);
  const Pose across{{0.25, 0, 0}, test::turned({0, 0, 1}, 1.0)};
  const Pose origin = at(0, 0, 0);
  for (const oracle::Body& a : {bare, thick}) {
    for (const oracle::Body& b : {bare, thick}) {
      expect_no_faults(a, origin, b, across, "crossing");
      expect_no_faults(a, origin, b, origin, "the same");
      expect_no_faults(a, origin, b, at(2, 0, 0), "end to end");
      expect_no_faults(a, origin, b, at(3, 0, 0), "in line");
      expect_no_faults(a, origin, b, at(1.5, 0, 0), "one over the other");
      expect_no_faults(a, origin, b, at(0, 0.25, 0), "one radius");
      expect_no_faults(a, origin, b, at(0, 1e-13, 0), "nearly the same");
    }
  }
  for (const double radius : {0.0, 0.5}) {
    for (const double x : {0.0, 1e-16, 1e-12, 0.5, 1.0, 3.0}) {
      expect_no_faults(sphere({0, 0, 0}, radius), origin, sphere({0, 0, 0}, 0.5), at(x, 0, 0),
                       "spheres");
      expect_no_faults(sphere({0, 0, 0}, radius), origin, thick, at(x, 0, 0), "on the axis");
      expect_no_faults(thick, origin, sphere({0, 0, 0}, radius), at(0, x, 0), "beside the middle");
    }
  }
}

bool same_answer(const DistanceResult& r, const DistanceResult& s) {
  return r.distance == s.distance && r.lower == s.lower && r.upper == s.upper &&
         r.normal == s.normal && r.point_on_a == s.point_on_a && r.point_on_b == s.point_on_b &&
         r.status == s.status;
}

TEST(Segments, GiveTheSameBitsColdTrackedByARelativePoseAndFromNonsense) {
  Random random(3);
  for (int i = 0; i < 3000; ++i) {
    const ConvexBody a = test::made(random_body(random, 1.0));
    const ConvexBody b = test::made(random_body(random, 1.0));
    const Pose pose_a = random.pose(2.0), pose_b = random.pose(2.0);
    TrackingState state, cold, relative, nonsense = test::nonsense_state(a, b, random);
    const DistanceResult first = distance(a, b, pose_a, pose_b, cold);
    if (first.status != DistanceStatus::kConverged) continue;
    EXPECT_EQ(first.iterations, 1) << i;
    Pose before = pose_a;
    before.position += Vec3(0.01, 0.02, -0.01);
    (void)distance(a, b, before, pose_b, state);
    EXPECT_TRUE(same_answer(first, distance(a, b, pose_a, pose_b, state))) << i;
    EXPECT_TRUE(same_answer(first, distance(a, b, relative_pose(pose_a, pose_b), relative))) << i;
    EXPECT_TRUE(same_answer(first, distance(a, b, pose_a, pose_b, nonsense))) << i;
  }
}

TEST(Segments, KeepTheWitnessPointsInTheState) {
  const ConvexBody a = test::made(sphere({0, 0, 0}, 0.25)), b = test::made(sphere({0, 1, 0}, 0.5));
  TrackingState state;
  const DistanceResult r = distance(a, b, at(0, 0, 0), at(0, 2, 0), state);
  EXPECT_EQ(r.distance, 2.25);
  EXPECT_EQ(state.a.point, Vec3(0, 0, 0));
  EXPECT_EQ(state.b.point, Vec3(0, 1, 0));
  EXPECT_EQ(state.a.kind, FeatureKind::kVertex);
  EXPECT_EQ(state.b.kind, FeatureKind::kVertex);
}

TEST(Segments, AllocateNothing) {
  Random random(4);
  const ConvexBody a = test::made(capsule({-1, 0, 0}, {1, 0, 0}, 0.1));
  const ConvexBody b = test::made(sphere({0, 0, 0}, 0.1));
  for (int i = 0; i < 100; ++i) {
    const Pose pose_a = random.pose(1.0), pose_b = random.pose(1.0);
    TrackingState of_segments, of_points;
    const std::uint64_t before = allocations();
    (void)distance(a, a, pose_a, pose_b, of_segments);
    (void)distance(b, b, pose_a, pose_b, of_points);
    EXPECT_EQ(allocations(), before) << i;
  }
}

// The poses of a sphere need no rotation of it. A position without a component along an axis, and
// orientations that only permute axes, are exempt from that.
TEST(Segments, OfSpheresHaveTheBitsOfTheirRelativePose) {
  const ConvexBody a = test::made(sphere({0, 0, 0}, 0.25)), b = test::made(sphere({0, 0, 0}, 0.5));
  const Eigen::Quaterniond turns[] = {{1, 0, 0, 0},         {0, 1, 0, 0},     {0, 0.6, 0.8, 0},
                                      {0.5, 0.5, 0.5, 0.5}, {0.8, 0, 0, 0.6}, {0.1, 0.7, 0.1, 0.7}};
  const Vec3 places[] = {{1, 2, 3},
                         {1, 2, 0},
                         {0, -2, 0},
                         {1e-3, 0.5, 7},
                         {0, 0, 0},
                         {0.5, 0, 0.5},
                         {1e-160, 1e-160, 2e-160}};
  for (const Eigen::Quaterniond& turn : turns) {
    for (const Vec3& place : places) {
      const Vec3 first = place.norm() < 1e-100 ? Vec3::Zero() : Vec3(0.5, 0.25, 0.125);
      const Pose at_a{first, turn}, at_b{first + place, turns[5]};
      TrackingState by_poses, by_relative;
      EXPECT_TRUE(same_bits(distance(a, b, at_a, at_b, by_poses),
                            distance(a, b, relative_pose(at_a, at_b), by_relative)))
          << turn.coeffs().transpose() << ", " << place.transpose();
    }
  }
}

TEST(Segments, OfABadPoseAreUnknown) {
  const ConvexBody a = test::made(sphere({0, 0, 0}, 0.1));
  TrackingState state;
  Pose bad = at(1, 0, 0);
  bad.position.x() = std::nan("");
  const DistanceResult r = distance(a, a, at(0, 0, 0), bad, state);
  EXPECT_EQ(r.status, DistanceStatus::kBadPose);
  EXPECT_EQ(r.lower, -kInfinity);
}

}  // namespace
}  // namespace clearance
