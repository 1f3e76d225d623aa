// A daemon of a slow cell, and its partner, which the test plays.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "monitor/loop/tick_partner.hpp"
#include "tests/monitor/loop/listed_ports.hpp"

namespace clearance {
namespace {

using test::kTick;
using enum PartnerStanding;

constexpr std::int64_t kPeriod = 20 * kTick;

class TickPartnersOfASlowCell : public testing::Test {
 protected:
  // Decides on the next tick, so much later than it is due. Returns what the told time is behind
  // the clock.
  std::int64_t tick(std::int64_t late_ns) {
    deadline += kPeriod;
    clock.sleep_until(deadline + late_ns);
    static_cast<void>(ticks.decide(deadline, ++cycle, 0));
    return clock.realtime_ns() - ticks.time().now_ns;
  }
  void lead() {
    for (int i = 0; i < 5; ++i) tick(-ticks.ahead_ns());
    ASSERT_EQ(ticks.standing(), kLeading);
  }

  test::TurnedClock clock;
  test::ListedPoses poses;
  TickPartner ticks{
      poses,
      clock,
      {.period_ns = kPeriod, .daemon = 1, .batch = {.samples = 16}, .alone_after_ns = kPeriod}};
  std::int64_t deadline = clock.monotonic_ns();
  std::uint64_t cycle = 0;
};

// At 50 Hz half a period is 10 ms, as late as a successor's first tick. Poses that come until then
// would be refused if their stamps were 5 ms ahead of the told time.
TEST_F(TickPartnersOfASlowCell, ALateTickIsToldATimeThatPutsNoInputFarIntoTheFuture) {
  lead();
  const std::int64_t on_time = tick(-ticks.ahead_ns());
  EXPECT_LE(tick(9 * kTick) - on_time, 5 * kTick / 2);
  EXPECT_LE(std::abs(tick(-ticks.ahead_ns()) - on_time), kTick / 10) << "as before";
  EXPECT_LE(std::abs(tick(kTick) - on_time - kTick), kTick / 10) << "told when it was due";
}

// The leader has another cell, as after a command. Every second notice comes a little later than
// this daemon decides on its tick, which is itself a little late then.
TEST_F(TickPartnersOfASlowCell, ADaemonThatIsApartDoesNotLeadForNoticesThatAreALittleLate) {
  lead();
  TickNotice notice;
  notice.daemon = 2;
  notice.revision = 7;
  notice.term = 100;
  const auto hear = [&] {
    notice.cycle = cycle + 1;
    notice.due_ns = clock.monotonic_ns();
    ASSERT_TRUE(ticks.hear(notice));
  };
  for (int i = 0; i < 50; ++i) {
    const bool is_late = i % 2 != 0;
    if (!is_late) hear();
    tick(-ticks.ahead_ns() + (is_late ? kTick : 0));
    if (is_late) hear();
    ASSERT_EQ(ticks.standing(), kApart) << i;
  }
  for (int i = 0; i < 4; ++i) tick(-ticks.ahead_ns());
  EXPECT_EQ(ticks.standing(), kLeading) << "it was heard no more";
}

// The loop has skipped the ticks of the stop, so that the next one is not late. The thread that
// hears takes in what the partner has announced while this one waits for it.
TEST_F(TickPartnersOfASlowCell, ALeaderThatWasStoppedHearsTheOtherOneBeforeItTicksAgain) {
  lead();
  ticks.set_partner_present(true);
  TickNotice notice;
  notice.daemon = 2;
  notice.term = 100;
  notice.cycle = cycle + 20;
  constexpr std::int64_t kStopped = 20 * kPeriod;
  deadline += kStopped;
  notice.due_ns = clock.monotonic_ns() + kStopped;
  clock.while_asleep = [&, sleeps = 0](int) mutable {
    if (++sleeps == 1) return;  // until the tick
    EXPECT_TRUE(sleeps > 2 || ticks.hear(notice));
    ticks.end_pass();
  };
  tick(kTick);
  EXPECT_EQ(ticks.standing(), kApart);
}

}  // namespace
}  // namespace clearance
