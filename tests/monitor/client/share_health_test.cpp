// Joins the health of the daemons of a cell's shares. The oracles are closed forms of what each
// says.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "monitor/client/share_merge.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::client {
namespace {

TEST(ShareHealth, AnInputIsAsOldAsTheShareThatKnowsLeastOfItSays) {
  std::vector<Sample<clearance_msg_Health>> of(2);
  const auto add = [](clearance_msg_Health& health, std::uint32_t object, std::int64_t age_ns) {
    clearance_msg_InputAge& age = health.inputs._buffer[health.inputs._length++];
    age = {};
    age.object = object;
    age.name = dds_string_dup("x");
    age.age_ns = age_ns;
    age.stale = age_ns < 0;
  };
  for (auto& health : of) {
    reserve_sequence(health->inputs, 2);
    health->recording = dds_string_dup("");
    health->tick_max_us = 5.0;
  }
  add(*of[0], 0, 7);
  add(*of[0], 1, 7);
  add(*of[1], 0, -1);
  of[1]->tick_max_us = 9.0;
  Sample<clearance_msg_Health> joined;
  join_health(std::vector<const clearance_msg_Health*>{&*of[0], nullptr, &*of[1]}, {}, *joined);
  ASSERT_EQ(joined->inputs._length, 2u);
  EXPECT_EQ(joined->inputs._buffer[0].age_ns, -1);
  EXPECT_TRUE(joined->inputs._buffer[0].stale);
  EXPECT_EQ(joined->inputs._buffer[1].age_ns, 7);
  EXPECT_EQ(joined->tick_max_us, 9.0);
}

// Only the second share reads the sensor.
TEST(ShareHealth, AWitnessSaysWhatTheShareThatReadsItSaw) {
  std::vector<Sample<clearance_msg_Health>> of(2);
  for (std::uint32_t share = 0; share < 2; ++share) {
    of[share]->recording = dds_string_dup("");
    reserve_sequence(of[share]->witnesses, 1);
    of[share]->witnesses._buffer[of[share]->witnesses._length++] = {dds_string_dup("eye"),
                                                                    dds_string_dup("arm"),
                                                                    90 * share,
                                                                    10 * share,
                                                                    share == 1,
                                                                    0.25,
                                                                    0.5};
  }
  Sample<clearance_msg_Health> joined;
  join_health(std::vector<const clearance_msg_Health*>{&*of[0], &*of[1]}, {}, *joined);
  ASSERT_EQ(joined->witnesses._length, 1u);
  const clearance_msg_WitnessHealth& witness = joined->witnesses._buffer[0];
  EXPECT_STREQ("arm", witness.robot);
  EXPECT_EQ(witness.agreeing, 90u);
  EXPECT_EQ(witness.through, 10u);
  EXPECT_TRUE(witness.denied);
}

// The lead changes to a daemon that has counted less, and back.
TEST(ShareHealth, CountsOfAShareDoNotFallWhereAnotherDaemonFollows) {
  const auto health = [](std::uint64_t daemon, std::uint64_t count) {
    Sample<clearance_msg_Health> message;
    message->daemon = daemon;
    message->recording = dds_string_dup("");
    message->overruns = message->partner.missing = count;
    reserve_sequence(message->rejected, 1);
    message->rejected._buffer[message->rejected._length++] = {
        dds_string_dup("a"), dds_string_dup("late"), count, dds_string_dup("12 m")};
    return message;
  };
  HealthCounts counts, of_another;
  of_another.take(*health(3, 100));
  const auto joined = [&](std::uint64_t daemon, std::uint64_t count) {
    counts.take(*health(daemon, count));
    Sample<clearance_msg_Health> sums;
    join_health({}, std::vector<const HealthCounts*>{&counts, &of_another}, *sums);
    EXPECT_EQ(sums->overruns, sums->partner.missing);
    EXPECT_EQ(sums->overruns, sums->rejected._buffer[0].count);
    EXPECT_STREQ("12 m", sums->rejected._buffer[0].last);
    return sums->overruns;
  };
  EXPECT_EQ(joined(1, 50), 150u);
  EXPECT_EQ(joined(2, 3), 150u);
  EXPECT_EQ(joined(2, 4), 151u);
  EXPECT_EQ(joined(1, 60), 151u);
  EXPECT_EQ(joined(1, 62), 153u);
}

}  // namespace
}  // namespace clearance::client
