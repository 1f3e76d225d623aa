// Scenes that change at random, over thousands of ticks.
//
// Oracles: the closed form for capsules, and a model of the zone's hysteresis by true distances.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

std::size_t index_below(Random& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(count))),
                  count - 1);
}

// A body that moves on a smooth path. Each scene has some of the bodies.
struct ShownBody {
  Object object;
  Vec3 centre, swing, phase;
  [[nodiscard]] Pose at(double t) const {
    Pose pose;
    for (int i = 0; i < 3; ++i)
      pose.position[i] = centre[i] + swing[i] * std::sin(2.0 * t + phase[i]);
    pose.orientation = Eigen::AngleAxisd(phase.x() + t, Vec3::UnitZ());
    return pose;
  }
};

// Scenes change at random. The bounds contain the true distances, nothing that is sent is unknown,
// and zones follow their hysteresis.
TEST(TakeOverCampaign, RandomChangesKeepBoundsTrueAndZonesRight) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    std::vector<ShownBody> bodies;
    for (int i = 0; i < 10; ++i) {
      Object object = test::moving("body" + std::to_string(i), {});
      if (i % 3 == 0) {
        object.parts = {test::ball(0.1)};
      } else {
        object.parts = {test::capsule(0.4, 0.05), test::ball(0.08, test::at(0.1, 0.2, 0))};
      }
      object.may_jump = false;
      object.max_speed = 4.0;
      bodies.push_back(
          {std::move(object), random.in_box(1.0), random.in_box(0.4), random.in_box(3.0)});
    }
    std::list<Scene> scenes;
    std::vector<std::size_t> shown;
    std::unique_ptr<Monitor> monitor;
    std::optional<SourceNumbers> numbers;
    bool inside = false;
    int changes_of_zone = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      const bool changes = tick % 5 == 0;
      if (changes) {
        if (shown.empty()) {
          for (std::size_t i = 0; i < 5; ++i) shown.push_back(i);
        } else if (random.uniform(0, 1) < 0.5 && shown.size() > 3) {
          shown.erase(shown.begin() +
                      static_cast<std::ptrdiff_t>(index_below(random, shown.size())));
        } else {
          const std::size_t body = index_below(random, bodies.size());
          if (std::ranges::find(shown, body) == shown.end())
            shown.insert(
                shown.begin() + static_cast<std::ptrdiff_t>(index_below(random, shown.size())),
                body);
        }
        std::vector<Object> objects;
        for (const std::size_t i : shown) objects.push_back(bodies[i].object);
        Scene scene = test::cell_of(std::move(objects));
        for (ObjectPair& pair : scene.pairs) pair.publish = random.uniform(0, 1) < 0.3;
        scene.zones.push_back(test::zone_over(scene, 0.05, 0.1));
        scene.budget = 400;
        scenes.push_back(std::move(scene));
        if (monitor == nullptr) {
          numbers.emplace(scenes.back());
          monitor = std::make_unique<Monitor>(scenes.back());
        } else {
          monitor =
              test::taken_over(*monitor, *std::next(scenes.rbegin()), scenes.back(), *numbers);
        }
      }
      const double t = 1e-3 * tick;
      const std::int64_t now = kStart + tick * kTick;
      std::vector<PoseSample> samples;
      for (std::uint32_t i = 0; i < shown.size(); ++i)
        samples.push_back(test::sample(i, bodies[shown[i]].at(t), now));
      const Report& report = monitor->tick(samples, now);
      ASSERT_EQ(report.unknown + report.stale, 0u);
      ASSERT_TRUE(report.minimum_certified);
      long double least = 1e9L;
      const Scene& scene = scenes.back();
      for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
        const ShownBody &a = bodies[shown[scene.pairs[p].first]],
                        &b = bodies[shown[scene.pairs[p].second]];
        const long double truth = test::true_distance(a.object, a.at(t), b.object, b.at(t));
        least = std::min(least, truth);
        const PairReport pair = monitor->pair(p);
        if (truth > 0) {
          ASSERT_LE(pair.lower, truth + 1e-12L) << seed << ' ' << tick << ' ' << p;
          ASSERT_GE(pair.upper, truth - 1e-12L) << seed << ' ' << tick << ' ' << p;
        }
      }
      if (least > 0) {
        ASSERT_LE(report.lower_all, least + 1e-12L);
      }
      // In a tick no pair comes nearer by more than 8 mm.
      if (least < 0.05L) inside = true;
      if (least > 0.1L) inside = false;
      const bool near_a_threshold = std::abs(static_cast<double>(least) - 0.05) < 0.008 ||
                                    std::abs(static_cast<double>(least) - 0.1) < 0.008;
      changes_of_zone += report.zones[0].changed;
      if (near_a_threshold) {
        inside = report.zones[0].active;
      } else {
        ASSERT_EQ(report.zones[0].active, inside)
            << seed << ' ' << tick << ' ' << static_cast<double>(least);
      }
    }
    EXPECT_GT(changes_of_zone, 0) << seed;
  }
}

}  // namespace
}  // namespace clearance
