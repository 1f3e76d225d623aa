#include "monitor/bodies/displacement.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

Pose turned(const Pose& pose, const Vec3& axis, double angle) {
  Pose result = pose;
  result.orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())) * pose.orientation;
  return result;
}

TEST(Displacement, NoPointMovesFartherThanTheBound) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Pose before = random.pose(5.0);
    const double scale = std::pow(10.0, random.uniform(-15.0, 0.0));
    Pose after = turned(before, random.in_box(1.0), scale * random.uniform(-3.2, 3.2));
    after.position += scale * random.in_box(2.0);
    after.orientation.coeffs() *= random.uniform(0.9991, 1.0009) * (i % 2 == 0 ? 1.0 : -1.0);
    const Motion motion = motion_between(before, after);
    for (int k = 0; k < 4; ++k) {
      const Vec3 point = random.in_box(2.0);
      const test::LongVec exact = point.cast<long double>();
      const long double moved = (test::exactly(after, exact) - test::exactly(before, exact)).norm();
      // rounds in either direction; the factor below accounts for it
      const double reach = static_cast<double>(exact.norm());
      ASSERT_LE(moved, moved_at_most(motion, reach * (1.0 + 1e-15))) << "case " << i;
    }
  }
}

TEST(Displacement, NoPointIsEverFartherFromItsStraightPathThanTheBend) {
  Random random(2);
  double tightest = 1.0;
  for (int i = 0; i < 5000; ++i) {
    const Pose before = random.pose(5.0);
    const double scale = std::pow(10.0, random.uniform(-4.0, 0.0));
    const Vec3 axis = random.in_box(1.0);
    Pose after = turned(before, axis, scale * random.uniform(-3.1, 3.1));
    after.position += random.in_box(scale);
    const Vec3 across = before.orientation.conjugate() * axis.unitOrthogonal();
    const Vec3 point = i % 2 == 0 ? across : random.in_box(2.0);
    const double told = bend_at_most(motion_between(before, after), point.norm());
    double most = 0.0;
    for (int k = 0; k <= 10; ++k) {
      const Vec3 straight =
          transform(before, point) + 0.1 * k * (transform(after, point) - transform(before, point));
      most = std::max(most,
                      (transform(test::between(before, after, 0.1 * k), point) - straight).norm());
    }
    ASSERT_LE(most, told + 1e-14) << "case " << i;
    tightest = std::min(tightest, told > 1e-9 ? 1.0 - most / told : 1.0);
  }
  EXPECT_LT(tightest, 0.25);
}

TEST(Displacement, IsTightForAPointThatMovesStraightAndForOneThatTurns) {
  const Pose before = test::at(1.0, 2.0, 3.0);
  const Pose shifted = test::at(1.0, 2.5, 3.0);
  EXPECT_NEAR(moved_at_most(motion_between(before, shifted), 7.0), 0.5, 1e-12);
  const Pose spun = turned(before, Vec3::UnitZ(), 0.01);
  EXPECT_NEAR(moved_at_most(motion_between(before, spun), 7.0), 7.0 * 2.0 * std::sin(0.005), 1e-6);
}

TEST(Displacement, EqualPosesAreExactlyNoMotionEvenOfUnboundedBodies) {
  const Pose pose = Random(2).pose(3.0);
  EXPECT_EQ(moved_at_most(motion_between(pose, pose), kInfinity), 0.0);
}

TEST(Displacement, NorThroughAnyPoseOnTheStraightPathAndTheShorterTurn) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Pose before = random.pose(5.0);
    const Vec3 axis = random.in_box(1.0), shift = random.in_box(1.0);
    const double angle = random.uniform(-3.14, 3.14), part = random.uniform(0.0, 1.0);
    Pose between = turned(before, axis, part * angle), after = turned(before, axis, angle);
    between.position += part * shift;
    after.position += shift;
    const Vec3 x = random.in_box(2.0);
    const double there = (transform(between, x) - transform(before, x)).norm();
    const double on = (transform(after, x) - transform(between, x)).norm();
    ASSERT_LE(there + on, moved_at_most(motion_between(before, after), x.norm()) + 1e-13);
  }
}

TEST(Displacement, AHalfTurnIsTwoQuarterTurnsAtMost) {
  const Pose spun = turned({}, Vec3(1.0, -2.0, 0.5), M_PI);
  EXPECT_NEAR(motion_between({}, spun).turn, 2.0 * std::sqrt(2.0), 1e-12);
}

TEST(Displacement, TheOppositeQuaternionIsTheSameOrientation) {
  const Pose pose = Random(3).pose(3.0);
  Pose opposite = pose;
  opposite.orientation.coeffs() *= -1.0;
  EXPECT_LT(moved_at_most(motion_between(pose, opposite), 1.0), 1e-14);
}

TEST(Displacement, ANormThatIsOffCountsAsWhatItIsScaledFrom) {
  Random random(5);
  for (int i = 0; i < 20'000; ++i) {
    Pose before = random.pose(1.0), after = turned(before, random.in_box(1.0), 1e-14 * (i % 7));
    for (Pose* pose : {&before, &after}) {
      pose->orientation.coeffs() *=
          1.0 + std::pow(2.0, random.uniform(-53.0, -9.0)) * (i % 2 - 0.5);
    }
    using Exact = Eigen::Matrix<long double, 4, 1>;
    const Exact from = before.orientation.coeffs().cast<long double>().normalized();
    const Exact to = after.orientation.coeffs().cast<long double>().normalized();
    const auto turn = static_cast<double>(2.0L * (to - from).norm());
    const double told =
        motion_between({.orientation = before.orientation}, {.orientation = after.orientation})
            .turn;
    ASSERT_LE(turn, told) << "case " << i;
    ASSERT_LE(told, turn + 2.0 * kTurnRounding) << "case " << i;
  }
}

TEST(Displacement, ShiftsTooSmallToSquareStillCount) {
  EXPECT_GE(motion_between(test::at(0, 0, 0), test::at(1e-200, 0, 0)).shift, 1e-200);
}

}  // namespace
}  // namespace clearance
