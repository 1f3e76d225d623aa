// What the loop tells its ticks of how long reports took, and of the ages of inputs.
//
// Oracle: the largest of a list of delays, by the time of each.
#include "monitor/loop/report_delay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "monitor/loop/response_times.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/tick/two_balls.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kWindow = ReportDelay::kWindowNs;

TEST(ReportDelay, IsTheLongestOfOneToTwoWindows) {
  Random random(62);
  ReportDelay delay;
  EXPECT_EQ(delay.longest_ns(), TickTime::kNotMeasured);
  std::map<std::int64_t, std::int64_t> all;
  std::int64_t now = 0;
  for (int i = 0; i < 20'000; ++i) {
    now += random.chance(0.001) ? 3 * kWindow : random.integer(1, 2'000'000);
    const std::int64_t last = random.chance(0.3)    ? TickTime::kNotMeasured
                              : random.chance(0.01) ? random.integer(0, 100'000'000)
                                                    : random.integer(0, 100'000);
    delay.add(now, last);
    all[now] = last;
    std::int64_t least = TickTime::kNotMeasured, most = TickTime::kNotMeasured;
    for (auto at = all.rbegin(); at != all.rend() && now - at->first < 2 * kWindow; ++at) {
      most = std::max(most, at->second);
      if (now - at->first < kWindow) least = std::max(least, at->second);
    }
    ASSERT_GE(delay.longest_ns(), least) << i;
    ASSERT_LE(delay.longest_ns(), most) << i;
    while (all.begin()->first < now - 2 * kWindow) all.erase(all.begin());
  }
}

// A sink that publishes each report so long after its tick.
class PublishingSink final : public ReportSink {
 public:
  void input(const PoseBatch&) noexcept override {}
  void start(const ReportStart& start) noexcept override { starts.push_back(start); }
  std::int64_t longest_delay(std::int64_t) noexcept override {
    return starts.empty() ? TickTime::kNotMeasured : delays.at(starts.size() - 1);
  }
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    told.push_back(report.report_delay_ns);
    unknown.push_back(report.unknown > 0);
  }
  void statistics(const LoopStatistics& all) noexcept override {
    late_responses = all.late_responses;
  }

  std::vector<std::int64_t> delays, told;
  std::vector<bool> unknown;
  std::vector<ReportStart> starts;
  std::uint64_t late_responses = 0;
};

struct RunOf {
  RunOf(Scene the_scene, std::vector<std::int64_t> delays, PoseSource& poses)
      : scene(std::move(the_scene)) {
    sink.delays = std::move(delays);
    TickLoop loop(scene, poses, {&sink}, clock, {.max_ticks = sink.delays.size()});
    const std::atomic<bool> stop = false;
    loop.run(stop);
  }
  Scene scene;
  test::TurnedClock clock;
  PublishingSink sink;
};

TEST(TickLoop, TellsEachTickTheLongestDelayThatWasMeasuredBefore) {
  test::ListedPoses none;
  const RunOf run(test::two_balls(), {5, 3, 9, 4, 4}, none);
  EXPECT_EQ(run.sink.told, (std::vector<std::int64_t>{TickTime::kNotMeasured, 5, 5, 9, 9}));
}

TEST(TickLoop, BeyondTheResponseLimitReportsAreFailSafeUntilTheDelayIsForgotten) {
  Scene scene = test::balls_of_speed(2.0);
  scene.response_limit_ns = 10 * test::kTick;
  scene.objects[0].age_limit_ns = 100'000 * test::kTick;
  scene.rate_hz = 10;
  // A source sends before each tick; the clock of the test begins at kStart.
  class Sending final : public PoseSource {
   public:
    const PoseBatch* next() noexcept override {
      sent_ = !sent_;
      if (!sent_) return nullptr;
      ++batch_.sequence_number;
      batch_.source = SourceName("arm");
      batch_.samples = {test::sample(
          0, test::at(0, 0, 0),
          test::kStart + static_cast<std::int64_t>(batch_.sequence_number) * 100 * test::kTick)};
      return &batch_;
    }

   private:
    PoseBatch batch_;
    bool sent_ = false;
  } poses;
  std::vector<std::int64_t> delays(200, test::kTick);
  delays[20] = 11 * test::kTick;
  const RunOf run(scene, delays, poses);
  EXPECT_TRUE(run.sink.unknown[0]) << "nothing is measured yet";
  std::size_t fail_safe = 0;
  for (std::size_t i = 1; i < 200; ++i) {
    const bool may_be = i > 20 && i <= 21 + 100;  // one window to two
    EXPECT_TRUE(may_be || !run.sink.unknown[i]) << i;
    fail_safe += run.sink.unknown[i];
  }
  EXPECT_TRUE(run.sink.unknown[21]) << "the tick after the slow report";
  EXPECT_GE(fail_safe, 50u) << "5 s at 10 Hz";
  EXPECT_EQ(run.sink.late_responses, fail_safe);
}

// Each source counts with the oldest sample that it sent last.
TEST(TickLoop, TellsHowOldTheValuesAreThatEachSourceSentLast) {
  test::ListedPoses poses;
  poses.add("arm", 1, 2);
  poses.last().samples[0].stamp_ns = test::kStart - 3 * test::kTick;
  poses.last().samples[1].stamp_ns = test::kStart - 7 * test::kTick;
  const RunOf run(test::two_balls(), std::vector<std::int64_t>(1'200, 0), poses);
  const auto age = [&](std::size_t tick) {
    return std::ranges::max(run.sink.starts[tick].ages_ns);
  };
  const std::int64_t first_now = run.sink.starts[0].told_ns;
  EXPECT_EQ(age(0), first_now + 7 * test::kTick);
  EXPECT_EQ(age(10), age(0) + 10 * test::kTick) << "it is silent";
  EXPECT_EQ(age(1'199), -1) << "after a second it has no part in the report";
}

TEST(ResponseTimes, AreAgeAndDelayAndBeginAnewWithAnotherName) {
  ResponseTimes times;
  ReportStart start;
  start.ages_ns.fill(-1);
  times.add(start, 5);
  EXPECT_EQ(times.slowest().count(), 0u) << "nothing was sent";
  EXPECT_EQ(times.delays().max_ns(), 5);
  start.ages_ns[0] = 10;
  start.ages_ns[kMaxSources] = 30;
  times.add(start, 7);
  LoopStatistics statistics;
  statistics.sources[0] = SourceName("arm");
  Scene scene = test::two_balls();
  scene.sensors.emplace_back().name = "eye";
  times.name(statistics, scene);
  EXPECT_EQ(times.slowest().max_ns(), 37);
  std::vector<InputResponse> inputs = times.inputs();
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0].input, "sensor eye");
  EXPECT_EQ(inputs[0].max_ns, 37);
  EXPECT_EQ(inputs[1].input, "arm");
  EXPECT_EQ(inputs[1].p50_ns, 17);
  statistics.sources[0] = SourceName("tracker");
  times.name(statistics, scene);
  inputs = times.inputs();
  ASSERT_EQ(inputs.size(), 1u) << "the tracker has sent nothing yet";
  EXPECT_EQ(inputs[0].input, "sensor eye");
}

}  // namespace
}  // namespace clearance
