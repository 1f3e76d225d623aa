// The pairs that a report of changes lists. Oracle: the list of a pair's fields, and what
// idl/FIELDS.md says of ages and cycles.
#include "monitor/wire/changed_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <string_view>

#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/message_fields.hpp"

namespace clearance::test {
namespace {

constexpr std::uint64_t kFullReports = 1000;

// Reports with the same pair, one in each cycle.
class ReportsOfOnePair {
 public:
  explicit ReportsOfOnePair(const clearance_msg_PairDistance& first) {
    reserve_sequence(message_->pairs, 1);
    EXPECT_TRUE(lists(first)) << "the first report has all pairs";
  }
  bool lists(const clearance_msg_PairDistance& pair) {
    message_->pairs._buffer[0] = pair;
    message_->pairs._length = 1;
    ++message_->cycle;
    changes_.reduce(*message_);
    return message_->pairs._length == 1;
  }

 private:
  ChangedPairs changes_{kFullReports};
  Sample<clearance_msg_Distances> message_;
};

TEST(ChangedPairs, ListAPairIfAnyBitOfItChangesButThoseOfItsAgesAndCycles) {
  const std::set<std::string_view> free = {"age_a_ns", "age_b_ns", "evaluated_cycle",
                                           "refresh_age_cycles"};
  clearance_msg_PairDistance pair{};
  std::size_t bits = 0;
  for_each_field(
      [&](const Field& field, auto& value) {
        if (free.contains(field.name)) return;
        auto* const bytes = reinterpret_cast<unsigned char*>(&value);
        for (std::size_t bit = 0; bit < 8 * sizeof value; ++bit, ++bits) {
          ReportsOfOnePair reports(pair);
          EXPECT_FALSE(reports.lists(pair));
          bytes[bit / 8] ^= static_cast<unsigned char>(1u << bit % 8);
          EXPECT_TRUE(reports.lists(pair)) << field.name << ", bit " << bit;
          EXPECT_FALSE(reports.lists(pair)) << field.name << ": it is listed as it is now";
          bytes[bit / 8] ^= static_cast<unsigned char>(1u << bit % 8);
        }
      },
      pair);
  EXPECT_EQ(bits, 3 * 32u + 8u + 8 * 64u + 9 * 64u);
}

TEST(ChangedPairs, ListNoPairForItsCycles) {
  clearance_msg_PairDistance pair{};
  ReportsOfOnePair reports(pair);
  pair.evaluated_cycle = 7;
  EXPECT_FALSE(reports.lists(pair));
  pair.refresh_age_cycles = 9;
  EXPECT_FALSE(reports.lists(pair));
}

TEST(ChangedPairs, ListAPairIfAPoseIsOlderByMoreThanTheLimitOrBecomesKnownOrUnknown) {
  struct Ages {
    std::int64_t listed, now;
    bool is_listed;
  };
  constexpr std::int64_t kAge = 5'000'000;
  constexpr Ages kAges[] = {
      {kAge, kAge, false},
      {kAge, 0, false},
      {kAge, kAge + kUnlistedAge, false},
      {kAge, kAge + kUnlistedAge + 1, true},
      {kAge, -1, true},
      {-1, 0, true},
      {-1, -1, false},
      {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(), false},
  };
  for (std::int64_t clearance_msg_PairDistance::*age :
       {&clearance_msg_PairDistance::age_a_ns, &clearance_msg_PairDistance::age_b_ns}) {
    for (const Ages& ages : kAges) {
      clearance_msg_PairDistance pair{};
      pair.*age = ages.listed;
      ReportsOfOnePair reports(pair);
      pair.*age = ages.now;
      EXPECT_EQ(reports.lists(pair), ages.is_listed) << ages.listed << " -> " << ages.now;
    }
  }
}

// Makes a report and a second one without news, which `change` may alter.
template <class Change>
bool second_is_full(std::uint64_t first_cycle, const Change& change) {
  ChangedPairs changes(kFullReports);
  Sample<clearance_msg_Distances> message;
  reserve_sequence(message->pairs, 3);
  const auto send = [&](std::uint64_t cycle, std::uint32_t pairs) {
    message->cycle = cycle;
    message->pairs._length = pairs;
    message->changes_since = 77;
  };
  send(first_cycle, 2);
  changes.reduce(*message);
  EXPECT_EQ(message->changes_since, first_cycle);
  EXPECT_EQ(message->pairs._length, 2u);
  send(first_cycle + 1, 2);
  change(*message);
  const std::uint32_t all = message->pairs._length;
  const std::uint64_t cycle = message->cycle;
  changes.reduce(*message);
  const bool is_full = message->changes_since == cycle;
  EXPECT_EQ(message->changes_since, is_full ? cycle : cycle - 1);
  EXPECT_EQ(message->pairs._length, is_full ? all : 0u);
  return is_full;
}

TEST(ChangedPairs, AreAllInAReportThatDoesNotFollowTheOneBefore) {
  EXPECT_FALSE(second_is_full(5, [](auto&) {}));
  EXPECT_TRUE(second_is_full(5, [](auto& message) { message.cycle = 7; })) << "one is missing";
  EXPECT_TRUE(second_is_full(5, [](auto& message) { message.cycle = 5; })) << "it comes again";
  EXPECT_TRUE(second_is_full(5, [](auto& message) { message.lineage = 1; }));
  EXPECT_TRUE(second_is_full(5, [](auto& message) { message.pairs._length = 3; }));
  EXPECT_TRUE(second_is_full(kFullReports - 1, [](auto&) {})) << "all come so often";
}

TEST(ChangedPairs, AreAllInAFirstReportWithoutPairs) {
  ChangedPairs changes(kFullReports);
  clearance_msg_Distances message{};
  message.cycle = 1;
  changes.reduce(message);
  EXPECT_EQ(message.changes_since, 1u);
}

TEST(ChangedPairs, AreLeftAsTheyAreIfAllReportsAreFull) {
  ChangedPairs changes(0);
  EXPECT_FALSE(changes.reduces());
  EXPECT_TRUE(ChangedPairs(1).reduces());
  Sample<clearance_msg_Distances> message;
  reserve_sequence(message->pairs, 1);
  for (message->cycle = 1; message->cycle < 4; ++message->cycle) {
    message->pairs._length = 1;
    message->changes_since = 3;
    changes.reduce(*message);
    EXPECT_EQ(message->pairs._length, 1u);
    EXPECT_EQ(message->changes_since, 0u);
  }
}

}  // namespace
}  // namespace clearance::test
