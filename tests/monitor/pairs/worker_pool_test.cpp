#include "monitor/pairs/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "monitor/monitor.hpp"
#include "tests/monitor/replay/report_bytes.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

TEST(WorkerPool, DoesEachIndexOnceWhateverTheNumberOfWorkers) {
  for (const unsigned workers : {1u, 2u, 3u, 7u}) {
    WorkerPool pool(workers, {});
    for (std::uint32_t loop = 0; loop < 300; ++loop) {
      const std::uint32_t count = loop * 7 % 1000;
      std::vector<std::uint32_t> times(count, 0);
      const auto work = [&times](std::uint32_t i) noexcept { ++times[i]; };
      pool.run(count, {.claim = 1 + loop % 20, .least = 2}, work);
      ASSERT_EQ(times, std::vector<std::uint32_t>(count, 1)) << workers << " workers";
    }
  }
}

TEST(WorkerPool, StartsEachOtherThreadWithWhatItIsTold) {
  std::atomic<int> started{0};
  {
    WorkerPool pool(4, [&started] { ++started; });
  }
  EXPECT_EQ(started, 3);
}

// Thin bodies that crawl, spin, jump and fall silent; all published, so that hundreds of pairs are
// evaluated at once, within the budget or beyond it.
class Crowd {
 public:
  explicit Crowd(std::uint32_t budget) : random_(81) {
    std::vector<Object> objects;
    for (int i = 0; i < 36; ++i) {
      objects.push_back(test::moving("thin", {test::capsule(1.0, 0.01, random_.pose(0.3))}));
      if (i % 3 == 0) objects.back().parts.push_back(test::block(Vec3(0.05, 0.1, 0.02)));
      if (i % 2 == 0) objects.back().max_speed = 3.0;
      poses_.push_back(random_.pose(2.0));
    }
    scene = test::cell_of(std::move(objects));
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.zones = {test::zone_over(scene, 0.1, 0.2)};
    scene.budget = budget;
  }

  std::vector<PoseSample> next() {
    now_ns += kTick;
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      poses_[i].position += random_.in_box(0.01);
      if (random_.uniform(0, 1) < 0.01) poses_[i] = random_.pose(2.0);
      const bool silent = i < 4 && now_ns % (100 * kTick) > 40 * kTick;
      if (!silent) samples.push_back(test::sample(i, poses_[i], now_ns));
    }
    return samples;
  }

  Scene scene;
  std::int64_t now_ns = kStart;

 private:
  Random random_;
  std::vector<Pose> poses_;
};

TEST(Workers, GiveTheSameBitsAsOneAlone) {
  for (const std::uint32_t budget : {2000u, 400u, 150u}) {
    Crowd crowd(budget);
    Monitor one(crowd.scene), two(crowd.scene, {.workers = 2}), three(crowd.scene, {.workers = 3});
    for (int t = 0; t < 200; ++t) {
      const std::vector<PoseSample> samples = crowd.next();
      const auto expected = test::bytes_of(one.tick(samples, crowd.now_ns));
      ASSERT_EQ(test::bytes_of(two.tick(samples, crowd.now_ns)), expected) << "tick " << t;
      ASSERT_EQ(test::bytes_of(three.tick(samples, crowd.now_ns)), expected) << "tick " << t;
    }
  }
}

}  // namespace
}  // namespace clearance
