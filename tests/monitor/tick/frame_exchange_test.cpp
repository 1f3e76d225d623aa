// Frames go from the building thread to the tick, and their clouds come back.
//
// Oracle: the distance to the single point of each cloud.
#include "monitor/tick/frame_exchange.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <optional>
#include <thread>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance::frame_exchange_test {
namespace {

constexpr std::uint64_t kRevision = 7;

// A ball at the origin, and a sensor that sees one point on the x axis.
class FrameExchanges : public testing::Test {
 protected:
  FrameExchanges() {
    std::vector<Object> objects;
    objects.push_back(test::moving("ball", {test::ball(0.1)}));
    Object seen = test::moving("seen", {test::ball(50.0)});
    seen.sensor = 0;
    seen.age_limit_ns = 100'000'000'000;
    objects.push_back(seen);
    scene = test::cell_of(std::move(objects));
    scene.sensors.resize(1);
    scene.sensors[0].object = 1;
    scene.pairs[0].publish = true;
    monitor.emplace(scene);
    for (auto& cloud : clouds) cloud.emplace(SeenCloud::of_points(1));
  }
  // Builds a cloud of a point at x in a cloud that is free; null: none is.
  SeenCloud* build(float x) {
    for (auto& cloud : clouds) {
      if (exchange.is_used(&*cloud)) continue;
      const std::array<MeasuredPoint, 1> point = {{{x, 0.0F, 0.0F, 0.0F}}};
      EXPECT_EQ(cloud->points()->build(point, {Vec3::Zero(), 100.0}), CloudBuild::kBuilt);
      return &*cloud;
    }
    return nullptr;
  }
  SeenCloud* put(float x, std::int64_t stamp_ns, std::uint64_t revision = kRevision) {
    SeenCloud* const cloud = build(x);
    if (cloud != nullptr)
      exchange.put(0, {.cloud = cloud, .stamp_ns = stamp_ns, .world_from_sensor = {}}, revision);
    return cloud;
  }
  // Returns the lower bound of the pair.
  double tick() {
    now += test::kTick;
    exchange.choose_all(kRevision);
    exchange.show(kRevision, *monitor);
    if (!exchange.shown().empty()) last_stamp_ns = exchange.shown().back().stamp_ns;
    exchange.forget_shown();
    return monitor->tick(std::vector{test::sample(0, {}, now)}, now).pairs[0].lower;
  }

  Scene scene;
  std::optional<Monitor> monitor;
  std::array<std::optional<SeenCloud>, FrameExchange::kMostUsed + 1> clouds;
  FrameExchange exchange{1};
  std::int64_t last_stamp_ns = 0;  // of the frames that ticks were shown
  std::int64_t now = test::kStart;
};

TEST_F(FrameExchanges, ShowTheNextTickTheNewestFrame) {
  EXPECT_EQ(tick(), -kInfinity);
  put(2.0F, now);
  put(3.0F, now);
  EXPECT_NEAR(tick(), 2.9, 1e-9);
  EXPECT_EQ(last_stamp_ns, now - test::kTick);
  EXPECT_NEAR(tick(), 2.9, 1e-9);
}

TEST_F(FrameExchanges, GiveACloudBackWhenNoTickUsesItAnyMore) {
  const SeenCloud* const first = put(2.0F, now);
  EXPECT_TRUE(exchange.is_used(first)) << "it waits";
  tick();
  EXPECT_TRUE(exchange.is_used(first)) << "it is in use";
  const SeenCloud* const overtaken = put(3.0F, now);
  const SeenCloud* const second = put(4.0F, now);
  EXPECT_FALSE(exchange.is_used(overtaken));
  EXPECT_NEAR(tick(), 3.9, 1e-9);
  tick();
  EXPECT_FALSE(exchange.is_used(first));
  EXPECT_TRUE(exchange.is_used(second));
}

TEST_F(FrameExchanges, GiveBackAtOnceWhatIsOfAnotherSceneOrRefused) {
  const SeenCloud* const before = put(2.0F, now);
  tick();
  const SeenCloud* const other = put(3.0F, now, kRevision + 1);
  EXPECT_NEAR(tick(), 1.9, 1e-9);
  EXPECT_FALSE(exchange.is_used(other));
  const SeenCloud* const early = put(4.0F, now + 60'000'000'000);
  EXPECT_NEAR(tick(), 1.9, 1e-9) << "its stamp is in the future";
  tick();
  EXPECT_FALSE(exchange.is_used(early));
  EXPECT_TRUE(exchange.is_used(before));
}

// A changed scene has another monitor, which uses none of the clouds before.
TEST_F(FrameExchanges, GiveBackWhatTheMonitorBeforeUsed) {
  const SeenCloud* const before = put(2.0F, now);
  tick();
  monitor.emplace(scene);
  exchange.show(kRevision + 1, *monitor);
  EXPECT_FALSE(exchange.is_used(before));
}

TEST_F(FrameExchanges, AllocateNothing) {
  put(2.0F, now);
  tick();
  for (int i = 0; i < 10; ++i) {
    put(2.0F, now);
    const std::uint64_t before = allocations();
    exchange.choose_all(kRevision);
    exchange.show(kRevision, *monitor);
    EXPECT_EQ(allocations(), before);
    tick();
  }
}

// The tick finds the point that belongs to the frame's stamp, so that no cloud changes under it.
TEST_F(FrameExchanges, KeepCloudsWholeBetweenTwoThreads) {
  std::atomic<bool> done{false};
  std::atomic<std::int64_t> time{now};
  std::atomic<std::uint64_t> without{0}, built{0};
  std::thread building([&] {
    for (std::int64_t i = 0; !done; ++i) {
      const std::int64_t stamp = time + i % 1000;
      const auto x = static_cast<float>(2 + stamp % 1000 % 32);
      ++(put(x, stamp) == nullptr ? without : built);
    }
  });
  for (int i = 0; i < 3000 || built < 300; ++i) {
    const double lower = tick();
    time = now;
    if (last_stamp_ns != 0) {
      ASSERT_NEAR(lower, 1.9 + static_cast<double>(monitor->stamp_ns(1) % 1000 % 32), 1e-5);
    }
  }
  done = true;
  building.join();
  EXPECT_EQ(without, 0u) << "four clouds are enough";
}

}  // namespace
}  // namespace clearance::frame_exchange_test
