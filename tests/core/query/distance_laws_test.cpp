// Laws that must hold between answers for any bodies, and that need no oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/shared/allocation_count.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/nonsense_state.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::cold;
using test::made;

const std::uint64_t kLawSeeds = repeats(8);

struct Example {
  std::string name;
  hard::HardCase c;
  ConvexBody a, b;

  [[nodiscard]] RelativePose pose() const { return relative_pose(c.pose_a, c.pose_b); }
  // The size that rounding errors are relative to (see DistanceJudge::size).
  [[nodiscard]] double size(const DistanceResult& r) const {
    return a.bounding_radius + a.radius + b.bounding_radius + b.radius +
           (c.pose_a.position - c.pose_b.position).norm() + std::abs(r.upper);
  }
};

void for_each_example(const std::function<void(const Example&, Random&)>& visit) {
  for (const hard::CaseFamily& family : hard::case_families()) {
    for (std::uint64_t seed = 100; seed < 100 + kLawSeeds; ++seed) {
      Random random(seed);
      Example example{
          family.name + std::string(" seed ") + std::to_string(seed), family.make(random), {}, {}};
      example.a = made(example.c.a);
      example.b = made(example.c.b);
      visit(example, random);
    }
  }
}

// Both intervals contain the same true value.
void expect_same_truth(const DistanceResult& r, const DistanceResult& s, const std::string& what) {
  EXPECT_LE(r.lower, s.upper) << what;
  EXPECT_LE(s.lower, r.upper) << what;
}

TEST(Distance, SwappingTheBodiesSwapsTheAnswer) {
  for_each_example([](const Example& e, Random&) {
    const DistanceResult r = cold(e.a, e.b, e.pose());
    const DistanceResult s = cold(e.b, e.a, relative_pose(e.c.pose_b, e.c.pose_a));
    expect_same_truth(r, s, e.name);
  });
}

TEST(Distance, IsZeroAfterMovingByItAlongTheNormal) {
  for_each_example([](const Example& e, Random&) {
    const DistanceResult r = cold(e.a, e.b, e.pose());
    if (r.status != DistanceStatus::kConverged || !e.a.bounded() || !e.b.bounded()) return;
    RelativePose moved = e.pose();
    moved.translation -= r.distance * r.normal;
    moved.translation_error += 0x1p-50 * (moved.translation.norm() + r.distance);
    const DistanceResult s = cold(e.a, e.b, moved);
    EXPECT_LE(std::abs(s.distance), 2e-14 * e.size(r)) << e.name;
  });
}

TEST(Distance, GrowsByAsMuchAsTheBodiesAreTakenApartAlongTheNormal) {
  for_each_example([](const Example& e, Random&) {
    const DistanceResult r = cold(e.a, e.b, e.pose());
    if (r.status != DistanceStatus::kConverged) return;
    RelativePose moved = e.pose();
    moved.translation += r.normal * r.distance;
    moved.translation_error += 0x1p-50 * (moved.translation.norm() + r.distance);
    const DistanceResult s = cold(e.a, e.b, moved);
    EXPECT_NEAR(s.distance, 2 * r.distance, 3e-14 * e.size(s)) << e.name;
  });
}

TEST(Distance, LeavesTheWitnessPointsInTheStateEachInItsBodysOwnFrame) {
  for_each_example([](const Example& e, Random&) {
    const RelativePose pose = e.pose();
    TrackingState state;
    const DistanceResult r = distance(e.a, e.b, pose, state);
    if (!std::isfinite(r.distance)) return;
    const Vec3 on_a = state.a.point + e.a.radius * r.normal;
    const Vec3 on_b = pose.rotation * state.b.point + pose.translation - e.b.radius * r.normal;
    EXPECT_LE((on_a - r.point_on_a).norm(), 1e-14 * e.size(r)) << e.name;
    EXPECT_LE((on_b - r.point_on_b).norm(), 1e-14 * e.size(r)) << e.name;
  });
}

TEST(Distance, OfABodyFarAwayStillHasAWitnessPointOnTheOtherOneToItsOwnRounding) {
  // A unit cube at the world's origin, and another one 1 km away.
  const ConvexBody cube = test::cube();
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Pose far{1000.0 * random.direction(), random.rotation()};
    const Pose here{Vec3::Zero(), random.rotation()};
    TrackingState state;
    (void)distance(cube, cube, far, here, state);
    const Vec3 witness = transform(here, state.b.point);
    const Vec3 own = here.orientation.conjugate() * witness;
    EXPECT_LE(own.cwiseAbs().maxCoeff(), 0.5 + 1e-15);
  }
}

TEST(Distance, TrackedEqualsColdWithinTheBounds) {
  for_each_example([](const Example& e, Random& random) {
    TrackingState state;
    Pose pose_b = e.c.pose_b;
    const double step = 0.05 * (e.a.bounding_radius + e.b.bounding_radius);
    for (int k = 0; k < 20; ++k) {
      pose_b.position += random.in_box(step);
      const RelativePose pose = relative_pose(e.c.pose_a, pose_b);
      expect_same_truth(distance(e.a, e.b, pose, state), cold(e.a, e.b, pose), e.name);
    }
  });
}

TEST(Distance, BoundsHoldEvenWhenTheStateIsNonsense) {
  for_each_example([](const Example& e, Random& random) {
    const DistanceResult r = cold(e.a, e.b, e.pose());
    for (int k = 0; k < 10; ++k) {
      TrackingState state = test::nonsense_state(e.a, e.b, random);
      const DistanceResult s = distance(e.a, e.b, e.pose(), state);
      // The value -infinity: two unbounded bodies that no translation separates.
      const bool inseparable = s.lower == -kInfinity && !e.a.bounded() && !e.b.bounded();
      EXPECT_TRUE(inseparable || (std::isfinite(s.distance) && std::isfinite(s.lower))) << e.name;
      EXPECT_TRUE(s.distance <= s.upper && s.normal.allFinite()) << e.name;
      expect_same_truth(r, s, e.name);
    }
  });
}

TEST(Distance, ScalesExactlyWithPowersOfTwo) {
  for_each_example([](const Example& e, Random& random) {
    // On an unbounded body, a query starts at a fixed distance from the boundary, which does not
    // scale.
    if (!e.a.bounded() || !e.b.bounded()) return;
    const double factor = std::ldexp(1.0, random.integer(-30, 30));
    const ShapeResult scaled_a = model(hard::scaled(e.c.a, factor)),
                      scaled_b = model(hard::scaled(e.c.b, factor));
    if (scaled_a.index() != 0 || scaled_b.index() != 0) return;  // too thin or too large
    const auto &a = std::get<0>(scaled_a), &b = std::get<0>(scaled_b);
    Pose pose_a = e.c.pose_a, pose_b = e.c.pose_b;
    pose_a.position *= factor;
    pose_b.position *= factor;
    const DistanceResult r = cold(e.a, e.b, e.pose());
    const DistanceResult s = cold(a, b, relative_pose(pose_a, pose_b));
    if (s.status == DistanceStatus::kBadPose) return;  // too far away
    EXPECT_EQ(s.distance, factor * r.distance) << e.name;
    EXPECT_EQ(s.lower, factor * r.lower) << e.name;
    EXPECT_EQ(s.upper, factor * r.upper) << e.name;
    EXPECT_EQ(s.status, r.status) << e.name;
    EXPECT_EQ(s.iterations, r.iterations) << e.name;
  });
}

TEST(Distance, GivesTheSameBitsForTheSameQuestion) {
  for_each_example([](const Example& e, Random&) {
    const DistanceResult r = cold(e.a, e.b, e.pose()), s = cold(e.a, e.b, e.pose());
    EXPECT_EQ(r.lower, s.lower) << e.name;
    EXPECT_EQ(r.upper, s.upper) << e.name;
    EXPECT_EQ(r.point_on_a, s.point_on_a) << e.name;
    EXPECT_EQ(r.point_on_b, s.point_on_b) << e.name;
  });
}

TEST(Distance, AllocatesNothing) {
  for_each_example([](const Example& e, Random& random) {
    TrackingState tracked;
    TrackingState wrong = test::nonsense_state(e.a, e.b, random);
    const std::uint64_t before = allocations();
    const RelativePose pose = e.pose();
    (void)distance(e.a, e.b, pose, tracked);
    (void)distance(e.a, e.b, pose, tracked);
    (void)distance(e.a, e.b, pose, wrong);
    EXPECT_EQ(allocations(), before) << e.name;
  });
}

}  // namespace
}  // namespace clearance
