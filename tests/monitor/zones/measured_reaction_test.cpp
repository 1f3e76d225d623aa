// The measured part of a robot's reaction in S_p, beside the same reaction stated.
#include <gtest/gtest.h>

#include "tests/monitor/zones/meeting.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {
namespace {

// The stated reaction of the one is what is stated and measured of the other. The distance of the
// measured one is on the safe side of it, by no more than rounding.
TEST(MeasuredReaction, GivesWhatTheSameReactionGivesWhereItIsStated) {
  Random random(62);
  for (int i = 0; i < 500; ++i) {
    const std::int64_t delay_ns = random.integer(0, 80'000'000);
    Separation terms = usual_terms();
    terms.robot_acceleration = random.chance(0.5) ? 2.0 : 0.0;
    Separation stated = terms;
    stated.reaction_time_ns += delay_ns;
    terms.reaction_is_measured = true;
    Meeting measured(terms), other(stated);
    measured.delay_ns = delay_ns;
    const double x = random.uniform(0.4, 2.0), speed = random.uniform(-0.5, 1.5);
    const PairSeparation found = measured.tick(x, 0.0, speed);
    const PairSeparation expected = other.tick(x, 0.0, speed);
    ASSERT_EQ(found.validity, SeparationValidity::kMeasured);
    ASSERT_GE(found.protective_distance, expected.protective_distance);
    ASSERT_NEAR(found.protective_distance, expected.protective_distance, 1e-9);
    ASSERT_LE(found.speed_limit, expected.speed_limit + 1e-9);
    ASSERT_NEAR(found.scaling, expected.scaling, 1e-9);
  }
}

TEST(MeasuredReaction, IsUnknownUntilThereIsAMeasurement) {
  Separation terms = usual_terms();
  terms.reaction_is_measured = true;
  Meeting meeting(terms);
  meeting.delay_ns = TickTime::kNotMeasured;
  const PairSeparation unknown = meeting.tick(2.0, 0.0, 0.5);
  EXPECT_EQ(unknown.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(unknown.scaling, 0.0);
  EXPECT_EQ(unknown.speed_limit, 0.0);
  EXPECT_EQ(unknown.remaining, -kInfinity);
  meeting.delay_ns = 0;
  EXPECT_EQ(meeting.tick(2.0, 0.0, 0.5).validity, SeparationValidity::kMeasured);
}

TEST(MeasuredReaction, CountsOnlyWhereNoneIsStated) {
  Meeting meeting, other;
  other.delay_ns = 50'000'000;
  const PairSeparation at_once = meeting.tick(2.0, 0.0, 0.5);
  EXPECT_EQ(other.tick(2.0, 0.0, 0.5).protective_distance, at_once.protective_distance);
}

}  // namespace
}  // namespace clearance::test
