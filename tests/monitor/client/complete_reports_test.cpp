// Reports that carry only what changed, and what a client makes of them. The oracle is the full
// report of every tick.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "monitor/client/complete_reports.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/changed_pairs.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/random.hpp"

namespace clearance::client {
namespace {

constexpr std::uint32_t kPairs = 20;

// Each tick, some pairs move.
class Ticks {
 public:
  explicit Ticks(std::uint64_t seed) : random_(seed), pairs_(kPairs) {
    for (std::uint32_t i = 0; i < kPairs; ++i) pairs_[i].pair = 3 * i;
  }
  void fill(clearance_msg_Distances& message, double moving) {
    ++cycle_;
    for (clearance_msg_PairDistance& pair : pairs_) {
      pair.evaluated_cycle = cycle_;
      if (!random_.chance(moving)) continue;
      pair.distance = pair.lower = pair.upper = random_.uniform(0.1, 2.0);
    }
    if (message.pairs._maximum < kPairs) reserve_sequence(message.pairs, kPairs);
    std::memcpy(message.pairs._buffer, pairs_.data(), kPairs * sizeof pairs_[0]);
    message.pairs._length = kPairs;
    message.cycle = cycle_;
    message.daemon = 7;
    message.scene_revision = 1;
  }
  [[nodiscard]] const std::vector<clearance_msg_PairDistance>& pairs() const { return pairs_; }

 private:
  Random random_;
  std::uint64_t cycle_ = 0;
  std::vector<clearance_msg_PairDistance> pairs_;
};

bool is_as(const clearance_msg_Distances& message,
           const std::vector<clearance_msg_PairDistance>& pairs) {
  if (message.pairs._length != pairs.size()) return false;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const clearance_msg_PairDistance& one = message.pairs._buffer[i];
    if (one.pair != pairs[i].pair || one.lower != pairs[i].lower || one.status != pairs[i].status)
      return false;
  }
  return true;
}

TEST(CompleteReports, AreAsTheFullOnes) {
  Ticks ticks(34);
  ChangedPairs changes(50);
  CompleteReports whole;
  std::size_t sent = 0;
  for (int tick = 0; tick < 500; ++tick) {
    Sample<clearance_msg_Distances> message;
    ticks.fill(*message, 0.1);
    changes.reduce(*message);
    sent += message->pairs._length;
    EXPECT_TRUE(whole.complete(*message));
    ASSERT_TRUE(is_as(*message, ticks.pairs())) << "tick " << tick;
  }
  EXPECT_LT(sent, 500u * kPairs / 5) << "the bytes do not follow motion";
  EXPECT_GT(sent, 500u * kPairs / 20);
}

// A reader that joins late, or loses a report, knows each pair truly or not at all, and knows all
// with the next full report.
TEST(CompleteReports, ThatLackOneBeforeAreUnknownUntilTheNextFullOne) {
  Ticks ticks(35);
  Random random(36);
  ChangedPairs changes(20);
  CompleteReports whole;
  int unknown = 0, lost = 0;
  bool is_known = false;
  for (std::uint64_t cycle = 1; cycle <= 1000; ++cycle) {
    Sample<clearance_msg_Distances> message;
    ticks.fill(*message, 0.1);
    changes.reduce(*message);
    const bool is_full = message->changes_since == cycle;
    EXPECT_EQ(is_full, cycle == 1 || cycle % 20 == 0);
    if (cycle < 7 || random.chance(0.03)) {
      is_known = false;
      ++lost;
      continue;
    }
    is_known = is_known || is_full;
    EXPECT_EQ(whole.complete(*message), is_known);
    for (std::uint32_t i = 0; i < message->pairs._length; ++i) {
      const clearance_msg_PairDistance& pair = message->pairs._buffer[i];
      const bool is_unknown = pair.status == static_cast<std::uint8_t>(PairStatus::kUnknown);
      unknown += is_unknown;
      if (is_unknown) {
        EXPECT_LT(pair.lower, 0.0);
      } else {
        EXPECT_EQ(pair.lower, ticks.pairs()[pair.pair / 3].lower) << "cycle " << cycle;
      }
    }
    if (is_known) {
      EXPECT_TRUE(is_as(*message, ticks.pairs()));
    }
  }
  EXPECT_GT(lost, 20);
  EXPECT_GT(unknown, 100);
}

TEST(CompleteReports, KnowAPairForGoodThatHasComeBehindAGap) {
  Ticks ticks(37);
  ChangedPairs changes(50);
  CompleteReports whole;
  for (std::uint64_t cycle = 1; cycle <= 20; ++cycle) {
    Sample<clearance_msg_Distances> message;
    ticks.fill(*message, cycle == 4 ? 1.0 : 0.0);
    changes.reduce(*message);
    if (cycle == 2) continue;
    EXPECT_EQ(whole.complete(*message), cycle == 1);
    ASSERT_EQ(message->pairs._length, kPairs);
    const bool is_known =
        message->pairs._buffer[5].status != static_cast<std::uint8_t>(PairStatus::kUnknown);
    EXPECT_EQ(is_known, cycle != 3) << "cycle " << cycle;
  }
}

TEST(CompleteReports, AnotherDaemonOrSceneBeginsWithAFullOne) {
  for (const bool other_scene : {false, true}) {
    Ticks ticks(37);
    ChangedPairs changes(1000);
    CompleteReports whole;
    Sample<clearance_msg_Distances> first, second;
    ticks.fill(*first, 1.0);
    changes.reduce(*first);
    EXPECT_TRUE(whole.complete(*first));
    ticks.fill(*second, 0.0);
    changes.reduce(*second);
    ASSERT_EQ(second->pairs._length, 0u);
    (other_scene ? second->scene_revision : second->daemon) = 9;
    EXPECT_FALSE(whole.complete(*second));
    for (std::uint32_t i = 0; i < second->pairs._length; ++i)
      EXPECT_EQ(second->pairs._buffer[i].status, static_cast<std::uint8_t>(PairStatus::kUnknown));
  }
}

// The rule of monitor/interface/report.hpp: a value is NaN, a bound is infinite, and an age
// negative.
TEST(CompleteReports, KnowNothingOfAnUnknownPair) {
  const clearance_msg_PairDistance unknown = unknown_pair(3);
  EXPECT_EQ(unknown.pair, 3u);
  for (const double value : {unknown.distance, unknown.model_error, unknown.closing_speed,
                             unknown.time_to_contact, unknown.normal.x, unknown.witness_a.y})
    EXPECT_TRUE(std::isnan(value));
  for (const double bound :
       {unknown.lower, unknown.swept_lower, unknown.stop_lower, -unknown.upper})
    EXPECT_EQ(bound, -kInfinity);
  EXPECT_LT(unknown.age_a_ns, 0);
  EXPECT_LT(unknown.age_b_ns, 0);
}

// An age is listed again before it has grown by more than the limit.
TEST(CompleteReports, APairWhosePosesGrowOldIsListedAgain) {
  ChangedPairs changes(1000);
  Ticks ticks(38);
  std::int64_t listed = 0, age = 0;
  for (int tick = 0; tick < 100; ++tick, age += 1'000'000) {
    Sample<clearance_msg_Distances> message;
    ticks.fill(*message, 0.0);
    message->pairs._buffer[4].age_b_ns = age;
    changes.reduce(*message);
    for (std::uint32_t i = 0; i < message->pairs._length; ++i) {
      if (message->pairs._buffer[i].pair == 12) listed = message->pairs._buffer[i].age_b_ns;
    }
    EXPECT_LE(age - listed, kUnlistedAge);
  }
  EXPECT_GT(listed, 0);
}

}  // namespace
}  // namespace clearance::client
