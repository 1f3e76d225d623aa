// Two partners without DDS: all orders of three events, from the start of both or from a leader on.
// Then nothing disturbs them any more, and they have to agree.
//
// Oracle: the checksums of the other daemon's report and state.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "monitor/loop/tick_partner.hpp"
#include "tests/monitor/loop/side.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

using test::Side;
using enum PartnerStanding;

constexpr int kJoinEvents = 3;
// A daemon that publishes nothing takes a leader to be gone after 100 ms, and one that hears none
// stands alone after 20 ticks. Then a state is given, and the next tick is the same.
constexpr int kAgreeWithin = 130;
constexpr const char* kEventNames[] = {"both", "left", "right", "left, unheard", "right, unheard"};

class TwoPartners {
 public:
  void begin_with_a_leader() {
    for (int i = 0; i < 30; ++i) {
      tick(left_);
      left_.drop_notices();
    }
    right_.rest_for(0);
  }
  void happen(std::size_t event) {
    if (event == 0) return tick_both();
    Side& side = event % 2 == 1 ? left_ : right_;
    Side& other = &side == &left_ ? right_ : left_;
    tick(side);
    event <= 2 ? side.tell(other) : side.drop_notices();
  }
  // What the daemons' threads do when one of them is apart.
  void exchange_states() {
    if (right_.ticks.wants_state() && left_.ticks.standing() == kLeading) left_.give_state(right_);
    if (left_.ticks.wants_state() && right_.ticks.standing() == kLeading) right_.give_state(left_);
  }
  void tick_both() {
    Side& leader = right_.ticks.standing() == kLeading ? right_ : left_;
    Side& other = &leader == &left_ ? right_ : left_;
    tick(leader);
    leader.tell(other);
    tick(other);
    other.tell(leader);
  }
  // One leads and the other follows, in one lineage: each tick() compares their bits by cycle.
  [[nodiscard]] bool agree() const {
    const PartnerStanding left = left_.ticks.standing(), right = right_.ticks.standing();
    return std::max(left, right) == kFollowing && std::min(left, right) == kLeading &&
           left_.tag.lineage == right_.tag.lineage && left_.spoke && right_.spoke;
  }

 private:
  // In every tick the source sends another pose, which both daemons hear.
  void tick(Side& side) {
    ++sent_;
    left_.get(sent_);
    right_.get(sent_);
    side.tick();
    // Both are on one machine.
    const std::int64_t now = std::max(left_.clock.monotonic_ns(), right_.clock.monotonic_ns());
    for (Side* each : {&left_, &right_}) each->clock.pass(now - each->clock.monotonic_ns());
    const std::pair bits{side.checksum, side.rest};
    const auto [known, is_new] = bits_.emplace(std::pair{side.tag.lineage, side.cycle}, bits);
    EXPECT_EQ(known->second, bits) << "cycle " << side.cycle << " of one lineage has two contents";
  }

  Scene scene_ = test::cell_of_partners();
  Side left_{scene_, 1}, right_{scene_, 2};
  std::uint64_t sent_ = 0;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::pair<std::uint64_t, std::uint64_t>> bits_;
};

TEST(EveryJoin, OfThreeEventsEndsInPartnersThatAgreeAndNeverHasTwoContentsOfACycle) {
  test::EveryChoice choice;
  int longest = 0;
  std::uint64_t runs = 0;
  for (; choice.next(); ++runs) {
    TwoPartners partners;
    if (choice.flag()) partners.begin_with_a_leader();
    std::string order;
    for (int i = 0; i < kJoinEvents; ++i) {
      const std::size_t event = choice.of(std::size(kEventNames));
      order += std::string(" ") + kEventNames[event] + ";";
      partners.happen(event);
      partners.exchange_states();
    }
    int ticks = 0;
    for (int agreed = 0; agreed < 3 && ticks <= kAgreeWithin; ++ticks) {
      partners.tick_both();
      agreed = partners.agree() ? agreed + 1 : 0;
      partners.exchange_states();
    }
    longest = std::max(longest, ticks);
    ASSERT_LE(ticks, kAgreeWithin) << order;
    ASSERT_FALSE(testing::Test::HasFailure()) << order;
  }
  EXPECT_GT(longest, 10) << "they have to join first";
  std::uint64_t all = 2;  // with a leader or without
  for (int i = 0; i < kJoinEvents; ++i) all *= std::size(kEventNames);
  EXPECT_EQ(runs, all);
}

}  // namespace
}  // namespace clearance
