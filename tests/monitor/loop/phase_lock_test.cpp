// Ticks that follow a source: samples come shortly before their tick, whatever clock their source
// has.
//
// Oracle: a source in time, and the loop on a clock that the test turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMicrosecond = 1'000, kTickPeriod = 1'000 * kMicrosecond;

// Sends the joints of the robot, or the pose of an object, at these times, and notes how long each
// batch waits for its tick.
class FollowedSource final : public PoseSource {
 public:
  FollowedSource(test::TurnedClock& clock, std::vector<std::int64_t> came, const Scene& scene,
                 std::optional<std::uint32_t> object)
      : clock_(clock), came_(std::move(came)) {
    batch_.source = SourceName("driver");
    if (object) {
      batch_.scene_revision = scene.revision;
      batch_.samples = {test::sample(*object, Pose{}, test::kStart)};
    } else {
      batch_.joints = {test::joint(0, 0.1, test::kStart)};
    }
  }
  const PoseBatch* next() noexcept override {
    const std::int64_t now = clock_.monotonic_ns();
    if (next_ == came_.size() || came_[next_] > now) return nullptr;
    batch_.came_ns = came_[next_++];
    ++batch_.sequence_number;
    waits.push_back(now - batch_.came_ns);
    return &batch_;
  }
  std::vector<std::int64_t> waits;  // ns

 private:
  test::TurnedClock& clock_;
  std::vector<std::int64_t> came_;
  std::size_t next_ = 0;
  PoseBatch batch_;
};

struct Followed {
  std::vector<std::int64_t> waits, ticks;  // ns
};

Followed followed(const std::vector<std::int64_t>& came, std::uint64_t ticks,
                  std::uint32_t robot = 0, std::optional<std::uint32_t> object = {}) {
  Scene scene = test::scara_cell();
  scene.tick_on = robot;
  if (object) scene.tick_on_object = *object;
  test::TurnedClock clock;
  FollowedSource source(clock, came, scene, object);
  test::ListedReports reports(clock);
  TickLoop loop(scene, source, {&reports}, clock, {.max_ticks = ticks});
  const std::atomic<bool> stop = false;
  loop.run(stop);
  return {source.waits, reports.times_ns};
}

// `jitter`: the largest delay of a batch, ns.
std::vector<std::int64_t> sent_each(double period, std::int64_t phase, std::int64_t jitter,
                                    int count) {
  Random random(7);
  std::vector<std::int64_t> came;
  for (int i = 0; i < count; ++i)
    came.push_back(
        phase + std::llround(i * period + random.uniform(0.0, 1.0) * static_cast<double>(jitter)));
  return came;
}

std::int64_t quantile(std::vector<std::int64_t> all, double share) {
  std::ranges::sort(all);
  return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
}
std::vector<std::int64_t> after(const std::vector<std::int64_t>& all, std::size_t first) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.end()};
}

void expect_no_jump(const std::vector<std::int64_t>& ticks) {
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const std::int64_t apart = ticks[i] - ticks[i - 1];
    ASSERT_LE(std::abs(apart - kTickPeriod), kTickPeriod / PhaseLock::kMostSlew) << "tick " << i;
  }
}

TEST(PhaseLock, SamplesComeShortlyBeforeTheirTickFromAnyPhaseAndWithAnotherClock) {
  for (const double period : {1e6, 1e6 * (1 + 2e-4), 1e6 * (1 - 2e-4)}) {
    for (const std::int64_t phase :
         {100 * kMicrosecond, 350 * kMicrosecond, 600 * kMicrosecond, 990 * kMicrosecond}) {
      const Followed run = followed(sent_each(period, phase, 0, 3'000), 3'000);
      EXPECT_LT(quantile(after(run.waits, 500), 0.99), 60 * kMicrosecond)
          << period << ", " << phase;
      expect_no_jump(run.ticks);
    }
  }
}

TEST(PhaseLock, FollowsThePosesOfAnObjectAsWell) {
  const Scene scene = test::scara_cell();
  const auto cart = std::ranges::find(scene.objects, "cart", &Object::name);
  ASSERT_NE(cart, scene.objects.end());
  const auto object = static_cast<std::uint32_t>(cart - scene.objects.begin());
  const std::vector<std::int64_t> came = sent_each(1e6, 350 * kMicrosecond, 0, 3'000);
  const Followed run = followed(came, 3'000, Scene::kFreeRunning, object);
  EXPECT_LT(quantile(after(run.waits, 500), 0.99), 60 * kMicrosecond);
  expect_no_jump(run.ticks);
}

TEST(PhaseLock, LeadsByTheJitterOfTheSourceSoThatFewSamplesWaitForAPeriod) {
  const Followed run =
      followed(sent_each(1e6, 300 * kMicrosecond, 100 * kMicrosecond, 20'000), 20'000);
  const std::vector<std::int64_t> waits = after(run.waits, 2'000);
  const auto late =
      std::ranges::count_if(waits, [](std::int64_t ns) { return ns > kTickPeriod / 2; });
  EXPECT_LT(static_cast<double>(late), 0.02 * static_cast<double>(waits.size()));
  EXPECT_LT(quantile(waits, 0.5), 120 * kMicrosecond);
  expect_no_jump(run.ticks);
}

TEST(PhaseLock, FollowsASourceThatIsSlowerThanTheTicksByAMultiple) {
  const Followed run = followed(sent_each(8e6, 5'700 * kMicrosecond, 0, 600), 4'800);
  EXPECT_LT(quantile(after(run.waits, 400), 0.99), 60 * kMicrosecond);
  expect_no_jump(run.ticks);
}

TEST(PhaseLock, GoesOnByTheClockWhileTheSourceIsSilentAndComesBackWithoutAJump) {
  std::vector<std::int64_t> came = sent_each(1e6, 300 * kMicrosecond, 0, 1'000);
  const std::vector<std::int64_t> later = sent_each(1e6, 2'000'700 * kMicrosecond, 0, 2'000);
  came.insert(came.end(), later.begin(), later.end());
  const Followed run = followed(came, 4'000);
  expect_no_jump(run.ticks);
  for (std::size_t i = 1'100; i < 1'900; ++i)
    ASSERT_EQ(run.ticks[i] - run.ticks[i - 1], kTickPeriod) << "nothing is heard";
  EXPECT_LT(quantile(after(run.waits, 1'500), 0.99), 60 * kMicrosecond);
}

TEST(PhaseLock, IsNotThereWithoutTheKey) {
  const Followed run =
      followed(sent_each(1e6, 300 * kMicrosecond, 0, 300), 300, Scene::kFreeRunning);
  for (std::size_t i = 1; i < run.ticks.size(); ++i)
    ASSERT_EQ(run.ticks[i] - run.ticks[i - 1], kTickPeriod);
}

}  // namespace
}  // namespace clearance
