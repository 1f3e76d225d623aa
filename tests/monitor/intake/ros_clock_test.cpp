// Messages of /clock, and the times of all others while it counts.
#include <gtest/gtest.h>

#include <limits>

#include "monitor/inputs/simulated_time.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kMs = 1'000'000, kSecond = 1000 * kMs;

class RosClockTest : public testing::Test {
 protected:
  bool say(std::int64_t time_ns, std::uint64_t writer = 9) {
    Sample<rosgraph_msgs_msg_dds__Clock_> message;
    message->clock = {static_cast<std::int32_t>(time_ns / kSecond),
                      static_cast<std::uint32_t>(time_ns % kSecond)};
    CdrEncoder encoder;
    const auto bytes = encoder.encode(*message);
    return heard.take(
        {"/clock", "rosgraph_msgs/msg/Clock", heard.now.realtime_ns, {bytes.begin(), bytes.end()}},
        writer);
  }
  bool send(std::int64_t stamp_ns) {
    return heard.take(
        joint_state(heard.now.realtime_ns, stamp_ns, {{"shoulder"}, {0.1}}, "/left/joint_states"));
  }

  Cell cell = two_scara_arms();
  SimulatedTime time;
  Heard heard{cell, {.time = &time}};
};

TEST_F(RosClockTest, NothingCountsBeforeItsFirstMessageAndTheLogSaysWhy) {
  heard.settle();
  heard.settle();
  EXPECT_EQ(heard.told(lines::kSimTimeAwaited.code), 1u);
  EXPECT_TRUE(send(100 * kSecond));
  EXPECT_TRUE(heard.all().empty());
  EXPECT_TRUE(say(100 * kSecond));
  EXPECT_EQ(heard.told(lines::kSimTimeHeard.code), 1u);
  EXPECT_TRUE(send(100 * kSecond));
  EXPECT_EQ(heard.one().joints.front().stamp_ns, 100 * kSecond);
}

// A stamp of 0 is replaced by the time of sending, which is that of the simulation as well.
TEST_F(RosClockTest, GivesTimesOfSendingToo) {
  say(100 * kSecond);
  heard.pass(10 * kMs);
  say(100 * kSecond + kMs);
  heard.pass(5 * kMs);
  send(0);
  EXPECT_EQ(heard.one().joints.front().stamp_ns, 100 * kSecond + kMs + kMs / 2)
      << "at a tenth of the true time";
  for (int i = 0; i < 20; ++i) send(100 * kSecond + kMs);
  EXPECT_EQ(heard.told(lines::kOtherClock.code), 0u) << "its stamps are of this clock";
}

TEST_F(RosClockTest, TellsOfASilenceAndOfANewBegin) {
  say(100 * kSecond);
  heard.pass(2 * kSecond);
  heard.settle();
  heard.settle();
  EXPECT_EQ(heard.told(lines::kSimTimeSilent.code), 1u);
  say(101 * kSecond);
  EXPECT_EQ(heard.told(lines::kSimTimeHeard.code), 2u) << "once more, after the silence";
  say(3 * kSecond);
  EXPECT_EQ(heard.told(lines::kSimTimeBack.code), 1u);
  EXPECT_EQ(time.resets(), 1u);
}

TEST_F(RosClockTest, IsThatOfOnePublisherWhileItIsThereAndHeard) {
  say(100 * kSecond);
  EXPECT_TRUE(say(5 * kSecond, 10));
  EXPECT_TRUE(say(5 * kSecond, 10));
  EXPECT_EQ(time.clock_ns(), 100 * kSecond);
  EXPECT_EQ(heard.told(lines::kTwoClocks.code), 1u);
  heard.intake.keep({10});
  say(5 * kSecond, 10);
  EXPECT_EQ(time.clock_ns(), 5 * kSecond) << "the first one has left";
  heard.pass(2 * kSecond);
  say(7 * kSecond, 11);
  EXPECT_EQ(time.clock_ns(), 7 * kSecond) << "the second one is silent, as after a crash";
}

TEST_F(RosClockTest, RefusesATimeBeforeZero) {
  EXPECT_FALSE(say(-kSecond));
  EXPECT_FALSE(time.is_known());
}

TEST(RosClock, IsReadWhereItCountsAlone) {
  const Cell cell = two_scara_arms();
  SimulatedTime time;
  for (const bool counts : {false, true}) {
    Heard heard(cell, {.time = counts ? &time : nullptr});
    const auto is_clock = [](const NamedTopic& named) { return named.name == "/clock"; };
    EXPECT_EQ(std::ranges::any_of(heard.intake.named(), is_clock), counts);
    EXPECT_EQ(heard.intake.topic({"/clock", "rosgraph_msgs/msg/Clock"}).has_value(), counts);
    heard.settle();
    EXPECT_EQ(heard.news.size(), counts ? 1u : 0u);
  }
}

}  // namespace
}  // namespace clearance::test
