// Reports of two partners become one stream.
#include "monitor/client/partner_merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/report_check.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/shared/random.hpp"

namespace clearance::client {
namespace {

constexpr std::int64_t kPeriod = 1'000'000, kStart = 1'700'000'000'000'000'000;

clearance_msg_Distances report(const char* partner, std::uint64_t cycle, std::uint64_t lineage = 1,
                               double lower = 0.5) {
  clearance_msg_Distances message{};
  std::strcpy(message.partner, partner);
  message.daemon = static_cast<std::uint64_t>(partner[0]);
  message.cycle = cycle;
  message.lineage = lineage;
  message.now_ns = kStart + static_cast<std::int64_t>(cycle) * kPeriod;
  message.lower_all = lower;
  message.checksum = message.state_checksum = checksum_of(message);
  return message;
}

class Merge : public testing::Test {
 protected:
  bool take(const clearance_msg_Distances& message) {
    const bool is_next = merge.take(message);
    if (is_next) cycles.push_back(message.cycle);
    return is_next;
  }
  [[nodiscard]] PartnerState state() const { return merge.check().state; }

  PartnerMerge merge;
  std::vector<std::uint64_t> cycles;
};

TEST_F(Merge, HandsOutEachCycleOnceAndTellsThatBothAgree) {
  for (std::uint64_t cycle = 1; cycle <= 5; ++cycle) {
    const bool left_first = cycle % 2 == 0;
    EXPECT_TRUE(take(report(left_first ? "left" : "right", cycle)));
    EXPECT_FALSE(take(report(left_first ? "right" : "left", cycle)));
    if (cycle > 1) {
      EXPECT_EQ(state(), PartnerState::kAgrees);
      EXPECT_EQ(merge.check().cycle, cycle - 1);
    }
  }
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
}

TEST_F(Merge, TellsWithTheNextReportThatAPartnerIsMissing) {
  take(report("left", 1));
  EXPECT_EQ(state(), PartnerState::kAlone);
  take(report("right", 1));
  EXPECT_TRUE(take(report("left", 2)));
  EXPECT_EQ(state(), PartnerState::kAgrees);
  EXPECT_TRUE(take(report("left", 3)));
  EXPECT_EQ(state(), PartnerState::kMissing);
  EXPECT_EQ(merge.check().partner, "right");
  EXPECT_EQ(merge.check().cycle, 2u);
  EXPECT_FALSE(take(report("right", 2))) << "late";
}

TEST_F(Merge, TellsOtherBitsOfTheSameInputsFromOtherInputs) {
  take(report("left", 1));
  take(report("right", 1, 1, 0.5000001));
  take(report("left", 2));
  EXPECT_EQ(state(), PartnerState::kDifferent);
  take(report("right", 2, 9, 0.6));
  take(report("left", 3));
  EXPECT_EQ(state(), PartnerState::kOtherInputs);
  auto message = report("right", 3);
  message.state_checksum ^= 1;
  take(message);
  take(report("left", 4));
  EXPECT_EQ(state(), PartnerState::kDifferent) << "of what the message does not hold";
}

// The one that came later begins with a full report, where the other one sends what has changed.
TEST_F(Merge, PartnersAgreeWhoseMessagesLeaveOutDifferentPairs) {
  constexpr std::uint64_t kRest = 77, kFullEvery = 10;
  ChangedPairs left(kFullEvery), right(kFullEvery);
  std::uint32_t lacking = 0;
  const auto send = [&](const char* partner, std::uint64_t cycle, double lower) {
    Sample<clearance_msg_Distances> message;
    const clearance_msg_Distances of = report(partner, cycle, 1, lower);
    std::strcpy(message->partner, of.partner);
    message->daemon = of.daemon;
    message->cycle = of.cycle;
    message->lineage = of.lineage;
    message->now_ns = of.now_ns;
    reserve_sequence(message->pairs, 2);
    message->pairs._length = 2;
    message->pairs._buffer[1].pair = 1;
    message->pairs._buffer[1].lower = lower;
    reduce_and_sign(kRest, *partner == 'l' ? left : right, *message);
    lacking += 2 - message->pairs._length;
    take(*message);
  };
  for (std::uint64_t cycle = 1; cycle <= 25; ++cycle) {
    const double lower = 0.01 * static_cast<double>(cycle);
    send("left", cycle, lower);
    if (cycle > 3) send("right", cycle, lower);
    if (cycle > 4) {
      EXPECT_EQ(state(), PartnerState::kAgrees) << cycle;
    }
  }
  EXPECT_GT(lacking, 30u);
  send("left", 26, 0.3);
  send("right", 26, 0.31);
  send("left", 27, 0.3);
  EXPECT_EQ(state(), PartnerState::kDifferent);
}

TEST_F(Merge, AReportWithAFlippedBitIsNotHandedOut) {
  take(report("left", 1));
  take(report("right", 1));
  auto broken = report("left", 2);
  broken.lower_all = -broken.lower_all;
  EXPECT_FALSE(take(broken));
  EXPECT_TRUE(take(report("right", 2)));
  EXPECT_EQ(state(), PartnerState::kCorrupt);
  EXPECT_EQ(merge.check().partner, "left");
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{1, 2}));
}

TEST_F(Merge, APartnerThatCountsLowerGoesOnWhereTheOtherFellSilent) {
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
    take(report("left", cycle));
    auto apart = report("right", cycle, 7);
    apart.cycle -= cycle > 3 ? 3 : 0;
    apart.checksum = checksum_of(apart);
    EXPECT_FALSE(take(apart)) << cycle;
  }
  for (const std::uint64_t later : {1, 2}) {
    auto apart = report("right", 10 + later, 7);
    apart.cycle -= 3;
    apart.checksum = checksum_of(apart);
    EXPECT_EQ(take(apart), later == 2) << "the other one may only be late";
  }
}

TEST(ReportCheck, TheOtherPartnerIsNoOtherDaemonButOneThatBeginsAgainIs) {
  ReportChecker checker(100'000'000);
  const auto check = [&](const char* partner, std::uint64_t cycle) {
    return checker.check(report(partner, cycle), kStart);
  };
  EXPECT_FALSE(check("left", 5).other_daemon);
  EXPECT_FALSE(check("right", 6).other_daemon);
  EXPECT_EQ(check("left", 9).missed, 2u);
  EXPECT_TRUE(check("right", 1).other_daemon);
}

// While a network was cut, the other partner may have counted further: no report is missing then.
TEST(ReportCheck, PartnersThatCountApartMissWhatIsMissingInTime) {
  ReportChecker checker(100'000'000);
  const auto missed = [&](std::uint64_t cycle, std::uint64_t lineage, std::int64_t now_ns) {
    auto message = report("left", cycle, lineage);
    message.now_ns = kStart + now_ns;
    return checker.check(message, kStart).missed;
  };
  EXPECT_EQ(missed(5, 7, 0), 0u);
  EXPECT_EQ(missed(6, 7, 1'000'000), 0u);
  EXPECT_EQ(missed(16, 8, 2'100'000), 0u) << "the next tick, under another number";
  EXPECT_EQ(missed(17, 8, 3'100'000), 0u);
  EXPECT_EQ(missed(18, 9, 7'100'000), 3u) << "the next number, four periods later";
  EXPECT_EQ(missed(21, 9, 10'100'000), 2u) << "within a lineage the numbers count";
}

// A report with every kind of field, as a partner sends it.
Sample<clearance_msg_Distances> full_report(Random& random) {
  Sample<clearance_msg_Distances> sample;
  clearance_msg_Distances& message = *sample;
  reserve_sequence(message.pairs, 5);
  reserve_sequence(message.sources, 2);
  reserve_sequence(message.contacts, 1);
  message.pairs._length = 5;
  message.sources._length = 2;
  message.contacts._length = 1;
  for (std::uint32_t i = 0; i < 5; ++i) {
    clearance_msg_PairDistance& pair = message.pairs._buffer[i];
    pair.pair = i;
    pair.distance = pair.lower = pair.upper = random.uniform(0.1, 2.0);
    pair.normal = {0.6, 0.8, 0.0};
    pair.age_a_ns = 1'000'000;
  }
  message.minimum = message.pairs._buffer[0];
  message.minimum_known = message.minimum_certified = true;
  std::strcpy(message.sources._buffer[0].source, "left arm");
  std::strcpy(message.sources._buffer[1].source, "right arm");
  std::strcpy(message.partner, "left");
  message.daemon = random.next();
  message.lineage = random.next();
  message.cycle = 7;
  message.now_ns = kStart;
  message.publish_ns = kStart + 1000;
  message.state_checksum = random.next();
  message.checksum = checksum_of(message);
  message.delivery_checksum = delivery_checksum_of(message);
  return sample;
}

// A bit that flips between the tick and the client is found by the report that has it. Padding
// holds nothing, and is no trial.
TEST_F(Merge, FindsEveryFlippedBitOfAMessageAtOnce) {
  Random random(34);
  CdrEncoder encoder, again;
  CdrDecoder decoder;
  int corrupt = 0, undecodable = 0;
  while (corrupt + undecodable < 1000) {
    const auto sent = full_report(random);
    const auto encoded = encoder.encode(*sent);
    std::vector<std::byte> bytes(encoded.begin(), encoded.end());
    const std::vector<std::byte> before = bytes;
    const std::size_t bit = 32 + random.next() % (8 * (bytes.size() - 4));
    bytes[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    Sample<clearance_msg_Distances> came;
    if (!decoder.decode(bytes, came)) {
      ++undecodable;  // DDS drops it, and the partner's is handed out
      continue;
    }
    const auto now = again.encode(*came);
    if (std::ranges::equal(now, before)) continue;
    PartnerMerge fresh;
    const bool is_of_one = *came->partner == '\0' && came->checksum == 0;
    EXPECT_FALSE(is_of_one) << "bit " << bit;
    EXPECT_FALSE(fresh.take(*came)) << "bit " << bit;
    EXPECT_TRUE(fresh.take(*sent));
    EXPECT_EQ(fresh.check().state, PartnerState::kCorrupt) << "bit " << bit;
    ++corrupt;
  }
  EXPECT_GT(corrupt, 900);
}

}  // namespace
}  // namespace clearance::client
