// Inputs that lie, one fault at a time and in random mixes, judged by the true motion.
//
// The long campaign: CLEARANCE_LYING_SEEDS=45 monitor_tests --gtest_filter='*LyingInputs*'. It
// begins with the seed CLEARANCE_LYING_FIRST, usually 1.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "tests/monitor/adversary/lying_run.hpp"

namespace clearance::test::lies {
namespace {

// Pairs rest on inputs that are lost or late now and then.
constexpr double kAvailable = 0.99;

std::uint64_t stated(const char* variable, std::uint64_t usual) {
  const char* const asked = std::getenv(variable);
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : usual;
}
std::uint64_t seeds_of(std::uint64_t usual) { return stated("CLEARANCE_LYING_SEEDS", usual); }
std::uint64_t first_seed() { return stated("CLEARANCE_LYING_FIRST", 1); }

Verdict expect_truth(const Cell& cell, const LyingRun& run) {
  const Verdict verdict = judged(cell, run);
  EXPECT_TRUE(verdict.is_true() && verdict.least_certified >= kAvailable &&
              verdict.recovered <= verdict.recovers)
      << explained(cell, run, verdict);
  return verdict;
}

class LyingInputs : public testing::TestWithParam<Lie> {};

std::vector<Lie> all_kinds() {
  std::vector<Lie> all;
  for (std::size_t i = 0; i < kLies; ++i) all.push_back(static_cast<Lie>(i));
  return all;
}
std::string name_of(const testing::TestParamInfo<Lie>& tested) { return name(tested.param); }

INSTANTIATE_TEST_SUITE_P(Kinds, LyingInputs, testing::ValuesIn(all_kinds()), name_of);

// The channels that the kind strikes: all in the long campaign, else a ball, a robot, a frame of
// what follows tf, and one of what cameras and maps see, in turn.
std::vector<Channel> struck_by(Lie lie) {
  const bool is_long = seeds_of(1) > 1;
  constexpr std::array kSeen{Channel::kPoints, Channel::kEye, Channel::kPicture, Channel::kMap};
  const auto turn = static_cast<std::size_t>(lie) % kSeen.size();
  const std::array chosen{
      Channel::kBall0, Channel::kArm,      turn % 2 != 0 ? Channel::kOdom : Channel::kBase,
      kSeen[turn],     Channel::kCommands, Channel::kPartner};
  std::vector<Channel> struck;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    const bool is_chosen = is_long || std::ranges::count(chosen, channel) != 0;
    if (is_chosen && strikes(lie, channel)) struck.push_back(channel);
  }
  return struck;
}

// Until all pairs have to be certified again, and a little longer.
std::int64_t long_enough(const Fault& fault) { return fault.to + recovers(fault) + kSecond / 4; }

// The times until the faults of one kind were told, for the page of tools/evidence.
class Times {
 public:
  void add(const Detected& detected) {
    ++runs_;
    told_ += !detected.empty();
    for (const auto& [name, ticks] : detected) ticks_[name].push_back(ticks);
  }
  // "time until detected: NAME" has the median and the longest time in ticks, and the number of
  // runs.
  void record() {
    testing::Test::RecordProperty("faults told", fmt::format("{} of {}", told_, runs_));
    for (auto& [name, ticks] : ticks_) {
      std::ranges::sort(ticks);
      testing::Test::RecordProperty(
          "time until detected: " + name,
          fmt::format("{} {} {}", ticks[(ticks.size() - 1) / 2], ticks.back(), ticks.size()));
    }
  }

 private:
  std::size_t runs_ = 0, told_ = 0;
  std::map<std::string, std::vector<std::int64_t>> ticks_;
};

TEST_P(LyingInputs, OfOneKindGiveNoFalseBoundAndMissNoZone) {
  const Cell cell = lying_cell();
  const std::vector<Channel> struck = struck_by(GetParam());
  ASSERT_FALSE(struck.empty());
  Times times;
  for (const Channel channel : struck) {
    for (std::uint64_t seed = first_seed(); seed < first_seed() + seeds_of(1); ++seed) {
      Random random(100 * seed + static_cast<std::uint64_t>(channel));
      LyingRun run{.sending = {.seed = seed, .faults = {}}};
      run.sending.faults = {drawn(GetParam(), channel, random)};
      run.length = long_enough(run.sending.faults.front());
      times.add(expect_truth(cell, run).detected);
    }
  }
  times.record();
}

TEST(LyingInputsMixed, GiveNoFalseBoundAndMissNoZone) {
  const Cell cell = lying_cell();
  std::array<int, kLies> drawn{};
  std::uint64_t asked = 0, answered = 0, free = 0;
  std::int64_t recovered = 0;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + seeds_of(3); ++seed) {
    LyingRun run{.sending = {.seed = seed, .faults = drawn_mix(seed)}};
    run.sending.loss = seed % 3 == 0 ? 0.1 : 0.0;
    run.sending.jitter = seed % 2 == 0 ? 2 * kMs : 0;
    const Verdict verdict = expect_truth(cell, run);
    for (const Fault& fault : run.sending.faults) ++drawn[static_cast<std::size_t>(fault.lie)];
    asked += verdict.asked;
    answered += verdict.answered;
    free += verdict.free;
    recovered = std::max(recovered, verdict.recovered);
  }
  for (std::size_t i = 0; i < kLies; ++i)
    std::cout << name(static_cast<Lie>(i)) << ' ' << drawn[i] << ", ";
  std::cout << "questions " << asked << ", answered " << answered << ", free " << free
            << ", known again after " << recovered / kMs << " ms at most\n";
}

// Lost and late messages, joints that wrap, and joints that have turned 40,000 times are no
// faults.
TEST(TrueInputs, AreCertifiedNearlyAlwaysAndQuestionsAreAnswered) {
  const Cell cell = lying_cell();
  for (const bool wraps : {false, true}) {
    for (const bool far : {false, true}) {
      LyingRun run{.sending = {.seed = 5, .faults = {}, .loss = 0.1, .jitter = 2 * kMs}};
      run.sending.wraps = wraps;
      run.joints_went_far = far;
      SCOPED_TRACE(std::string(wraps ? "wrapped" : "not wrapped") + (far ? ", far" : ""));
      const Verdict verdict = expect_truth(cell, run);
      EXPECT_GT(verdict.answered, verdict.asked / 2) << verdict.text();
      EXPECT_GT(verdict.free, 0U);
    }
  }
}

// The time of all inputs is that of a simulation, which a tick of 1 kHz sees in steps of 0.1 and of
// 10 ms. Who else sends an input is decided in the machine's time, so faults may last longer.
TEST(SimulatedInputs, GiveNoFalseBoundAndMissNoZoneAtATenthAndTenTimesTheSpeed) {
  const Cell cell = lying_cell();
  for (const double factor : {0.1, 10.0}) {
    SCOPED_TRACE(factor);
    LyingRun run{.sending = {.seed = 5, .faults = {}, .loss = 0.1, .jitter = 2 * kMs}};
    run.sending.factor = factor;
    run.length = 3 * kSecond;
    static_cast<void>(expect_truth(cell, run));
    for (std::uint64_t seed = first_seed(); seed < first_seed() + seeds_of(2); ++seed) {
      run.sending.seed = seed;
      run.sending.faults = drawn_mix(seed);
      std::erase_if(run.sending.faults, [](const Fault& fault) {
        return fault.channel == Channel::kCommands || fault.channel == Channel::kPartner;
      });
      const Verdict verdict = judged(cell, run);
      EXPECT_TRUE(verdict.is_true()) << explained(cell, run, verdict);
    }
  }
}

}  // namespace
}  // namespace clearance::test::lies
