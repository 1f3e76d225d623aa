// Checksums of reports, and the CRC and address of messages. Oracle: the CDR bytes, whose every bit
// is flipped, and reports that differ in one field.
#include "monitor/wire/report_checksum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/wire/wire_samples.hpp"

namespace clearance::test {
namespace {

constexpr std::uint64_t kSealAddress = 9;

template <class Message>
std::vector<std::byte> sealed_bytes(const Message& message) {
  CdrEncoder encoder;
  const auto bytes = encoder.encode(message);
  return {bytes.begin(), bytes.end()};
}

// Calls visit(field, value) for each number in a message, through its lists.
template <class Visit, class Message>
void visit_numbers(const Visit& visit, Message& message) {
  for_each_field(
      [&visit]<class Value>(const Field& field, Value& value) {
        if constexpr (std::is_arithmetic_v<Value>) {
          visit(field, value);
        } else if constexpr (MessageSequence<Value>) {
          if constexpr (HasFields<std::remove_reference_t<decltype(*value._buffer)>>) {
            for (std::uint32_t i = 0; i < value._length; ++i)
              visit_numbers(visit, value._buffer[i]);
          }
        } else if constexpr (HasFields<Value>) {
          visit_numbers(visit, value);
        }
      },
      message);
}

bool is_bound(std::string_view name) {
  constexpr std::array kBounds = {"lower",           "upper",     "swept_lower", "lower_all",
                                  "swept_lower_all", "clearance", "remaining",   "swept_clearance",
                                  "unseen",          "thickness", "depth",       "speed_limit"};
  return std::ranges::find(kBounds, name) != kBounds.end();
}
bool is_enumeration(std::string_view name) {
  constexpr std::array kNames = {"status", "cause", "validity", "ended"};
  return std::ranges::find(kNames, name) != kNames.end();
}
bool is_share(std::string_view name) { return name == "scaling" || name == "share"; }

// The last value of each enumeration of the messages of a tick.
std::optional<std::uint8_t> last_of(Meaning meaning) {
  switch (meaning) {
    case Meaning::kPairStatus:
      return 7;
    case Meaning::kZoneCause:
      return 8;
    case Meaning::kContactStatus:
      return 5;
    case Meaning::kValidity:
    case Meaning::kContactEnded:
    case Meaning::kGradientStatus:
      return 3;
    default:
      return {};
  }
}

// One of each element that the samples lack.
void fill_rest(clearance_msg_Distances& message) {
  reserve_sequence(message.contacts, 1);
  reserve_sequence(message.hidden, 1);
  message.contacts._length = message.hidden._length = 1;
}
void fill_rest(clearance_msg_Separation& message) {
  reserve_sequence(message.stops, 1);
  message.stops._length = 1;
}
void fill_rest(clearance_msg_Gradients&) {}
void fill_rest(clearance_msg_ZoneState&) {}
void fill_rest(clearance_msg_Health&) {}

// A message of random values, as a daemon might write it.
template <class Message>
void fill_soundly(std::mt19937_64& random, Message& message) {
  fill(random, message);
  fill_rest(*message);
  visit_numbers(
      []<class Value>(const Field& field, Value& value) {
        if constexpr (std::is_floating_point_v<Value>) {
          if (is_bound(field.name) && std::isnan(value)) value = -1.0 / 0.0;
          if (is_share(field.name)) value = std::isfinite(value) ? std::abs(value) / 10.0 : 0.0;
          if (field.name == "upper") value = 11.0;
          if (field.name == "lower") value = -11.0;
        }
      },
      *message);
}

template <class Message>
class SealedMessage : public testing::Test {};
using SealedTypes =
    testing::Types<clearance_msg_Distances, clearance_msg_ZoneState, clearance_msg_Health,
                   clearance_msg_Separation, clearance_msg_Gradients>;
TYPED_TEST_SUITE(SealedMessage, SealedTypes);

TYPED_TEST(SealedMessage, IsGoodAtItsAddressAndAtNoOther) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 50; ++i) {
    Sample<TypeParam> message;
    fill_soundly(random, message);
    seal(*message, kSealAddress);
    EXPECT_TRUE(has_its_crc(*message));
    EXPECT_EQ(delivery_error(*message, kSealAddress), ReportError::kGood);
    EXPECT_EQ(delivery_error(*message, kSealAddress + 1), ReportError::kOtherAddress);
    message->address = kSealAddress + 1;
    EXPECT_EQ(delivery_error(*message, kSealAddress + 1), ReportError::kCorrupt);
  }
}

// The CRC is right, as of a program that is no daemon. An unknown bound is infinite, and std::min
// passes over NaN.
TYPED_TEST(SealedMessage, WithAValueThatNoDaemonWritesIsCorrupt) {
  std::mt19937_64 random(11);
  Sample<TypeParam> message;
  fill_soundly(random, message);
  const auto error = [&message] {
    seal(*message, kSealAddress);
    return delivery_error(*message, kSealAddress);
  };
  ASSERT_EQ(error(), ReportError::kGood);
  constexpr bool is_of_gradients = std::is_same_v<TypeParam, clearance_msg_Gradients>;
  const auto try_value = [&]<class Value>(const Field& field, Value& value, Value tried,
                                          bool good) {
    const Value before = std::exchange(value, tried);
    EXPECT_EQ(error() == ReportError::kGood, good) << field.name << ' ' << +tried;
    value = before;
  };
  visit_numbers(
      [&]<class Value>(const Field& field, Value& value) {
        if (field.meaning == Meaning::kDelivery) return;
        if constexpr (std::is_floating_point_v<Value>) {
          const bool bound = is_bound(field.name), share = is_share(field.name);
          try_value(field, value, std::nan(""), !bound && !share);
          try_value(field, value, -1.0 / 0.0, !share && field.name != "upper");
          const bool has_upper = field.name == "lower" && !is_of_gradients;
          try_value(field, value, 1.0 / 0.0, !share && !has_upper);
          if (!share) return;
          for (const double beyond : {-1e-9, 1.0000001}) try_value(field, value, beyond, false);
          for (const double end : {0.0, 1.0}) try_value(field, value, end, true);
        } else if constexpr (std::is_same_v<Value, std::uint8_t>) {
          const std::optional<std::uint8_t> last = last_of(field.meaning);
          EXPECT_EQ(last.has_value(), is_enumeration(field.name)) << field.name;
          if (!last) return;
          try_value(field, value, *last, true);
          try_value(field, value, static_cast<std::uint8_t>(*last + 1), false);
          try_value(field, value, std::uint8_t{255}, false);
        }
      },
      *message);
}

// Padding holds nothing: the message is then the same.
TYPED_TEST(SealedMessage, OfWhichAnyBitIsFlippedIsRefusedOrCorrupt) {
  std::mt19937_64 random(8);
  Sample<TypeParam> message, came;
  fill(random, message);
  seal(*message, kSealAddress);
  const std::vector<std::byte> good = sealed_bytes(*message);
  CdrDecoder decoder;
  std::size_t corrupt = 0, same = 0;
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::vector<std::byte> bytes = good;
    bytes[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    if (!decoder.decode(bytes, came)) continue;
    if (sealed_bytes(*came) == good) {
      ++same;
      continue;
    }
    ++corrupt;
    ASSERT_EQ(delivery_error(*came, kSealAddress), ReportError::kCorrupt) << "bit " << bit;
  }
  EXPECT_GT(corrupt, same);
}

TEST(Seal, OfAPartnerStatesWhatPartnersCompare) {
  std::mt19937_64 random(9);
  Sample<clearance_msg_Distances> message;
  fill(random, message);
  message->checksum = 5;
  seal(*message, kSealAddress);
  EXPECT_EQ(message->checksum, 5u) << "a daemon on its own states none";
  std::strcpy(message->partner, "left");
  seal(*message, kSealAddress);
  EXPECT_EQ(message->checksum, checksum_of(*message));
}

TEST(Crc, CountsATextUpToItsEnd) {
  clearance_msg_Distances message{};
  const std::uint64_t empty = crc_of(message);
  message.partner[1] = 'x';
  EXPECT_EQ(crc_of(message), empty) << "nothing counts behind the first zero";
  std::memset(message.partner, 'x', sizeof message.partner);
  const std::uint64_t without_end = crc_of(message);
  message.partner[sizeof message.partner - 1] = 'y';
  EXPECT_NE(crc_of(message), without_end) << "a text without an end counts whole";
}

TEST(Crc, TakesANullTextForAnEmptyOne) {
  Sample<clearance_msg_Health> null, empty, one;
  empty->recording = dds_string_dup("");
  one->recording = dds_string_dup("x");
  EXPECT_EQ(crc_of(*null), crc_of(*empty));
  EXPECT_NE(crc_of(*null), crc_of(*one));
}

// A receiver tells by it whether a message is for the topic that it reads.
TEST(Address, IsAnotherOneInAnotherDomainPartitionOrTopic) {
  struct Place {
    std::uint32_t domain;
    std::string_view partition, topic;
  };
  constexpr Place kPlaces[] = {{7, "demo", "distances"}, {8, "demo", "distances"},
                               {7, "dem", "odistances"}, {7, "", "demodistances"},
                               {7, "demodistances", ""}, {7, "demo", "distancef"},
                               {7, "Demo", "distances"}, {7, "", ""}};
  std::set<std::uint64_t> addresses;
  for (const auto& [domain, partition, topic] : kPlaces) {
    const std::uint64_t address = report_address(domain, partition, topic);
    EXPECT_EQ(report_address(domain, partition, topic), address);
    EXPECT_TRUE(addresses.insert(address).second) << domain << ' ' << partition << ' ' << topic;
  }
}

// A report of two sources, with zones that are active.
class PartnersCompare : public testing::Test {
 protected:
  PartnersCompare() {
    reserve_sequence(message->sources, 2);
    reserve_sequence(message->source_contents, 2);
    reserve_sequence(message->active_zones, 2);
    message->sources._length = message->source_contents._length = message->active_zones._length = 2;
    std::strcpy(message->sources._buffer[0].source, "ab");
    std::strcpy(message->sources._buffer[1].source, "c");
    message->checksum = 7;
    message->period_ns = 1'000'000;
  }
  // Whether a change to the message changes what a function says of it.
  template <class Function, class Change>
  bool counts(const Function& function, const Change& change) {
    const std::uint64_t before = function(*message);
    change(*message);
    return function(*message) != before;
  }
  Sample<clearance_msg_Distances> message;
};

TEST_F(PartnersCompare, AreChecksumZonesAndPeriodOfAWholeReport) {
  const auto counted = [&](const auto& change) { return counts(compared_checksum, change); };
  EXPECT_TRUE(counted([](auto& m) { m.checksum = 8; }));
  EXPECT_TRUE(counted([](auto& m) { m.active_zones._buffer[1] = 3; }));
  EXPECT_TRUE(counted([](auto& m) { m.active_zones._length = 1; }));
  EXPECT_TRUE(counted([](auto& m) { m.period_ns = 2'000'000; }));
  EXPECT_FALSE(counted([](auto& m) { m.publish_ns = 5; }));
}

TEST_F(PartnersCompare, IsNoChecksumOfAReportOfChanges) {
  const auto counted = [&](const auto& change) { return counts(compared_checksum, change); };
  EXPECT_TRUE(counted([](auto& m) { m.changes_since = 4; }));
  EXPECT_FALSE(counted([](auto& m) { m.checksum = 9; }));
  EXPECT_FALSE(counted([](auto& m) { m.changes_since = 5; }));
  EXPECT_TRUE(counted([](auto& m) { m.active_zones._length = 0; }));
}

TEST_F(PartnersCompare, InputsAreTheSourcesWithTheirNumbersAndContents) {
  const auto counted = [&](const auto& change) { return counts(inputs_checksum_of, change); };
  EXPECT_TRUE(counted([](auto& m) { std::strcpy(m.sources._buffer[0].source, "a"); }));
  EXPECT_TRUE(counted([](auto& m) { std::strcpy(m.sources._buffer[1].source, "bc"); }));
  EXPECT_TRUE(counted([](auto& m) { m.sources._buffer[1].sequence_number = 1; }));
  EXPECT_TRUE(counted([](auto& m) { m.source_contents._buffer[1] = 1; }));
  EXPECT_TRUE(counted([](auto& m) { m.source_contents._length = 1; }));
  EXPECT_TRUE(counted([](auto& m) { m.sources._length = 1; }));
  EXPECT_FALSE(counted([](auto& m) { m.period_ns = 5; }));
}

// Partners compare messages, and replays reports.
TEST(ReportChecksum, OfAReportIsThatOfItsMessageAndCountsEachOfItsPairs) {
  std::mt19937_64 random(10);
  Sample<clearance_msg_Distances> message;
  fill(random, message);
  ASSERT_GT(message->pairs._length, 1u);
  Report report;
  from_wire(*message, report);
  EXPECT_EQ(checksum_of(report), checksum_of(*message));
  message->publish_ns ^= 1;
  EXPECT_EQ(checksum_of(report), checksum_of(*message)) << "the time of publication does not count";
  for (PairReport& pair : report.pairs) {
    const std::uint64_t before = checksum_of(report);
    pair.swept_lower = 0.125;
    EXPECT_NE(checksum_of(report), before);
  }
}

}  // namespace
}  // namespace clearance::test
