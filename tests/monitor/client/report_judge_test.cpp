// What a channel may do to the bytes of reports, and what the judge of a client says of it. The
// oracle knows what was done. Each kind of error is one of IEC 61784-3's.
#include "monitor/client/report_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance::client {
namespace {

using Bytes = std::vector<std::byte>;

// Reports of a daemon as the bytes that DDS sends, and a client that has heard some of them.
class Channel : public testing::Test {
 protected:
  using enum ReportError;
  static constexpr std::int64_t kPeriod = 1'000'000, kStart = 1'700'000'000'000'000'000;
  static constexpr std::int64_t kHour = 3'600'000'000'000;
  static constexpr std::uint64_t kDaemon = 0x5eed;
  inline static const std::uint64_t kAddress = report_address(7, "demo", "clearance_distances");

  explicit Channel(std::uint64_t seed = 63) : random(seed) {
    reserve_sequence(sent->pairs, 3);
    reserve_sequence(sent->sources, 1);
    reserve_sequence(sent->source_contents, 1);
    sent->pairs._length = 3;
    sent->sources._length = sent->source_contents._length = 1;
    std::strcpy(sent->sources._buffer[0].source, "left arm");
  }

  // The next report of the daemon; some figures are random.
  Bytes report(std::uint64_t daemon = kDaemon, std::uint64_t address = kAddress) {
    ++cycle;
    for (std::uint32_t i = 0; i < sent->pairs._length; ++i) {
      clearance_msg_PairDistance& pair = sent->pairs._buffer[i];
      pair.pair = i;
      pair.distance = pair.lower = pair.upper = random.uniform(0.1, 2.0);
      pair.age_a_ns = pair.age_b_ns = random.integer(0, 1'000'000);
    }
    sent->minimum = sent->pairs._buffer[0];
    sent->daemon = daemon;
    sent->cycle = cycle;
    sent->now_ns = sent->publish_ns = now;
    sent->period_ns = kPeriod;
    sent->sources._buffer[0].sequence_number = cycle;
    sent->source_contents._buffer[0] = random.next();
    seal(*sent, address);
    return bytes_of(*sent);
  }
  template <class Message>
  Bytes bytes_of(const Message& message) {
    const auto cdr = encoder.encode(message);
    return {cdr.begin(), cdr.end()};
  }
  // As Stream does. kGood: the report is handed on as good.
  ReportError hear(const Bytes& bytes) {
    if (!decoder.decode(bytes, came)) return kCorrupt;  // DDS drops it
    if (const ReportError error = judge.refuse(*came, now); error != kGood) return error;
    check = judge.check(*came, now, now);
    return check.error;
  }
  void hear_some() {
    for (int i = random.integer(1, 3); i > 0; --i) {
      now += kPeriod;
      past.push_back(report());
      ASSERT_EQ(hear(past.back()), kGood);
    }
    now += kPeriod;
  }
  // A client and a daemon that know nothing of the trial before.
  void begin() {
    judge = ReportJudge(kLimits, kAddress);
    past.clear();
    cycle = random.next() >> 32;
    now = kStart + random.integer(0, 1'000'000'000);
    hear_some();
  }
  template <class Trial>
  void try_often(const Trial& trial) {
    for (std::uint64_t i = repeats(1'000'000, 250); i > 0 && !HasFailure(); --i) {
      begin();
      trial();
    }
  }

  static constexpr ReportJudge::Limits kLimits{.old_after_ns = 100 * kPeriod,
                                               .error_interval_ns = kHour};
  Random random;
  CdrEncoder encoder;
  CdrDecoder decoder;
  Sample<clearance_msg_Distances> sent, came;
  ReportJudge judge{kLimits, kAddress};
  ReportCheck check;
  std::vector<Bytes> past;  // what the client has heard
  std::uint64_t cycle = 0;
  std::int64_t now = kStart;
};

// Flips 1 to 8 bits, each bit of a burst of up to 400 with probability one half, or all bytes
// behind a place.
void corrupt(Random& random, Bytes& bytes) {
  const std::size_t bits = 8 * bytes.size();
  const auto flip = [&](std::size_t bit) {
    bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
  };
  const int kind = random.integer(0, 9);
  if (kind < 5) {
    for (int i = random.integer(1, 8); i > 0; --i) flip(random.next() % bits);
  } else if (kind < 9) {
    const std::size_t length = static_cast<std::size_t>(random.integer(2, 400));
    const std::size_t first = random.next() % (bits - length);
    for (std::size_t i = 0; i < length; ++i) {
      if (random.chance(0.5)) flip(first + i);
    }
  } else {
    for (std::size_t at = random.next() % bytes.size(); at < bytes.size(); ++at)
      bytes[at] = static_cast<std::byte>(random.next());
  }
}

TEST_F(Channel, ThatCorruptsAReportIsFound) {
  std::uint64_t refused = 0, unharmed = 0, undecodable = 0;
  Sample<clearance_msg_Distances> decoded;
  try_often([&] {
    const Bytes good = report();
    Bytes bytes = good;
    corrupt(random, bytes);
    undecodable += decoder.decode(bytes, decoded) ? 0 : 1;
    const ReportError error = hear(bytes);
    if (error == kGood) {
      ++unharmed;  // padding holds nothing
      ASSERT_EQ(bytes_of(*came), good) << "a report that differs is handed on as good";
      return;
    }
    ++refused;
    ASSERT_EQ(error, kCorrupt);
  });
  EXPECT_GT(refused, 50 * unharmed);
  std::printf("%llu refused, %llu of them by DDS, %llu unharmed\n",
              static_cast<unsigned long long>(refused),
              static_cast<unsigned long long>(undecodable),
              static_cast<unsigned long long>(unharmed));
}

TEST_F(Channel, ThatRepeatsAReportIsFound) {
  try_often([&] {
    if (random.chance(0.5)) hear_some();
    ASSERT_EQ(hear(past[random.next() % past.size()]), kRepeated);
    ASSERT_EQ(judge.error(now), kRepeated);
    ASSERT_EQ(hear(report()), kGood) << "one error does not hold";
  });
}

TEST_F(Channel, ThatChangesTheOrderIsFound) {
  try_often([&] {
    std::vector<Bytes> waiting;
    for (int i = random.integer(2, 5); i > 0; --i) waiting.push_back(report());
    const std::size_t at = random.next() % (waiting.size() - 1);
    std::swap(waiting[at], waiting[at + 1]);
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      ASSERT_EQ(hear(waiting[i]), i == at + 1 ? kRepeated : kGood);
      ASSERT_TRUE(i != at || check.missed == 1u);
    }
  });
}

TEST_F(Channel, ThatLosesReportsIsFoundInTheFirstMissingPeriodAndByTheNextReport) {
  try_often([&] {
    now -= kPeriod;  // the last report has just come
    const int lost = random.integer(1, 20);
    ASSERT_EQ(judge.error(now + 2 * kPeriod), kGood) << "the period in which it is due";
    ASSERT_EQ(judge.error(now + 2 * kPeriod + 1), kSilent);
    for (int i = 0; i < lost; ++i) {
      now += kPeriod;
      static_cast<void>(report());
    }
    now += kPeriod;
    ASSERT_EQ(judge.error(now), lost > 1 ? kSilent : kGood);
    ASSERT_EQ(hear(report()), kGood);
    ASSERT_EQ(check.missed, static_cast<std::uint64_t>(lost));
    ASSERT_EQ(judge.error(now), kGood) << "it ends by itself";
  });
}

TEST_F(Channel, ThatDelaysReportsIsFound) {
  try_often([&] {
    const Bytes late = report();
    now += 2 * kPeriod + 1 + random.integer(0, 1'000'000'000);
    ASSERT_EQ(judge.error(now), kSilent);
    ASSERT_EQ(hear(late), kOld);
    ASSERT_EQ(judge.error(now), kOld);
    const Bytes early = (now += 3 * kPeriod, report());
    now -= 3 * kPeriod;
    ASSERT_EQ(hear(early), kClocksDisagree);
  });
}

// A report that another daemon wrote for the same topic.
TEST_F(Channel, ThatInsertsReportsIsFound) {
  try_often([&] {
    const std::uint64_t of_ours = cycle, other = kDaemon ^ (1 + random.next() % 1000);
    if (random.chance(0.5)) cycle = random.next() >> 32;
    ASSERT_EQ(hear(report(other)), kOtherSource);
    ASSERT_EQ(judge.error(now), kOtherSource);
    ASSERT_FALSE(judge.is_held());
    cycle = of_ours;
    ASSERT_EQ(hear(report()), kOtherSource) << "it has taken the place of ours";
    ASSERT_TRUE(judge.is_held());
    ASSERT_EQ(hear(report()), kGood);
    ASSERT_EQ(judge.error(now), kOtherSource) << "until acknowledge()";
  });
}

// What looks like a report of ours and is none: of an earlier run of the daemon, not sealed, sealed
// by another checksum, of another topic, or random.
TEST_F(Channel, ThatPassesAMasqueradeIsFound) {
  try_often([&] {
    Bytes bytes;
    switch (random.integer(0, 4)) {
      case 0:
        bytes = report(random.next());
        ASSERT_EQ(hear(bytes), kOtherSource);
        return;
      case 1:
        static_cast<void>(report());
        sent->delivery_checksum = 0;
        bytes = bytes_of(*sent);
        break;
      case 2:
        static_cast<void>(report());
        sent->delivery_checksum = checksum_of(*sent);
        bytes = bytes_of(*sent);
        break;
      case 3: {
        clearance_msg_Separation other{};
        other.daemon = kDaemon;
        other.cycle = cycle + 1;
        other.now_ns = other.publish_ns = now;
        other.period_ns = kPeriod;
        seal(other, kAddress);
        bytes = bytes_of(other);
        bytes.resize(report().size());
        break;
      }
      default:
        bytes = report();
        for (std::size_t at = 4; at < bytes.size(); ++at)
          bytes[at] = static_cast<std::byte>(random.chance(0.8) ? 0 : random.next());
    }
    ASSERT_EQ(hear(bytes), kCorrupt);
  });
}

TEST_F(Channel, ThatDeliversToAnotherAddressIsFound) {
  const std::array<std::string, 5> partitions = {"", "demo", "demo2", "demo\n", "hall"};
  const std::array<std::string, 5> topics = {"clearance_distances", "clearance_distances_left",
                                             "clearance_separation", "distances", ""};
  try_often([&] {
    const auto domain = static_cast<std::uint32_t>(random.integer(0, 232));
    const std::string& partition = partitions[random.next() % partitions.size()];
    const std::string& topic = topics[random.next() % topics.size()];
    const bool is_ours = domain == 7 && partition == "demo" && topic == topics[0];
    const Bytes bytes = report(kDaemon, report_address(domain, partition, topic));
    ASSERT_EQ(hear(bytes), is_ours ? kGood : kOtherAddress);
  });
}

TEST_F(Channel, HoldsAfterTwoFaultsWithinTheIntervalUntilAcknowledge) {
  const auto fault = [&] {
    Bytes bytes = report();
    bytes[100] ^= std::byte{4};
    EXPECT_EQ(hear(bytes), kCorrupt);
  };
  const auto goes_on = [&] {
    now += kPeriod;
    return hear(report()) == kGood && judge.error(now) == kGood;
  };
  EXPECT_EQ(judge.error(now), kNothingHeard);
  begin();
  fault();
  EXPECT_EQ(judge.error(now), kCorrupt);
  EXPECT_TRUE(goes_on());
  now += kHour + 2 * kPeriod;
  EXPECT_TRUE(goes_on());
  fault();
  EXPECT_TRUE(goes_on()) << "more than an hour lies between them";
  now += kHour - 2 * kPeriod;
  static_cast<void>(goes_on());
  fault();
  EXPECT_TRUE(judge.is_held());
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(goes_on());
  EXPECT_EQ(judge.error(now + 10 * kHour), kCorrupt);
  judge.acknowledge();
  EXPECT_FALSE(judge.is_held());
  EXPECT_EQ(judge.error(now), kNothingHeard) << "only a report ends it";
  EXPECT_TRUE(goes_on());
}

TEST_F(Channel, IsNotHeldByWhatComesTooLate) {
  begin();
  for (int i = 0; i < 10; ++i) {
    const Bytes late = report();
    now += 5 * kPeriod;
    EXPECT_EQ(hear(late), kOld);
    EXPECT_EQ(judge.error(now), kOld);
    EXPECT_EQ(judge.error(now + 3 * kPeriod), kSilent) << "it does not hide the silence";
    EXPECT_EQ(hear(report()), kGood);
    EXPECT_EQ(judge.error(now), kGood);
  }
}

// After a silence, another number is a daemon that starts again; beside one it is a masquerade.
TEST_F(Channel, IsNotHeldByADaemonThatStartsAgain) {
  begin();
  for (std::uint64_t daemon = 1; daemon <= 5; ++daemon) {
    now += 3 * kPeriod;
    EXPECT_EQ(hear(report(kDaemon + daemon)), kOtherSource);
    EXPECT_EQ(hear(report(kDaemon + daemon)), kGood);
    EXPECT_EQ(judge.error(now), kGood);
  }
  for (std::uint64_t daemon = 6; daemon <= 7; ++daemon)
    EXPECT_EQ(hear(report(kDaemon + daemon)), kOtherSource);
  EXPECT_TRUE(judge.is_held());
}
// The time that a report counts begins when it was published, not when it came.
TEST_F(Channel, CountsFromTheTimeOfPublishingAndByThePeriodThatTheClientStates) {
  begin();
  const Bytes bytes = report();
  now += kPeriod;
  ASSERT_EQ(hear(bytes), kGood);
  EXPECT_EQ(judge.error(now + kPeriod), kGood);
  EXPECT_EQ(judge.error(now + kPeriod + 1), kSilent);
  judge = ReportJudge({.period_ns = 10 * kPeriod, .error_interval_ns = kHour}, kAddress);
  const Bytes next = report();
  now += 9 * kPeriod;
  ASSERT_EQ(hear(next), kGood);
  EXPECT_EQ(judge.error(now + kPeriod), kGood);
  EXPECT_EQ(judge.error(now + kPeriod + 1), kSilent);
}

// Partners that tick apart count otherwise. A leader's other messages go over to its partner, and
// they name neither.
TEST_F(Channel, IsNotHeldByAChangeOfTheLeader) {
  begin();
  std::strcpy(sent->partner, "left");
  for (int i = 0; i < 9; ++i) {
    cycle -= i % 2 == 0 ? 0 : 7;
    ASSERT_EQ(hear(report(kDaemon + 1)), i % 2 == 0 && i > 0 ? kGood : kOtherSource);
  }
  EXPECT_FALSE(judge.is_held());
  judge.acknowledge();
  for (std::uint64_t daemon = 1; daemon <= 9; ++daemon) {
    clearance_msg_Separation message{};
    message.daemon = daemon;
    message.cycle = daemon;
    message.publish_ns = now;
    seal(message, kAddress);
    ASSERT_EQ(judge.refuse(message, now), kGood);
    EXPECT_EQ(judge.check(message, now, now).error, daemon == 1 ? kGood : kOtherSource);
  }
  EXPECT_FALSE(judge.is_held());
}

TEST(Crc64, IsThatOfXzFiles) {
  Crc64 crc;
  for (const char c : std::string("123456789")) crc.add(c);
  EXPECT_EQ(crc.value(), 0x995dc9bbdf1939faU);
}

// Linear: what a pattern of flipped bits does to the CRC is the remainder of its polynomial. One of
// an odd number of terms has a remainder, because x + 1 divides the generator, which has an even
// number. One of two terms has none only if two powers of x have the same remainder.
TEST(Crc64, FindsOneTwoAndThreeFlippedBitsOfTwoMegabytes) {
  constexpr std::uint64_t kGenerator = 0x42f0e1eba9ea3693U;  // below x^64
  EXPECT_EQ((1 + std::popcount(kGenerator)) % 2, 0);
  std::vector<std::uint64_t> powers(8 * repeats(2 << 20, 16));
  std::uint64_t power = 1;
  for (std::uint64_t& each : powers) {
    each = power;
    power = power << 1 ^ (power >> 63 != 0 ? kGenerator : 0);
  }
  std::ranges::sort(powers);
  EXPECT_EQ(std::ranges::adjacent_find(powers), powers.end());
}

}  // namespace
}  // namespace clearance::client
