// The error account is applied: both bounds of every answer are as far from its distance as
// core/ROUNDING.md says.
//
// Oracle: the account, summed again from its constants. That the constants cover all roundings is
// the claim of RoundingCounts in tests/core/model and tests/core/curved. In each case one term of
// the account outweighs the others, so that no term can be missing or halved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/curved/bounds.hpp"
#include "core/model/error_bounds.hpp"
#include "core/query/search.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::made;

// A sum of the account is itself rounded, and so is its difference from a distance.
constexpr double kRounded = 1.0 - 0x1p-30;
double ulps(double count, double length) { return count * kUlp * std::abs(length); }

// The lengths of a pair that the account weighs, m.
struct Lengths {
  double a, b, between;

  Lengths(const ConvexBody& body_a, const ConvexBody& body_b, const RelativePose& a_from_b)
      : a(body_a.bounding_radius),
        b(body_b.bounding_radius),
        between(a_from_b.translation.norm()) {}
  [[nodiscard]] double size() const { return a + b + between; }
};

double stated_errors(const ConvexBody& a, const ConvexBody& b) {
  return a.position_error + b.position_error;
}

// The rounding errors of an answer, as multiples of kUlp times the lengths of a pair.
struct Roundings {
  double on_a, on_b, between;
};
constexpr Roundings kOfPolyhedra{kUlpsOnA, kUlpsOnB, kUlpsBetween};
constexpr Roundings kOfCurvedBodies{kUlpsOfA, kUlpsOfB, kUlpsOfOffset};

// Returns the error of a distance, m.
double account(const Roundings& roundings, const ConvexBody& a, const ConvexBody& b,
               const RelativePose& a_from_b, double distance) {
  const Lengths of(a, b, a_from_b);
  const double turned = std::min(of.b, of.a + of.between + kStretched * distance);
  return ulps(roundings.on_a, of.a) + ulps(roundings.on_b, of.b) +
         ulps(roundings.between, of.between) + stated_errors(a, b) +
         kTranslationError * of.between + kRotationError * turned;
}

// A box of this size with a stated error of its places, m.
ConvexBody box_of(Random& random, double size, double error) {
  ConvexBody body = made(box(
      size * Vec3(random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), random.uniform(0.3, 1.0))));
  body.position_error = error;
  add_query_tables(body);
  return body;
}

// Sizes of the bodies and the distance between them, and what is known of the places on the bodies,
// m.
struct Weights {
  double a, b, distance, error_a, error_b;
};
constexpr Weights kWeights[] = {{1, 1, 1, 0, 0},    {1000, 1, 1, 0, 0},    {1, 1000, 1, 0, 0},
                                {1, 1, 1e6, 0, 0},  {1e-3, 1e3, 10, 0, 0}, {1, 1, 1, 1e-9, 0},
                                {1, 1, 1, 0, 1e-9}, {1e3, 1e-3, 10, 0, 0}};

struct WeighedExample {
  ConvexBody a, b;
  Pose pose_a, pose_b;
  [[nodiscard]] RelativePose pose() const { return relative_pose(pose_a, pose_b); }
};

// Two boxes whose bounding spheres are `distance` apart; negative: they overlap by as much.
WeighedExample example_of(const Weights& w, Random& random) {
  WeighedExample e{box_of(random, w.a, w.error_a), box_of(random, w.b, w.error_b), {}, {}};
  e.pose_a = {random.in_box(1.0), random.rotation()};
  const double apart = e.a.bounding_radius + e.b.bounding_radius + w.distance;
  e.pose_b = {e.pose_a.position + std::max(apart, 0.0) * random.direction(), random.rotation()};
  return e;
}

void for_each_example(const std::function<void(const WeighedExample&)>& visit) {
  Random random(1);
  for (const Weights& w : kWeights) {
    for (int k = 0; k < 60; ++k) visit(example_of(w, random));
  }
}

// `tilted`: the lower bound of two edges, which may be above their distance by the rounding of
// both.
void expect_account(const WeighedExample& e, const DistanceResult& r, const TrackingState& state) {
  const double error =
      account(kOfPolyhedra, e.a, e.b, e.pose(), r.distance) * kRounded - ulps(2, r.distance);
  const bool edges = state.a.kind == FeatureKind::kEdge && state.b.kind == FeatureKind::kEdge;
  const double tilted = edges ? ulps(8, Lengths(e.a, e.b, e.pose()).size()) : 0.0;
  EXPECT_LE(r.lower, r.distance - error + tilted);
  EXPECT_GE(r.upper, r.distance + error);
}

TEST(ErrorAccount, IsAppliedToTrackedFeatures) {
  int tracked = 0;
  for_each_example([&](const WeighedExample& e) {
    TrackingState by_pose, by_poses;
    const DistanceResult r = distance(e.a, e.b, e.pose(), by_pose);
    const DistanceResult s = distance(e.a, e.b, e.pose_a, e.pose_b, by_poses);
    ASSERT_EQ(r.status, DistanceStatus::kConverged);
    if (r.path != DistancePath::kFeatureTracking) return;
    ++tracked;
    expect_account(e, r, by_pose);
    expect_account(e, s, by_poses);
  });
  EXPECT_GT(tracked, 400);
}

TEST(ErrorAccount, IsAppliedByTheSearch) {
  int searched = 0;
  for_each_example([&](const WeighedExample& e) {
    TrackingState state;
    const DistanceResult r = search({e.a, e.b, e.pose(), state});
    if (r.path == DistancePath::kGjk) return;
    ++searched;
    const double error = account(kOfPolyhedra, e.a, e.b, e.pose(), r.distance) * kRounded;
    const double gap = kGapToleranceUlps[0] * kUlp * Lengths(e.a, e.b, e.pose()).size();
    EXPECT_LE(r.lower, r.distance - error + gap);
    EXPECT_GE(r.upper, r.distance + error - ulps(2, r.distance));
  });
  EXPECT_GT(searched, 200);
}

// Points of which every figure is exact: 7 spacings of error, and a spacing for the sum of the
// radii.
TEST(ErrorAccount, IsAppliedToRadii) {
  const ConvexBody a = made(point(Vec3::Zero(), 0.25)), b = made(point(Vec3::Zero(), 0.5));
  const DistanceResult r = test::cold(a, b, Pose{.position = Vec3::UnitX()});
  const double of_pose = (kUlpsBetween * kUlp + kPermutedTranslationError) * 1.0;
  const double of_radii = 0x1p-53;  // kRadiusRounding times 0.75 + 0.25, rounded to the next double
  EXPECT_EQ(r.distance, 0.25);
  EXPECT_LE(r.lower, 0.25 - of_pose - of_radii);
  EXPECT_GE(r.upper, 0.25 + of_pose + of_radii);
}

// An unbounded body has its features as far out as the closest points may lie.
TEST(ErrorAccount, GrowsWithThePlaceOnAnUnboundedBody) {
  Random random(2);
  const ConvexBody floor = test::half_space(Vec3(0, 0.6, 0.8), 0.1);
  for (int k = 0; k < 100; ++k) {
    const ConvexBody body = box_of(random, 1.0, 0.0);
    const Pose of_floor = random.pose(1.0);
    const Vec3 above = Vec3(0, 60, 90) + random.in_box(3.0);
    const RelativePose pose =
        relative_pose(of_floor, {transform(of_floor, above), random.rotation()});
    TrackingState state;
    const DistanceResult r = distance(floor, body, pose, state);
    ASSERT_EQ(r.status, DistanceStatus::kConverged);
    const double between = pose.translation.norm();
    const double out = body.bounding_radius + between + r.distance;
    const double error =
        (ulps(kUlpsOnA, out) + ulps(kUlpsOnB, body.bounding_radius) + ulps(kUlpsBetween, between) +
         kTranslationError * between + kRotationError * body.bounding_radius) *
            kRounded -
        ulps(2, r.distance);
    EXPECT_LE(r.lower, r.distance - error);
    EXPECT_GE(r.upper, r.distance + error);
  }
}

// The search for the depth has 12 roundings of the size more, and the rotation may stretch the
// depth up to B's extent.
TEST(ErrorAccount, IsAppliedToDepths) {
  constexpr Weights kOverlaps[] = {{1, 1, -1.3, 0, 0},    {1000, 1, -300, 0, 0},
                                   {1, 1000, -300, 0, 0}, {1, 1, -1.3, 1e-9, 0},
                                   {1, 1, -1.3, 0, 1e-9}, {1e-3, 1e3, -2e3, 0, 0}};
  Random random(3);
  int overlapping = 0;
  for (const Weights& w : kOverlaps) {
    for (int k = 0; k < 40; ++k) {
      const WeighedExample e = example_of(w, random);
      const RelativePose pose = e.pose();
      TrackingState state;
      for (int query = 0; query < 2; ++query) {  // cold, then tracked
        const DistanceResult r = distance(e.a, e.b, pose, state);
        if (r.status != DistanceStatus::kOverlapping) break;
        ++overlapping;
        const Lengths of(e.a, e.b, pose);
        const double depth = -r.distance;
        const double scaled = std::clamp(of.b - of.a - of.between, 0.0, depth);
        const double of_distance =
            account(kOfPolyhedra, e.a, e.b, pose, 0.0) * kRounded - ulps(2, depth);
        const double of_depth = of_distance + ulps(12, of.size()) + kRotationError * scaled;
        // Features that certify a depth at once are judged like those of disjoint bodies.
        const bool by_features = query > 0 || r.path == DistancePath::kPenetration;
        EXPECT_GE(r.upper, r.distance + (by_features ? of_distance : of_depth));
        // Along a facet of the other body, support values certify the depth from above, without
        // the 12.
        EXPECT_LE(r.lower, r.distance - of_distance + ulps(10, of.size()));
      }
    }
  }
  EXPECT_GT(overlapping, 100);
}

// The facets of a body with a stated error may lie nearer to its interior point by that error.
TEST(ErrorAccount, IsAppliedToTheBallWithinABody) {
  Random random(8);
  for (const double error : {1e-9, 1e-3, 0.1}) {
    const ConvexBody exact = box_of(random, 1.0, 0.0);
    ConvexBody body = exact;
    body.position_error = error;
    add_query_tables(body);
    EXPECT_NEAR(exact.inner_radius - body.inner_radius, error, 1e-15);
    body.position_error = 1.0;
    add_query_tables(body);
    EXPECT_EQ(body.inner_radius, 0.0) << "none is certain";
  }
}

// ---- curved bodies ----
ConvexBody curved_of(Random& random, double size, double error, double rounding) {
  const Vec3 axes =
      size * Vec3(random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), random.uniform(0.3, 1.0));
  ConvexBody body = random.chance(0.5)
                        ? made(ellipsoid(axes, rounding))
                        : made(truncated_cone(axes.x(), axes.y(), axes.z(), rounding));
  body.position_error = error;
  return body;
}

// The account has 4 roundings of the radii and of their difference from a bound; the result itself
// has fewer.
TEST(ErrorAccount, IsAppliedToCurvedBodies) {
  Random random(5);
  for (const Weights& w : kWeights) {
    for (int k = 0; k < 100; ++k) {
      const double rounding = k % 2 == 0 ? 0.0 : random.log_uniform(0.01, 1e3);
      const ConvexBody a = curved_of(random, w.a, w.error_a, rounding);
      const ConvexBody b =
          k % 3 == 0 ? box_of(random, w.b, w.error_b) : curved_of(random, w.b, w.error_b, 0.0);
      const double apart = a.bounding_radius + b.bounding_radius + rounding + w.distance;
      const Pose pose_a = random.pose(1.0);
      const RelativePose pose =
          relative_pose(pose_a, {pose_a.position + apart * random.direction(), random.rotation()});
      TrackingState state;
      const DistanceResult r = distance(a, b, pose, state);
      ASSERT_GT(r.lower, 0.0);
      const double bare = r.distance + rounding;  // between the bodies without their radii
      const double error = account(kOfCurvedBodies, a, b, pose, bare) * kRounded;
      // The computed lower bound may be above the distance by the roundings of both.
      EXPECT_LE(r.lower, r.distance - error + ulps(6, Lengths(a, b, pose).size()));
      EXPECT_GE(r.upper, r.distance + error + ulps(0.5, rounding + bare));
    }
  }
}

// There both bounds are one number before the account.
TEST(ErrorAccount, IsAppliedToCurvedBodiesOverHalfSpaces) {
  Random random(6);
  const ConvexBody floor = test::half_space(Vec3::UnitZ(), 3.0);
  for (const double size : {1e-2, 1.0, 1e3}) {
    for (int k = 0; k < 50; ++k) {
      const double rounding = k % 2 == 0 ? 0.0 : random.log_uniform(0.01, 1e3);
      const ConvexBody body = curved_of(random, size, 0.0, rounding);
      const Pose of_floor = random.pose(1.0);
      const Vec3 above(random.uniform(-1.0, 1.0), 0, 3.0 + rounding + size * random.uniform(2, 4));
      const RelativePose pose =
          relative_pose(of_floor, {transform(of_floor, above), random.rotation()});
      TrackingState state;
      const DistanceResult r = distance(floor, body, pose, state);
      ASSERT_GT(r.lower, 0.0);
      const double between = pose.translation.norm(), bare = r.distance + rounding;
      const double error =
          (ulps(27, body.bounding_radius) + ulps(5, 3.0) + ulps(13, between) +
           kTranslationError * between + kRotationError * (body.bounding_radius + between)) *
              kRounded +
          ulps(0.5, rounding + bare);
      EXPECT_LE(r.lower, r.distance - error);
      EXPECT_GE(r.upper, r.distance + error);
    }
  }
}

// A link's place has more of an error than roundings. Bounds widen by it and have converged all the
// same.
TEST(ErrorAccount, OfAPlaceDoesNotDecideWhetherBoundsHaveConverged) {
  const ConvexBody a = made(ellipsoid({0.3, 0.2, 0.1})), b = made(cylinder(0.2, 0.3));
  for (const double gap : {0.0, 0.7e-13, 0.8e-13, 0.88e-13, 1.1e-13}) {
    for (const double lower : {0.5, -0.05}) {
      for (const double error : {0.0, 1e-14, 1e-12, 1e-6}) {
        CurvedConclusion found;
        found.size = a.bounding_radius + b.bounding_radius + 1.0;
        found.lower = lower;
        found.upper = lower + gap * found.size;
        found.error = error;
        found.normal = Vec3::UnitZ();
        const DistanceResult r = conclude(a, b, found);
        const auto converged =
            lower > 0.0 ? DistanceStatus::kConverged : DistanceStatus::kOverlapping;
        EXPECT_EQ(r.status, gap < 1e-13 ? converged : DistanceStatus::kIterationLimit)
            << gap << ", error " << error;
        EXPECT_LE(r.lower, found.lower - error);
        EXPECT_GE(r.upper, found.upper + error);
      }
    }
  }
}

}  // namespace
}  // namespace clearance
