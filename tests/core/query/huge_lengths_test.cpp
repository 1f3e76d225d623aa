// Lengths up to the largest double, where sums and squares overflow: what is said must be true, or
// that nothing is known. Oracle: the exact distance of tests/shared/exact_oracle.hpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "core/batch.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using oracle::Body;

constexpr double kMost = std::numeric_limits<double>::max();

// Mostly near the end of the doubles, of either sign; now and then exactly there.
double huge(Random& random) {
  const double sign = random.sign();
  if (random.chance(0.15)) return 0.0;
  if (random.chance(0.1)) return sign * kMost;
  const double least = random.chance(0.6) ? 1e307 : 1e90;
  return sign * random.log_uniform(least, 1.7e308);
}

Vec3 huge_point(Random& random) {
  const double x = huge(random), y = huge(random), z = huge(random);
  return {x, y, z};
}

// As large as shapes may be.
double shape_size(Random& random) {
  return random.chance(0.3) ? kLargestCoordinate : random.log_uniform(1e-3, kLargestCoordinate);
}

Body solid(Random& random) {
  const double size = 0.5 * shape_size(random);
  switch (random.integer(0, 3)) {
    case 0:
      return hard::box(Vec3::Constant(size));
    case 1:
      return hard::scaled(hard::plate(random, 0.1), size);
    case 2:
      return hard::scaled(hard::random_hull(random, 8), size);
    default:
      return {{{Vec3::UnitZ(), size}}, {}, 0.0};
  }
}

Body any_body(Random& random) {
  if (random.chance(0.4)) {
    Body out = solid(random);
    if (random.chance(0.3)) out.radius = shape_size(random);
    return out;
  }
  Body out{{}, {random.in_box(shape_size(random))}, 0.0};
  if (random.chance(0.5)) out.points.push_back(random.in_box(shape_size(random)));
  if (random.chance(0.7)) out.radius = shape_size(random);
  return out;
}

Pose any_pose(Random& random) {
  const Vec3 position = random.chance(0.3) ? random.in_box(1e9) : huge_point(random);
  return {position, random.chance(0.4) ? Eigen::Quaterniond::Identity() : random.rotation()};
}

// What is wrong with it; empty when nothing.
std::string fault_of(const DistanceResult& r, const oracle::ExactDistance& truth,
                     bool depth_known) {
  if (std::isnan(r.lower) || std::isnan(r.upper)) return "a bound is a NaN";
  if (!r.normal.allFinite()) return "the normal is not finite";
  if (!r.point_on_a.allFinite() || !r.point_on_b.allFinite()) return "a point is not finite";
  const bool unknown = r.upper == kInfinity;
  if (unknown && r.status != DistanceStatus::kIterationLimit) return "unknown, but has a status";
  if (unknown && (r.distance != -kInfinity || !r.normal.isZero(0.0)))
    return "unknown, but says more";
  if (!(r.lower <= r.upper)) return "the bounds are the wrong way round";
  if (truth.compare(r.lower) < 0) return "the lower bound is above the truth";
  if (depth_known && truth.compare(r.upper) > 0) return "the upper bound is below the truth";
  const bool converged = r.status == DistanceStatus::kConverged;
  if (!(r.lower <= r.distance && r.distance <= r.upper)) return "the distance is not in the bounds";
  if (converged && !(r.lower > 0.0)) return "converged, but not apart";
  if (r.status == DistanceStatus::kOverlapping && !(r.upper < 0.0)) return "overlapping, it says";
  return "";
}

std::string text(const DistanceResult& r, const oracle::ExactDistance& truth) {
  char out[300];
  std::snprintf(out, sizeof out, "%s %g in [%g, %g], truth [%g, %g], normal %g %g %g",
                name(r.status), r.distance, r.lower, r.upper, truth.lower, truth.upper,
                r.normal.x(), r.normal.y(), r.normal.z());
  return out;
}

struct HugePair {
  Body a, b;
  std::vector<std::array<Pose, 2>> steps;
};

HugePair pair_of(std::uint64_t seed) {
  Random random(seed);
  HugePair out;
  out.a = any_body(random);
  out.b = any_body(random);
  for (int k = 0; k < 4; ++k) {
    const Pose pose_a = any_pose(random);
    out.steps.push_back({pose_a, random.chance(0.2) ? pose_a : any_pose(random)});
    out.steps.push_back(out.steps.back());
  }
  return out;
}

TEST(HugeLengths, HaveBoundsThatHoldOrNone) {
  int asked = 0, known = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const HugePair pair = pair_of(seed);
    DistanceJudge judge(pair.a, pair.b);
    ASSERT_EQ(judge.refusal(), "") << seed;
    const ConvexPolyhedron* const bodies[] = {&judge.a(), &judge.b()};
    const BodyPair pairs[] = {{0, 1}};
    DistanceBatch batch(bodies, pairs);
    TrackingState state, other_state;
    for (const auto& poses : pair.steps) {
      const oracle::ExactDistance truth = judge.truth(poses[0], poses[1]);
      const bool depth_known = !truth.cores_meet() || truth.squared_depth != 0 ||
                               (pair.a.rows.empty() && pair.b.rows.empty());
      const DistanceResult cold = judge.ask(poses[0], poses[1], other_state);
      const DistanceResult tracked = distance(judge.a(), judge.b(), poses[0], poses[1], state);
      TrackingState none;
      const DistanceResult far = distance(judge.a(), judge.b(), relative_pose(poses[0], poses[1]),
                                          none, {.far_away = 1.0});
      EXPECT_EQ(fault_of(far, truth, depth_known), "") << seed << ' ' << text(far, truth);
      const DistanceResult& batched = batch.evaluate(poses)[0];
      EXPECT_EQ(fault_of(cold, truth, depth_known), "") << seed << ' ' << text(cold, truth);
      EXPECT_EQ(fault_of(tracked, truth, depth_known), "") << seed << ' ' << text(tracked, truth);
      EXPECT_TRUE(same_bits(tracked, batched)) << seed << ' ' << text(batched, truth);
      ++asked;
      known += std::isfinite(tracked.lower) && std::isfinite(tracked.upper);
    }
  }
  EXPECT_GT(known, asked / 10);
}

}  // namespace
}  // namespace clearance
