// When an input was contradicted, by the stamps of its samples. Oracle: a list of all
// contradictions.
#include "monitor/inputs/past_values.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "monitor/bodies/tracked_variable.hpp"
#include "monitor/inputs/track.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

TEST(PastValues, AreNotKnownFromTheValueBeforeAContradictionUntilTheNextOne) {
  PastValues<double> past(8);
  EXPECT_FALSE(past.is_contradicted(0));
  past.use(1000, 0.0);
  past.contradict(3000, 100);
  EXPECT_FALSE(past.is_contradicted(1000)) << "the value itself was taken";
  EXPECT_TRUE(past.is_contradicted(1001));
  EXPECT_TRUE(past.is_contradicted(1'000'000)) << "none was taken since";
  past.use(5000, 0.0);
  EXPECT_TRUE(past.is_contradicted(4999));
  EXPECT_FALSE(past.is_contradicted(5000));
  EXPECT_TRUE(past.is_contradicted(4000, 6000)) << "at some time of these";
  past.contradict(5050, 100);
  past.use(5060, 0.0);
  EXPECT_TRUE(past.is_contradicted(4950)) << "either value may be wrong";
  EXPECT_TRUE(past.is_contradicted(5150));
  EXPECT_FALSE(past.is_contradicted(5151));
  past.clear();
  EXPECT_FALSE(past.is_contradicted(5050));
  EXPECT_TRUE(past.values().empty());
}

// Samples may come in another order than they were made.
TEST(PastValues, AreNotKnownAroundAContradictionOfBeforeTheLastOne) {
  PastValues<double> past(8);
  past.contradict(5000, 100);
  past.contradict(1000, 100);
  for (const std::int64_t at : {900, 1100, 4900, 5100}) EXPECT_TRUE(past.is_contradicted(at)) << at;
  EXPECT_FALSE(past.is_contradicted(899));
  past.use(6000, 0.0);
  EXPECT_FALSE(past.is_contradicted(6000));
}

TEST(Track, IsSetBackByASampleOfItsOwnSourceFromLongBeforeTheValueInUse) {
  constexpr std::int64_t kStamp = 5 * kSetBackNs;
  for (const bool has_value : {false, true}) {
    for (const std::uint32_t source : {1u, 2u}) {
      for (const std::int64_t older : {std::int64_t{0}, kSetBackNs, kSetBackNs + 1}) {
        Track<TrackedVariable, double> track({}, 4);
        track.now.input.has_value = has_value;
        track.now.input.stamp_ns = kStamp;
        track.now.input.owner.take(1, kStamp);
        EXPECT_EQ(track.is_set_back({.source = source, .stamp_ns = kStamp - older}),
                  has_value && source == 1 && older > kSetBackNs);
      }
    }
  }
}

// Few times are kept, and the oldest ones are joined.
TEST(PastValues, ForgetNoTimeAtWhichTheyWereContradicted) {
  Random random(3);
  for (int run = 0; run < 200; ++run) {
    PastValues<double> past(16);
    std::vector<std::int64_t> refused;
    std::int64_t stamp = 0;
    for (int i = 0; i < 60; ++i) {
      stamp += random.integer(1, 400);
      if (random.chance(0.7)) {
        past.use(stamp, 0.0);
      } else {
        past.contradict(stamp, 50);
        refused.push_back(stamp);
      }
    }
    for (const std::int64_t at : refused) {
      for (const std::int64_t off : {-50, 0, 50}) EXPECT_TRUE(past.is_contradicted(at + off));
    }
    past.use(stamp + 1, 0.0);
    EXPECT_FALSE(past.is_contradicted(stamp + 51)) << "nor does it invent any";
  }
}

}  // namespace
}  // namespace clearance
