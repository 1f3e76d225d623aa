// The time of a simulation by the messages of its clock.
//
// Oracle: a simulation that the test plays, whose time at each true time is known.
#include "monitor/inputs/simulated_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kSecond = 1000 * kMillisecond;
constexpr std::int64_t kAhead = 1'700'000'000 * kSecond;  // of CLOCK_REALTIME before the other one

// A simulation of one speed, which sends its time every `step` of simulated time.
class Simulation {
 public:
  Simulation(double factor, std::int64_t step) : factor_(factor), step_(step) {}

  // Goes on until this true time, ns since the start.
  void play(std::int64_t until) {
    for (; now_ + interval() <= until; now_ += interval()) say(clock_ += step_);
  }
  void say(std::int64_t clock) {
    clock_ = clock;
    last_change = time.note(clock, kAhead + now_, now_);
  }
  void pass(std::int64_t ns) { now_ += ns; }
  // The simulated time after the last message, if it goes on as before.
  [[nodiscard]] double after(std::int64_t passed) const {
    return static_cast<double>(clock_) + factor_ * static_cast<double>(passed);
  }
  [[nodiscard]] std::int64_t interval() const {
    return std::llround(static_cast<double>(step_) / factor_);
  }
  [[nodiscard]] std::int64_t now() const { return now_; }
  [[nodiscard]] std::int64_t clock() const { return clock_; }

  SimulatedTime time;
  SimulatedTime::Change last_change = SimulatedTime::Change::kGoesOn;

 private:
  double factor_;
  std::int64_t step_, now_ = 5 * kSecond, clock_ = 100 * kSecond;
};

class SimulatedTimes : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Factors, SimulatedTimes, testing::Values(0.1, 1.0, 10.0));

TEST_P(SimulatedTimes, GoOnBetweenTwoMessagesAndNotBeyondTheNextOne) {
  Simulation of(GetParam(), kMillisecond);
  of.play(6 * kSecond);
  for (int tenths = 0; tenths <= 30; ++tenths) {
    const std::int64_t passed = of.interval() * tenths / 10;
    const double expected =
        std::min(of.after(passed), static_cast<double>(of.clock() + kMillisecond));
    // The last message came one interval ago.
    const std::int64_t came = of.now() - of.interval();
    EXPECT_NEAR(static_cast<double>(of.time.now_ns(came + passed)), expected, 2.0) << tenths;
  }
}

// By the ticks of a loop of 1 kHz, at any rate of the clock.
TEST_P(SimulatedTimes, NeverGoBackNorStandStillFromTickToTick) {
  for (const std::int64_t step : {kMillisecond, 4 * kMillisecond, 25 * kMillisecond}) {
    Simulation of(GetParam(), step);
    std::int64_t before = -1;
    for (std::int64_t t = 5 * kSecond; t < 8 * kSecond; t += kMillisecond) {
      of.play(t);
      const std::int64_t now = of.time.tick_time(t).now_ns;
      ASSERT_GT(now, before);
      if (of.time.is_known()) {
        EXPECT_GE(now, of.clock());
        EXPECT_LE(now, of.clock() + step + 1000) << "1 ns a tick";
      }
      before = now;
    }
    EXPECT_EQ(of.time.resets(), 0u);
  }
}

TEST_P(SimulatedTimes, OfMessagesAreThoseAtWhichTheyWereSent) {
  Simulation of(GetParam(), 10 * kMillisecond);
  of.play(7 * kSecond);
  const std::int64_t last = of.now() - of.interval();
  for (int i = 0; i < 100; ++i) {
    const std::int64_t ago = of.interval() * i / 7;
    const double expected = of.after(-ago);
    EXPECT_NEAR(static_cast<double>(of.time.at(kAhead + last - ago)), expected, 20.0) << i;
  }
}

// Messages of the clock are late by a step, as behind joints that a player hands over first. No
// joint is of the future, and the time is not ahead of the simulation.
TEST_P(SimulatedTimes, ReachTheStampsThatComeBeforeTheMessageOfTheirTime) {
  constexpr std::int64_t kBegin = 100 * kSecond;
  for (const std::int64_t step : {4 * kMillisecond, 20 * kMillisecond, 100 * kMillisecond}) {
    const auto true_ns = [](std::int64_t simulated_ns) {
      return std::llround(static_cast<double>(simulated_ns) / GetParam());
    };
    SimulatedTime time;
    std::int64_t clock = 0;
    int of_the_future = 0;
    for (std::int64_t truth = 0; truth < 60 * step; truth += step / 16) {
      for (; clock + step <= truth; clock += step)
        time.note(kBegin + clock, kAhead + true_ns(clock), kSecond + true_ns(clock + step));
      if (clock == 0) continue;
      const std::int64_t now = kSecond + true_ns(truth);
      of_the_future += time.now_ns(now) < kBegin + truth;
      time.lead(kBegin + truth);
      const std::int64_t told = time.tick_time(now).now_ns;
      ASSERT_GE(told, kBegin + truth);
      ASSERT_LE(told, kBegin + truth + 1000) << "1 ns a tick";
    }
    EXPECT_GT(of_the_future, 900) << "it would have been, unless it led";
  }
}

// A report that takes 8 ms is 80 simulated ms old at ten times the speed.
TEST_P(SimulatedTimes, PassInTrueTimeByTheirSpeed) {
  Simulation simulation(GetParam(), 10 * kMillisecond);
  simulation.play(7 * kSecond);
  const double passed = GetParam() * 8.0 * kMillisecond;
  EXPECT_NEAR(static_cast<double>(simulation.time.passes_in(8 * kMillisecond)), passed,
              1e-6 * passed + 1.0);
  EXPECT_EQ(simulation.time.passes_in(0), 0);
  simulation.pass(kMillisecond);
  simulation.say(simulation.clock());
  EXPECT_EQ(simulation.time.passes_in(8 * kMillisecond), 0) << "it is paused";
}

TEST(SimulatedTime, IsNotKnownBeforeTheFirstMessage) {
  SimulatedTime time;
  EXPECT_FALSE(time.is_known());
  EXPECT_FALSE(time.is_silent(50 * kSecond)) << "nothing has begun that could be silent";
  EXPECT_EQ(time.now_ns(50 * kSecond), 0);
  EXPECT_EQ(time.note(3, kAhead, 5 * kSecond), SimulatedTime::Change::kFirst);
  EXPECT_EQ(time.now_ns(5 * kSecond + 100 * kMillisecond), 3) << "no step is known yet";
}

// A paused simulation repeats its time. Ages stand still, to within 1 ns a tick.
TEST(SimulatedTime, StandsStillInAPause) {
  Simulation of(1.0, kMillisecond);
  of.play(6 * kSecond);
  const std::int64_t paused = of.clock();
  for (int i = 0; i < 5000; ++i) {
    of.pass(kMillisecond);
    of.say(paused);
    EXPECT_FALSE(of.time.is_silent(of.now()));
    const std::int64_t now = of.time.tick_time(of.now()).now_ns;
    EXPECT_LE(now, paused + kMillisecond + 5001);
  }
  of.play(of.now() + 100 * kMillisecond);
  EXPECT_GE(of.time.tick_time(of.now()).now_ns, paused + 99 * kMillisecond);
}

// A silent clock may be that of a dead simulation.
TEST(SimulatedTime, MakesAnUnknownTimePassOnceAfterASilence) {
  Simulation of(1.0, kMillisecond);
  of.play(6 * kSecond);
  int back = 0;
  std::int64_t before = of.time.tick_time(of.now()).now_ns;
  for (int i = 0; i < 3000; ++i) {
    of.pass(kMillisecond);
    const std::int64_t now = of.time.tick_time(of.now()).now_ns;
    if (now < before) {
      ++back;
      EXPECT_NEAR(i, 1000, 2) << "after a second";
      EXPECT_EQ(now, before - 1);
    }
    EXPECT_LE(now, of.clock() + kMillisecond + 3000) << "no wall time passes";
    before = now;
  }
  EXPECT_EQ(back, 1);
  EXPECT_TRUE(of.time.is_silent(of.now()));
  of.play(of.now() + 100 * kMillisecond);
  EXPECT_FALSE(of.time.is_silent(of.now()));
  EXPECT_GT(of.time.tick_time(of.now()).now_ns, before);
}

TEST(SimulatedTime, MakesAnUnknownTimePassIfTheSimulationBeginsAnew) {
  Simulation of(1.0, kMillisecond);
  of.play(6 * kSecond);
  const std::int64_t before = of.time.tick_time(of.now()).now_ns;
  of.say(2 * kSecond);
  EXPECT_EQ(of.last_change, SimulatedTime::Change::kBack);
  EXPECT_EQ(of.time.tick_time(of.now()).now_ns, 2 * kSecond);
  // Once more, and forward beyond the time before: between two ticks, this shows all the same.
  of.say(kSecond);
  of.pass(kMillisecond);
  of.say(200 * kSecond);
  EXPECT_LT(of.time.tick_time(of.now()).now_ns, 2 * kSecond);
  EXPECT_EQ(of.time.tick_time(of.now()).now_ns, 200 * kSecond);
  EXPECT_GT(of.time.tick_time(of.now()).now_ns, before);
  EXPECT_EQ(of.time.resets(), 2u);
}

TEST(SimulatedTime, JumpsForwardWithoutGoingOnAsFast) {
  Simulation of(1.0, kMillisecond);
  of.play(6 * kSecond);
  const std::int64_t jumped = of.clock() + 50 * kSecond;
  of.say(jumped);
  EXPECT_EQ(of.time.now_ns(of.now()), jumped);
  EXPECT_EQ(of.time.now_ns(of.now() + 500 * kMillisecond), jumped);
}

// Nothing is known of a message from before all that is kept, but that it is old.
TEST(SimulatedTime, OfAMessageFromBeforeTheFirstOneIsOlderThanIt) {
  Simulation of(10.0, kMillisecond);
  of.say(of.clock());
  for (const std::int64_t ago : {kMillisecond, kSecond, 1000 * kSecond}) {
    EXPECT_LE(of.time.at(kAhead + of.now() - ago), of.clock() - 10 * std::min(ago, 100 * kSecond));
  }
  EXPECT_EQ(SimulatedTime().at(kAhead), 0);
}

// The last 1,023 messages of the clock are known, here of 1 ms each.
TEST(SimulatedTime, OfAMessageFromBeforeAllThatIsKeptIsOlderThanTheOldestOfThem) {
  Simulation of(1.0, kMillisecond);
  of.play(8 * kSecond);
  const std::int64_t last = of.now() - kMillisecond, kept = 1022 * kMillisecond;
  for (const std::int64_t ago : {std::int64_t{0}, kept, kept + kMillisecond, 2 * kept}) {
    const std::int64_t expected =
        of.clock() - std::min(ago, kept) - 10 * std::max<std::int64_t>(0, ago - kept);
    EXPECT_NEAR(static_cast<double>(of.time.at(kAhead + last - ago)), static_cast<double>(expected),
                20.0);
  }
}

TEST(SimulatedTime, OfAMessageFromBeforeTheSimulationBeganAnewIsThatOfTheRunBefore) {
  Simulation of(1.0, 10 * kMillisecond);
  of.play(6 * kSecond);
  const std::int64_t last = of.now() - of.interval();
  const double expected = of.after(4 * kMillisecond);
  of.say(2 * kSecond);
  EXPECT_NEAR(static_cast<double>(of.time.at(kAhead + last + 4 * kMillisecond)), expected, 2.0);
  EXPECT_EQ(of.time.at(kAhead + of.now()), 2 * kSecond);
}

// Such a source has another clock, which says nothing of the time.
TEST(SimulatedTime, IsNotLedByAStampAheadByMoreThanTwoSteps) {
  constexpr std::int64_t kStep = 10 * kMillisecond, kMost = 2 * kStep + SimulatedTime::kLateNs;
  Simulation of(1.0, kStep);
  of.play(6 * kSecond);
  const std::int64_t now = of.time.now_ns(of.now());
  for (const std::int64_t ahead : {kMost + 1, kSecond, 3600 * kSecond}) {
    of.time.lead(of.clock() + ahead);
    EXPECT_EQ(of.time.now_ns(of.now()), now) << ahead;
  }
  of.time.lead(of.clock() + kMost);
  of.time.lead(of.clock() + kMost + 1);
  EXPECT_EQ(of.time.now_ns(of.now()), of.clock() + kMost) << "it does not undo what has led";
  EXPECT_EQ(of.time.latest_ns(), of.clock() + kMost);
}

// After a pause, joints come before the first message of a later time.
TEST(SimulatedTime, IsLedByAStampAfterAPause) {
  Simulation of(1.0, 10 * kMillisecond);
  of.play(6 * kSecond);
  for (int i = 0; i < 100; ++i) of.say(of.clock());
  of.time.lead(of.clock() + 10 * kMillisecond);
  EXPECT_EQ(of.time.now_ns(of.now()), of.clock() + 10 * kMillisecond);
}

// Steps vary.
TEST(SimulatedTime, IsLedByAStampAfterAStepThatWasShorterThanThoseBefore) {
  Simulation of(1.0, 20 * kMillisecond);
  of.play(6 * kSecond);
  of.say(of.clock() + 5 * kMillisecond);
  of.time.lead(of.clock() + 20 * kMillisecond);
  EXPECT_EQ(of.time.now_ns(of.now()), of.clock() + 20 * kMillisecond);
}

// At the first message, and after a jump or a new begin, no step is known.
TEST(SimulatedTime, IsLedByAStampBeforeAStepIsKnown) {
  Simulation of(1.0, 10 * kMillisecond);
  for (const std::int64_t begin : {100 * kSecond, 200 * kSecond, 10 * kSecond}) {
    of.say(begin);
    of.time.lead(begin + SimulatedTime::kLongestStepNs + SimulatedTime::kLateNs + 1);
    EXPECT_EQ(of.time.now_ns(of.now()), begin);
    of.time.lead(begin + 20 * kMillisecond);
    EXPECT_EQ(of.time.now_ns(of.now()), begin + 20 * kMillisecond);
    of.play(of.now() + kSecond);
  }
}

TEST(SimulatedTime, IsNotLedByTheStampsOfAnotherRun) {
  Simulation of(1.0, 10 * kMillisecond);
  of.play(6 * kSecond);
  of.time.lead(of.clock() + 11 * kMillisecond);
  EXPECT_EQ(of.time.tick_time(of.now()).now_ns, of.clock() + 11 * kMillisecond);
  of.say(2 * kSecond);
  EXPECT_EQ(of.time.now_ns(of.now()), 2 * kSecond);
  of.time.lead(2 * kSecond + 3 * kMillisecond);
  EXPECT_EQ(of.time.now_ns(of.now()), 2 * kSecond + 3 * kMillisecond);
  EXPECT_EQ(of.time.tick_time(of.now()).now_ns, 2 * kSecond + 3 * kMillisecond);
}

// The sender's clock is stepped, delays vary, the factor changes from message to message.
TEST(SimulatedTime, NeverGoesBackOrFartherAheadThanTwoStepsWhateverComes) {
  constexpr std::int64_t kFirst = SimulatedTime::kLongestStepNs;
  Random random(7);
  for (int run = 0; run < 50; ++run) {
    SimulatedTime time;
    std::int64_t now = kSecond, clock = 10 * kSecond, longest = 0, before = -1, first = 0;
    for (int i = 0; i < 2000; ++i) {
      now += random.integer(1, 3) * kMillisecond;
      if (random.chance(0.7)) {
        const std::int64_t step = random.chance(0.1) ? 0 : random.integer(1, 40) * kMillisecond / 4;
        longest = std::max(longest, step);
        const std::int64_t sent = kAhead + now + random.integer(-5, 5) * kMillisecond +
                                  (random.chance(0.01) ? -3600 * kSecond : 0);
        time.note(clock += step, sent, now);
      }
      if (random.chance(0.5)) time.lead(clock + random.integer(-40, 1200) * kMillisecond / 4);
      const std::int64_t told = time.tick_time(now).now_ns;
      ASSERT_GT(told, before);
      if (first == 0 && time.is_known()) first = clock;
      ASSERT_LE(told, std::max(clock + 2 * longest, first + kFirst) + SimulatedTime::kLateNs + i);
      if (time.is_known()) {
        ASSERT_GE(told, clock);
      }
      before = told;
    }
  }
}

}  // namespace
}  // namespace clearance
