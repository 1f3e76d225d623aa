// Two samples of one message that agree count as one, and others are a contradiction.
//
// Oracle: the numbers that each sample states, compared as lists, for all samples of a few values.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

TEST(SameSamples, OfAJointSayTheSamePositionAndTheSameVelocityOrNone) {
  constexpr double kVelocities[] = {0.0, 1.0, kNoNumber};
  test::EveryChoice choice;
  const auto drawn = [&] {
    JointSample sample;
    sample.position = choice.flag() ? 1.0 : 0.0;
    sample.velocity = kVelocities[choice.of(3)];
    sample.has_velocity = choice.flag();
    return sample;
  };
  // -1: a velocity that the driver does not know; -2: no velocity.
  const auto said = [](const JointSample& sample) {
    const double velocity = std::isnan(sample.velocity) ? -1.0 : sample.velocity;
    return std::vector{sample.position, sample.has_velocity ? velocity : -2.0};
  };
  while (choice.next()) {
    const JointSample a = drawn(), b = drawn();
    EXPECT_EQ(say_the_same(a, b), said(a) == said(b)) << choice.runs();
  }
  EXPECT_EQ(choice.runs(), 144u);
}

TEST(SameSamples, OfAnObjectSayTheSamePoseAndTheSameTwistOrNone) {
  test::EveryChoice choice;
  const auto drawn = [&] {
    PoseSample sample;
    sample.world_from_object.position.y() = choice.flag() ? 1.0 : 0.0;
    if (choice.flag()) sample.world_from_object.orientation = {0.0, 1.0, 0.0, 0.0};
    sample.twist.linear.z() = choice.flag() ? 1.0 : 0.0;
    sample.twist.angular.x() = choice.flag() ? 1.0 : 0.0;
    sample.has_twist = choice.flag();
    return sample;
  };
  const auto said = [](const PoseSample& sample) {
    const double linear = sample.twist.linear.z(), angular = sample.twist.angular.x();
    return std::vector{sample.world_from_object.position.y(),
                       sample.world_from_object.orientation.x(), sample.has_twist ? linear : -1.0,
                       sample.has_twist ? angular : -1.0};
  };
  while (choice.next()) {
    const PoseSample a = drawn(), b = drawn();
    EXPECT_EQ(say_the_same(a, b), said(a) == said(b)) << choice.runs();
  }
  EXPECT_EQ(choice.runs(), 1024u);
}

TEST(SameSamples, OfAnObjectDifferIfAnyOneOfTheirNumbersDoes) {
  PoseSample sample;
  sample.has_twist = true;
  for (std::size_t i = 0; i < 13; ++i) {
    PoseSample other = sample;
    Vec3& triple = i < 3   ? other.world_from_object.position
                   : i < 6 ? other.twist.linear
                           : other.twist.angular;
    (i < 9 ? triple[i % 3] : other.world_from_object.orientation.coeffs()[i - 9]) += 0.5;
    EXPECT_FALSE(say_the_same(sample, other)) << i;
  }
}

}  // namespace
}  // namespace clearance
