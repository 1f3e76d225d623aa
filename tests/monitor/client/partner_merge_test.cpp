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
  message.period_ns = kPeriod;
  message.lower_all = lower;
  seal(message, 0);
  return message;
}

class Merge : public testing::Test {
 protected:
  bool take(const clearance_msg_Distances& message) {
    heard_ns += kPeriod / 2;
    const bool is_next = merge.take(message, heard_ns, has_its_crc(message));
    if (is_next) cycles.push_back(message.cycle);
    return is_next;
  }
  [[nodiscard]] PartnerState state() const { return merge.check().state; }

  PartnerMerge merge;
  std::int64_t heard_ns = 0;
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

clearance_msg_Distances of_scene(std::uint64_t revision, clearance_msg_Distances message) {
  message.scene_revision = revision;
  seal(message, 0);
  return message;
}

// The scene of the one has a new obstacle, which the other one cannot read, or has not read yet.
TEST_F(Merge, HandsOutOneSceneAtATime) {
  constexpr std::uint64_t kBefore = 5, kAfter = 6;
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) {
    take(of_scene(kBefore, report("left", cycle)));
    take(of_scene(kBefore, report("right", cycle)));
  }
  for (std::uint64_t cycle = 4; cycle <= 1200; ++cycle) {
    EXPECT_FALSE(cycle > 4 && take(of_scene(kBefore, report("right", cycle, 2))));
    ASSERT_TRUE(take(of_scene(kAfter, report("left", cycle))));
  }
  EXPECT_TRUE(take(of_scene(kAfter, report("right", 1201, 2)))) << "it has changed, too";
  EXPECT_FALSE(take(of_scene(kAfter, report("left", 1201))));
}

// The daemon that has changed is always the slower one.
TEST_F(Merge, HandsOutAChangedSceneWhicheverReportComesFirst) {
  take(of_scene(5, report("left", 1)));
  take(of_scene(5, report("right", 1)));
  EXPECT_TRUE(take(of_scene(5, report("right", 2))));
  EXPECT_TRUE(take(of_scene(6, report("left", 2, 2))));
  for (std::uint64_t cycle = 3; cycle < 20; ++cycle) {
    EXPECT_FALSE(take(of_scene(5, report("right", cycle))));
    EXPECT_TRUE(take(of_scene(6, report("left", cycle, 2))));
  }
}

TEST_F(Merge, HandsOutTheFormerSceneOnceNoneIsHeardOfTheLaterOne) {
  take(of_scene(5, report("left", 1)));
  take(of_scene(5, report("right", 1)));
  take(of_scene(6, report("left", 2)));
  std::uint64_t cycle = 3;
  while (!take(of_scene(5, report("right", cycle, 2)))) ASSERT_LT(++cycle, 1100u);
  EXPECT_GT(cycle, 900u);
  EXPECT_TRUE(take(of_scene(5, report("right", cycle + 1, 2))));
}

// Each leaves out what it has said before (`publish: changes`), and one has joined since.
TEST_F(Merge, ComparesMessagesOfChangesByTheWholeReports) {
  const auto changes = [](const char* partner, std::uint64_t cycle, double lower,
                          std::uint64_t whole) {
    clearance_msg_Distances message = report(partner, cycle, 1, lower);
    message.changes_since = cycle - 1;
    message.state_checksum = whole;
    seal(message, 0);
    return message;
  };
  take(changes("left", 2, 0.5, 77));
  take(changes("right", 2, 0.4, 77));
  take(changes("left", 3, 0.5, 78));
  EXPECT_EQ(state(), PartnerState::kAgrees);
  take(changes("right", 3, 0.5, 79));
  take(changes("left", 4, 0.5, 80));
  EXPECT_EQ(state(), PartnerState::kDifferent);
}

// The zones of a daemon count whose reports always come as the second ones.
TEST_F(Merge, KnowsBothSendersAlthoughOnlyOneIsHandedOut) {
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) {
    EXPECT_TRUE(take(report("right", cycle)));
    EXPECT_FALSE(take(report("left", cycle)));
  }
  EXPECT_EQ(merge.senders()[0].daemon, static_cast<std::uint64_t>('l'));
  EXPECT_EQ(merge.senders()[0].heard_ns, heard_ns);
  EXPECT_EQ(merge.senders()[1].daemon, static_cast<std::uint64_t>('r'));
  EXPECT_EQ(merge.senders()[1].heard_ns, heard_ns - kPeriod / 2);
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

// The clock of the machine was two hours ahead, and was set back while both were started again.
TEST_F(Merge, HandsOutWhatComesAfterTheTimeOfBothWasSetBack) {
  take(report("left", 100));
  clearance_msg_Distances later = report("left", 1, 2);
  later.now_ns -= 7'200'000'000'000;
  seal(later, 0);
  EXPECT_FALSE(take(later)) << "for a moment, it may be of a former run";
  heard_ns += 1'000'000'000;
  EXPECT_TRUE(take(later));
  later.cycle = 2;
  later.now_ns += kPeriod;
  seal(later, 0);
  EXPECT_TRUE(take(later));
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
  seal(message, 0);
  take(message);
  take(report("left", 4));
  EXPECT_EQ(state(), PartnerState::kDifferent) << "of what the message does not hold";
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
    seal(apart, 0);
    EXPECT_FALSE(take(apart)) << cycle;
  }
  for (const std::uint64_t later : {1, 2}) {
    auto apart = report("right", 10 + later, 7);
    apart.cycle -= 3;
    seal(apart, 0);
    EXPECT_EQ(take(apart), later == 2) << "the other one may only be late";
  }
}

// The checksum was computed after the flip, so that the report is good by itself.
TEST_F(Merge, AReportWithAWrongCycleOrTimeDoesNotKeepOutThoseAfterIt) {
  for (std::uint64_t cycle = 1; cycle <= 5; ++cycle) {
    take(report("left", cycle));
    take(report("right", cycle));
  }
  auto leaps = report("left", 6);
  leaps.cycle |= std::uint64_t{1} << 40;
  seal(leaps, 0);
  EXPECT_TRUE(take(leaps)) << "nothing shows that it is wrong";
  take(report("right", 6));
  take(report("left", 7));
  EXPECT_TRUE(take(report("left", 8)));
  EXPECT_EQ(state(), PartnerState::kDifferent);
  take(report("right", 8));
  auto of_tomorrow = report("right", 9);
  of_tomorrow.now_ns += std::int64_t{1} << 50;
  seal(of_tomorrow, 0);
  EXPECT_TRUE(take(of_tomorrow));
  EXPECT_FALSE(take(report("left", 9)));
  EXPECT_TRUE(take(report("left", 10)));
  EXPECT_EQ(state(), PartnerState::kDifferent);
  EXPECT_FALSE(take(report("right", 10)));
  auto counts_on = report("right", 10);
  counts_on.cycle = 99;
  seal(counts_on, 0);
  EXPECT_FALSE(take(counts_on)) << "the report of that time was handed out";
  EXPECT_TRUE(take(report("left", 11)));
  EXPECT_EQ(state(), PartnerState::kDifferent);
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
  reserve_sequence(message.active_zones, 2);
  message.active_zones._length = 2;
  message.active_zones._buffer[0] = 3;
  message.active_zones._buffer[1] = 9;
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
  seal(message, 0);
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
    EXPECT_FALSE(fresh.take(*came, kStart, has_its_crc(*came))) << "bit " << bit;
    EXPECT_TRUE(fresh.take(*sent, kStart, has_its_crc(*sent)));
    EXPECT_EQ(fresh.check().state, PartnerState::kCorrupt) << "bit " << bit;
    ++corrupt;
  }
  EXPECT_GT(corrupt, 900);
}

// A bit flips in the buffer of the message after it was filled, and before its checksums are
// computed: they are right then, and only the partner's report tells. Fields that the two need not
// have alike are no trial: who sent it, when, and which report a sparse one goes on from.
TEST_F(Merge, FindsEveryBitThatFlippedBeforeTheChecksumByTheReportOfThePartner) {
  Random random(35);
  CdrEncoder encoder, again;
  CdrDecoder decoder;
  const auto as_of = [](const clearance_msg_Distances& from, clearance_msg_Distances& to) {
    std::memcpy(to.partner, from.partner, sizeof to.partner);
    to.daemon = from.daemon;
    to.publish_ns = from.publish_ns;
    to.changes_since = from.changes_since;
  };
  int found = 0, of_the_sender = 0;
  while (found < 1000) {
    const auto sent = full_report(random);
    const auto encoded = encoder.encode(*sent);
    std::vector<std::byte> bytes(encoded.begin(), encoded.end());
    const std::size_t bit = 32 + random.next() % (8 * (bytes.size() - 4));
    bytes[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    Sample<clearance_msg_Distances> flipped, rest, right, next;
    if (!decoder.decode(bytes, flipped) || !decoder.decode(bytes, rest)) continue;
    seal(*flipped, 0);
    as_of(*sent, *rest);
    seal(*rest, 0);
    const std::vector<std::byte> unflipped = [&] {
      const auto all = again.encode(*sent);
      return std::vector<std::byte>(all.begin(), all.end());
    }();
    if (std::ranges::equal(again.encode(*rest), unflipped)) {
      ++of_the_sender;  // or of a checksum, which is computed afterwards
      continue;
    }
    ASSERT_TRUE(decoder.decode(unflipped, right));
    std::strcpy(right->partner, "right");
    right->daemon = sent->daemon + 1;
    seal(*right, 0);
    ASSERT_TRUE(decoder.decode(unflipped, next));
    ++next->cycle;
    next->now_ns += kPeriod;
    seal(*next, 0);
    PartnerMerge fresh;
    const bool flipped_first = random.chance(0.5);
    if (flipped_first) static_cast<void>(fresh.take(*flipped, kStart, has_its_crc(*flipped)));
    static_cast<void>(fresh.take(*right, kStart, has_its_crc(*right)));
    if (!flipped_first) static_cast<void>(fresh.take(*flipped, kStart, has_its_crc(*flipped)));
    static_cast<void>(fresh.take(*next, kStart, has_its_crc(*next)));
    const PartnerState told = fresh.check().state;
    EXPECT_TRUE(told == PartnerState::kDifferent || told == PartnerState::kOtherInputs ||
                told == PartnerState::kMissing)
        << "bit " << bit << ": " << name(told);
    ++found;
  }
  EXPECT_LT(of_the_sender, found / 2);
}

}  // namespace
}  // namespace clearance::client
