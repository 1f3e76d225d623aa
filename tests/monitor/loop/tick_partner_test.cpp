// Two daemons without DDS: notices and states are carried by the test, in one thread and with
// clocks that the test moves.
//
// Oracle: the checksums of the other daemon's report and state.
#include "monitor/loop/tick_partner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/monitor/loop/side.hpp"

namespace clearance {
namespace {

using test::kTick;
using test::Side;
using enum PartnerStanding;

class TickPartners : public testing::Test {
 protected:
  Scene scene = test::cell_of_partners();
  Side left{scene, 1}, right{scene, 2};
  std::uint64_t sent = 0;

  void send() {
    ++sent;
    left.get(sent);
    right.get(sent);
  }
  // Both tick once; the one that leads first.
  void tick_both() {
    send();
    Side& leader = right.ticks.standing() == kLeading ? right : left;
    Side& other = &leader == &left ? right : left;
    leader.tick();
    leader.tell(other);
    other.tick();
    other.tell(leader);
  }
  void run_until_left_leads() {
    for (int i = 0; i < 30; ++i) {
      send();
      left.tick();
      left.drop_notices();
      right.clock.pass(kTick);
    }
    ASSERT_EQ(left.ticks.standing(), kLeading);
    right.rest_for(0);
  }
  void join() {
    run_until_left_leads();
    for (int i = 0; i < 3; ++i) tick_both();
    ASSERT_TRUE(right.ticks.wants_state());
    left.give_state(right);
    tick_both();
  }
  void expect_agreement() {
    EXPECT_EQ(left.cycle, right.cycle);
    EXPECT_EQ(left.tag.lineage, right.tag.lineage);
    EXPECT_EQ(left.now_ns, right.now_ns);
    EXPECT_EQ(left.used, right.used);
    EXPECT_EQ(left.checksum, right.checksum);
    EXPECT_EQ(left.rest, right.rest);
  }
};

TEST_F(TickPartners, ADaemonIsSilentUntilItKnowsThatItIsAlone) {
  for (int i = 0; i < 10; ++i) left.tick();
  EXPECT_EQ(left.ticks.standing(), kStarting);
  EXPECT_FALSE(left.spoke);
  for (int i = 0; i < 20; ++i) left.tick();
  EXPECT_EQ(left.ticks.standing(), kLeading);
  EXPECT_TRUE(left.spoke);
}

TEST_F(TickPartners, ADaemonThatJoinsHasTheSameBitsFromItsFirstReportOn) {
  join();
  EXPECT_TRUE(right.spoke);
  EXPECT_EQ(right.ticks.standing(), kFollowing);
  for (int i = 0; i < 100; ++i) {
    tick_both();
    expect_agreement();
    if (HasFailure()) return;
  }
}

TEST_F(TickPartners, TheFollowerUsesTheLeadersBatchesInTheLeadersOrder) {
  join();
  ++sent;
  left.get(sent, "arm");
  left.get(sent, "hand");
  right.get(sent, "hand");
  right.get(sent, "arm");
  right.get(sent + 1, "arm");
  left.tick();
  left.tell(right);
  right.tick();
  expect_agreement();
  EXPECT_EQ(right.used.size(), 2u);
  ++sent;
  left.get(sent, "arm");
  left.tick();
  left.tell(right);
  right.tick();
  expect_agreement();
  EXPECT_EQ(right.used, std::vector{sent}) << "it waited for the tick of the leader";
}

TEST_F(TickPartners, ATickTakesOneMessageAndOnlyTheLeaderSendsIt) {
  join();
  left.notices = right.notices = 0;
  for (int i = 0; i < 50; ++i) tick_both();
  EXPECT_EQ(left.notices, 50);
  EXPECT_EQ(right.notices, 0);
}

TEST_F(TickPartners, TheFollowerTakesTheLeadInTheTickThatTheLeaderDidNotAnnounce) {
  join();
  const std::uint64_t last = right.cycle;
  const std::int64_t before = right.now_ns;
  send();
  right.tick();
  EXPECT_EQ(right.ticks.standing(), kLeading);
  EXPECT_EQ(right.cycle, last + 1);
  EXPECT_GT(right.now_ns, before);
  EXPECT_LE(right.now_ns, before + 2 * kTick);
  EXPECT_EQ(right.used, std::vector{sent});
}

TEST_F(TickPartners, BothAreToldWhatTheLeaderHasMeasuredOfItsReports) {
  join();
  left.ticks.note_report_delay(3 * kTick);
  right.ticks.note_report_delay(50 * kTick);
  tick_both();
  expect_agreement();
  EXPECT_EQ(left.ticks.time().report_delay_ns, 3 * kTick);
  EXPECT_EQ(right.ticks.time().report_delay_ns, 3 * kTick);
  send();
  right.tick();
  ASSERT_EQ(right.ticks.standing(), kLeading);
  EXPECT_EQ(right.ticks.time().report_delay_ns, 50 * kTick) << "the other one is gone";
}

// The machine of both was busy for 20 ms, and the leader tells its late tick a later time.
TEST_F(TickPartners, ALateTickOfTheLeaderDoesNotSetTheTimeOfItsSuccessorAhead) {
  join();
  const auto ahead = [](auto& side) { return side.now_ns - side.clock.realtime_ns(); };
  tick_both();
  const std::int64_t before = ahead(right);
  for (int round = 0; round < 3; ++round) {
    left.clock.pass(20 * kTick);
    right.clock.pass(20 * kTick);
    tick_both();
    for (int i = 0; i < 10 && right.ticks.standing() != kLeading; ++i) right.tick();
  }
  ASSERT_EQ(right.ticks.standing(), kLeading);
  EXPECT_LT(std::abs(ahead(right) - before), kTick);
}

// The time of the former leader was 50 us ahead. Ages follow the clock that leads now, and change
// by no more than a thousandth of the time.
TEST_F(TickPartners, TheToldTimeApproachesTheClockOfTheLeader) {
  join();
  send();
  left.tick();
  for (; const TickNotice* told = left.ticks.notices().front(); left.ticks.notices().pop()) {
    TickNotice ahead = *told;
    ahead.time.now_ns += kTick / 20;
    ASSERT_TRUE(right.ticks.hear(ahead));
  }
  right.tick();
  for (int i = 0; i < 10 && right.ticks.standing() != kLeading; ++i) right.tick();
  ASSERT_EQ(right.ticks.standing(), kLeading);
  const auto ahead = [&] { return right.now_ns - right.clock.realtime_ns(); };
  right.tick();
  EXPECT_GT(ahead(), kTick / 40);
  for (int i = 0; i < 100; ++i) {
    const std::int64_t before = ahead();
    right.tick();
    EXPECT_LE(std::abs(ahead() - before), kTick / 1000);
  }
  EXPECT_LE(std::abs(ahead()), kTick / 1000);
}

// The leader was stopped and goes on: it ticks what the other one has announced meanwhile, and then
// has the same bits without another state.
TEST_F(TickPartners, ALeaderThatWasStoppedFollowsTheOneThatWentOn) {
  join();
  for (int i = 0; i < 30; ++i) {
    send();
    right.tick();
    right.tell(left);
  }
  ASSERT_EQ(right.ticks.standing(), kLeading);
  left.rest_for(30 * kTick);
  for (int i = 0; i < 30; ++i) left.tick();
  EXPECT_EQ(left.ticks.standing(), kFollowing);
  expect_agreement();
  for (int i = 0; i < 20; ++i) {
    tick_both();
    expect_agreement();
  }
}

// A daemon was stopped, and the notice of its next tick was heard when it went on.
TEST_F(TickPartners, ANoticeThatWasHeardLateDoesNotSetTheToldTimeBack) {
  constexpr std::int64_t kStopped = 1'500'000'000;
  join();
  for (int i = 0; i < 5; ++i) tick_both();
  const std::int64_t ahead = right.now_ns - right.clock.realtime_ns();
  send();
  left.tick();
  TickNotice late = *left.ticks.notices().front();
  left.drop_notices();
  late.due_ns += kStopped;
  right.rest_for(kStopped);
  ASSERT_TRUE(right.ticks.hear(late));
  for (int i = 0; i < 50; ++i) {
    send();
    right.tick();
  }
  ASSERT_EQ(right.ticks.standing(), kLeading);
  EXPECT_LT(std::abs(right.now_ns - right.clock.realtime_ns() - ahead), 10 * kTick);
}

TEST_F(TickPartners, ADaemonThatTickedOtherInputsIsApartUntilItHasTheOthersState) {
  join();
  send();
  left.tick();
  left.drop_notices();
  right.tick();
  right.tell(left);
  ASSERT_EQ(right.ticks.standing(), kLeading);
  tick_both();
  EXPECT_EQ(left.ticks.standing(), kApart);
  EXPECT_TRUE(left.spoke) << "its reports are true";
  EXPECT_NE(left.tag.lineage, right.tag.lineage);
  EXPECT_TRUE(left.ticks.wants_state());
  right.give_state(left);
  tick_both();
  expect_agreement();
}

TEST_F(TickPartners, ABatchThatHasNotComeIsWaitedForAndThenTheTickRestsOnOtherInputs) {
  join();
  ++sent;
  left.get(sent);
  left.tick();
  left.tell(right);
  right.tick();
  EXPECT_EQ(right.ticks.standing(), kApart);
  EXPECT_NE(left.tag.lineage, right.tag.lineage);
  EXPECT_EQ(right.cycle, left.cycle);
}

// A daemon that was stopped lacks the batches of that time. Its cycles would come a second time.
TEST_F(TickPartners, ADaemonThatCountsLowerIsSilentUntilItHasTheOthersState) {
  join();
  for (int i = 0; i < 30; ++i) {
    ++sent;
    right.get(sent);
    right.tick();
    right.tell(left);
  }
  left.rest_for(30 * kTick);
  for (int i = 0; i < 3; ++i) tick_both();
  EXPECT_EQ(left.ticks.standing(), kApart);
  EXPECT_FALSE(left.spoke);
  right.give_state(left);
  tick_both();
  EXPECT_TRUE(left.spoke);
  expect_agreement();
}

// With the state it would lack what the leader names next, and be apart again.
TEST_F(TickPartners, ADaemonWantsNoStateBeforeItHasTheInputsThatItsLeaderNames) {
  run_until_left_leads();
  const auto tick_with = [this](bool right_hears) {
    left.get(++sent);
    if (right_hears) right.get(sent);
    left.tick();
    left.tell(right);
    right.tick();
  };
  for (int i = 0; i < 3; ++i) tick_with(false);
  EXPECT_FALSE(right.ticks.wants_state());
  tick_with(true);
  EXPECT_TRUE(right.ticks.wants_state());
  tick_with(false);
  EXPECT_TRUE(right.ticks.wants_state()) << "one batch that is late changes nothing";
}

// A pose that is sent once reached this daemon alone, and the leader ends before it has it.
TEST_F(TickPartners, WhatADaemonHasUsedApartCountsAgainAfterItJoins) {
  run_until_left_leads();
  for (int i = 0; i < 3; ++i) tick_both();
  ASSERT_TRUE(right.ticks.wants_state());
  ++sent;
  right.get(sent, "once");
  right.tick();
  EXPECT_EQ(right.used, std::vector{sent});
  left.tick();
  left.tell(right);
  left.give_state(right);
  right.tick();
  for (int i = 0; i < 10 && right.ticks.standing() != kLeading; ++i) {
    right.used.clear();
    right.tick();
  }
  ASSERT_EQ(right.ticks.standing(), kLeading);
  EXPECT_EQ(std::ranges::count(right.used, sent), 1);
}

// 0 is no lineage: a leader without a successor states it in every notice.
TEST_F(TickPartners, AStateWithoutALineageLetsNoDaemonFollow) {
  run_until_left_leads();
  for (int i = 0; i < 3; ++i) tick_both();
  left.give_state(right);
  right.ticks.joined(0, right.state.cycle());
  tick_both();
  EXPECT_EQ(right.ticks.standing(), kApart);
}

// A bit of the leader's notice has flipped, or a stranger has written it.
TEST_F(TickPartners, ANoticeWithATimeThatNoLeaderCanHaveCountsAsNotHeard) {
  const auto due = [](std::int64_t by) { return std::pair(by, std::int64_t{0}); };
  const auto told = [](std::int64_t by) { return std::pair(std::int64_t{0}, by); };
  constexpr std::int64_t kHours = std::int64_t{1} << 43, kMost = std::int64_t{1} << 62;
  join();
  std::uint64_t refused = 0;
  for (const bool is_first : {true, false}) {
    for (const auto& [due_by, told_by] :
         {due(kHours), due(-kHours), due(4 * kTick), due(-4 * kTick), due(-kMost), told(kHours),
          told(-kHours), told(200 * kTick), told(-200 * kTick), told(-kMost)}) {
      SCOPED_TRACE(testing::Message() << due_by << ' ' << told_by);
      send();
      left.tick();
      TickNotice forged = *left.ticks.notices().front();
      forged.due_ns += due_by;
      forged.time.now_ns += told_by;
      if (!is_first) left.tell(right);
      ASSERT_TRUE(right.ticks.hear(forged));
      left.tell(right);
      right.tick();
      EXPECT_EQ(right.ticks.standing(), kFollowing);
      EXPECT_EQ(right.ticks.refused_notices(), ++refused);
      expect_agreement();
    }
  }
}

TEST_F(TickPartners, AFollowerDoesNotWaitForATickThatIsDueHoursLater) {
  join();
  send();
  left.tick();
  TickNotice late = *left.ticks.notices().front();
  late.due_ns += std::int64_t{1} << 43;
  ASSERT_TRUE(right.ticks.hear(late));
  const std::int64_t before = right.clock.monotonic_ns();
  right.tick();
  EXPECT_LT(right.clock.monotonic_ns() - before, 3 * kTick);
  EXPECT_EQ(right.ticks.standing(), kLeading);
}

TEST_F(TickPartners, TheOlderOfTwoThatWereAloneLeads) {
  for (int i = 0; i < 30; ++i) {
    send();
    left.tick();
    right.tick();
    left.drop_notices();
    right.drop_notices();
  }
  ASSERT_EQ(left.ticks.standing(), kLeading);
  ASSERT_EQ(right.ticks.standing(), kLeading);
  for (int i = 0; i < 3; ++i) {
    send();
    left.tick();
    right.tick();
    left.tell(right);
    right.tell(left);
  }
  EXPECT_EQ(left.ticks.standing(), kLeading);
  EXPECT_EQ(right.ticks.standing(), kApart);
}

}  // namespace
}  // namespace clearance
