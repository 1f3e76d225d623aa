// Oracle: points of one object in the other's frame, at many instants of the interpolated motion.
#include "monitor/bodies/relative_displacement.hpp"

#include <gtest/gtest.h>

#include "monitor/bodies/tracked_object.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// The state after a tick that moved the object from one pose to another.
TrackedObject gone(const Pose& from, const Pose& to, double bounding_radius) {
  const Object object = test::moving("gone", {test::ball(0.1)});
  TrackedObject state;
  for (const std::int64_t now : {kStart, kStart + kTick}) {
    EXPECT_FALSE(
        take(object, test::sample(0, now == kStart ? from : to, now), now, {now, 0}, state));
    advance(object, now, state);
    displace(bounding_radius, state);
  }
  return state;
}

Pose after(const Pose& pose, const Vec3& shift, const Vec3& turn) {
  Pose next = pose;
  next.position += shift;
  if (turn.norm() > 0.0) {
    next.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * pose.orientation;
  }
  return next;
}

// The length of the path of a point of `of` in the frame of `seen_from`, summed over small steps.
double path_length(const Pose& from, const Pose& to, const Pose& frame_from, const Pose& frame_to,
                   const Vec3& point) {
  constexpr int kSteps = 50;
  double length = 0.0;
  Vec3 last = Vec3::Zero();
  for (int k = 0; k <= kSteps; ++k) {
    const double s = static_cast<double>(k) / kSteps;
    const Pose frame = test::between(frame_from, frame_to, s);
    const Vec3 seen = frame.orientation.normalized().conjugate() *
                      (transform(test::between(from, to, s), point) - frame.position);
    if (k > 0) length += (seen - last).norm();
    last = seen;
  }
  return length;
}

TEST(RelativeDisplacement, NoPointOfOneGoesFartherInTheFrameOfTheOther) {
  Random random(91);
  int tighter = 0;
  for (int i = 0; i < 3000; ++i) {
    const double radius_a = random.uniform(0.05, 2.0), radius_b = random.uniform(0.05, 2.0);
    const double scale = std::pow(10.0, random.uniform(-6.0, 0.0));
    const Pose a = random.pose(3.0), b = random.pose(3.0);
    // Rotations and translations are often nearly equal. They must cancel, but not too much.
    const Vec3 turn = scale * random.in_box(0.5), shift = scale * random.in_box(1.0);
    const double differ = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 1e-4 : 0.0;
    const Pose a_to = after(a, shift, turn);
    const Pose b_to = after(b, shift + differ * scale * random.in_box(1.0),
                            turn + differ * scale * random.in_box(0.5));
    const TrackedObject moved_a = gone(a, a_to, radius_a), moved_b = gone(b, b_to, radius_b);
    const double told = relative_displacement(moved_a.body_motion(), moved_b.body_motion());
    ASSERT_EQ(told, relative_displacement(moved_a.body_motion(), moved_b.body_motion()));
    const bool b_goes = radius_b <= radius_a;
    for (int k = 0; k < 4; ++k) {
      const Vec3 point = random.in_box(1.0).normalized() * (b_goes ? radius_b : radius_a);
      const double length =
          b_goes ? path_length(b, b_to, a, a_to, point) : path_length(a, a_to, b, b_to, point);
      ASSERT_LE(length, told + 1e-13) << "case " << i;
    }
    tighter += told < 0.9 * (moved_a.displacement + moved_b.displacement);
  }
  EXPECT_GT(tighter, 1500);
}

// A link rotates by 1 mrad about an axis 0.8 m away: both objects move by 0.8 to 1 mm.
TEST(RelativeDisplacement, WhatRidesOnTheSameLinkHardlyComesNearer) {
  Pose link, turned;
  turned.orientation = Eigen::AngleAxisd(1e-3, Vec3(1, 2, 2).normalized());
  const auto riding = [&](const Pose& on_link) {
    return gone(compose(link, on_link), compose(turned, on_link), 0.1);
  };
  const TrackedObject a = riding(test::at(1, 0, 0)), b = riding(test::at(1.2, 0.1, 0.3));
  EXPECT_GT(a.displacement + b.displacement, 1e-3);
  EXPECT_LT(relative_displacement(a.body_motion(), b.body_motion()), 1e-6);
  EXPECT_LT(relative_displacement(b.body_motion(), a.body_motion()), 1e-6);
}

TEST(RelativeDisplacement, AHalfSpaceThatTurnsIsTheFrameAndNotWhatIsSeen) {
  Pose turned;
  turned.orientation = Eigen::AngleAxisd(1e-3, Vec3::UnitX());
  const TrackedObject floor = gone({}, turned, kInfinity);
  const TrackedObject ball = gone(test::at(0, 1, 1), test::at(0, 1, 1.001), 0.1);
  EXPECT_LT(relative_displacement(floor.body_motion(), ball.body_motion()), 3e-3);
  EXPECT_LT(relative_displacement(ball.body_motion(), floor.body_motion()), 3e-3);
  const TrackedObject other = gone({}, turned, kInfinity);
  EXPECT_EQ(relative_displacement(floor.body_motion(), other.body_motion()), kInfinity);
}

TEST(RelativeDisplacement, TellsNothingOfMoreThanARadian) {
  Pose turned;
  turned.orientation = Eigen::AngleAxisd(1.5, Vec3::UnitX());
  const TrackedObject both = gone({}, turned, 0.1);
  EXPECT_EQ(relative_displacement(both.body_motion(), both.body_motion()), kInfinity);
}

// Two balls at a distance of 20 mm on one arm that swings at 2 m/s: they do not approach each other
// between two ticks.
TEST(RelativeDisplacement, IsWhatAPublishedPairIsReportedBy) {
  Scene scene = test::cell_of(
      {test::moving("hand", {test::ball(0.05)}), test::moving("tool", {test::ball(0.05)})});
  scene.pairs[0].publish = true;
  Monitor monitor(scene);
  for (int t = 0; t < 20; ++t) {
    Pose arm;
    arm.orientation = Eigen::AngleAxisd(2e-3 * t, Vec3::UnitZ());
    const std::array samples{
        test::sample(0, compose(arm, test::at(1, 0, 0)), kStart + t * kTick),
        test::sample(1, compose(arm, test::at(1.12, 0, 0)), kStart + t * kTick)};
    const PairReport& pair = monitor.tick(samples, kStart + t * kTick).pairs[0];
    ASSERT_NEAR(pair.lower, 0.02, 1e-12);
    ASSERT_NEAR(pair.swept_lower, 0.02, 1e-6) << "tick " << t << "; both have gone 2 mm";
  }
}

}  // namespace
}  // namespace clearance
