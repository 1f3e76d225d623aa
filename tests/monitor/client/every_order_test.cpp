// All orders of six messages of two partners: what a client is handed out, and what it is told of
// the partner.
//
// Oracle: the list of all messages so far.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include "monitor/client/partner_merge.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/report_check.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance::client {
namespace {

constexpr std::int64_t kOrderPeriodNs = 1'000'000, kOrderStartNs = 1'700'000'000'000'000'000;
constexpr int kOrderedMessages = 6;

// The choices of a partner for its next report.
enum class Sending : std::uint8_t { kSends, kSkips, kSendsOtherBits, kSendsAFlippedBit, kCount };

clearance_msg_Distances message_of(std::size_t partner, std::uint64_t cycle, Sending event) {
  clearance_msg_Distances message{};
  std::strcpy(message.partner, partner == 0 ? "left" : "right");
  message.daemon = partner + 1;
  message.cycle = cycle;
  message.lineage = 1;
  message.now_ns = kOrderStartNs + static_cast<std::int64_t>(cycle) * kOrderPeriodNs;
  message.lower_all = event == Sending::kSendsOtherBits ? 0.25 : 0.5;
  seal(message, 0);
  if (event == Sending::kSendsAFlippedBit) message.lower_all = -message.lower_all;
  return message;
}

// All that was heard, in its order.
class Heard {
 public:
  // Whether the message is to be handed out: it is sound, and of a later cycle than all before.
  bool add(std::size_t partner, std::uint64_t cycle, Sending event) {
    if (event == Sending::kSendsAFlippedBit) {
      worst_ = PartnerState::kCorrupt;
      return false;
    }
    partners_.insert(partner);
    const bool is_next = cycle > last_;
    if (is_next) {
      expected_ = worst_;
      if (worst_ == PartnerState::kAlone && partners_.size() == 2 && last_ != 0)
        expected_ = PartnerState::kMissing;
      worst_ = PartnerState::kAlone;
      last_ = cycle;
      handed_out_.insert({cycle, partner, event});
    } else if (const auto* const other = of_other(partner, cycle)) {
      const bool is_same = other->event == event;
      worst_ = std::max(worst_, is_same ? PartnerState::kAgrees : PartnerState::kDifferent);
    }
    return is_next;
  }
  [[nodiscard]] PartnerState expected() const { return expected_; }

 private:
  struct HandedOut {
    std::uint64_t cycle;
    std::size_t partner;
    Sending event;
    auto operator<=>(const HandedOut&) const = default;
  };
  [[nodiscard]] const HandedOut* of_other(std::size_t partner, std::uint64_t cycle) const {
    const auto found = std::ranges::find_if(handed_out_, [&](const HandedOut& one) {
      return one.cycle == cycle && one.partner != partner;
    });
    return found == handed_out_.end() ? nullptr : &*found;
  }
  std::set<HandedOut> handed_out_;
  std::set<std::size_t> partners_;
  std::uint64_t last_ = 0;
  PartnerState worst_ = PartnerState::kAlone, expected_ = PartnerState::kAlone;
};

TEST(EveryOrder, OfSixMessagesHandsOutEachCycleOnceAndTellsTheWorstSince) {
  test::EveryChoice choice;
  while (choice.next()) {
    PartnerMerge merge;
    Heard heard;
    std::uint64_t next[2] = {1, 1};
    std::string order;
    for (int i = 0; i < kOrderedMessages; ++i) {
      const std::size_t partner = choice.of(2);
      const auto event = static_cast<Sending>(choice.of(static_cast<std::size_t>(Sending::kCount)));
      const std::uint64_t cycle = next[partner]++;
      order +=
          (partner == 0 ? " l" : " r") + std::to_string(cycle) + "sxob"[static_cast<int>(event)];
      if (event == Sending::kSkips) continue;
      const clearance_msg_Distances message = message_of(partner, cycle, event);
      const bool is_sound = has_its_crc(message);
      ASSERT_EQ(is_sound, event != Sending::kSendsAFlippedBit);
      const bool is_next = heard.add(partner, cycle, event);
      ASSERT_EQ(merge.take(message, (i + 1) * kOrderPeriodNs / 2, is_sound), is_next) << order;
      ASSERT_EQ(merge.check().state, heard.expected()) << order;
    }
  }
  EXPECT_EQ(choice.runs(), std::size_t{8 * 8 * 8 * 8 * 8 * 8});
}

}  // namespace
}  // namespace clearance::client
