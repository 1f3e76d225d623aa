// A tick leaves out the objects that nothing has happened to. It must leave them as a visit would.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "monitor/bodies/displacements.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

auto figures_of(const Displacements& d) {
  return std::tie(d.changed, d.any_lost, d.most_unobserved, d.most_displaced, d.newest_pose_ns,
                  d.oldest_pose_ns);
}

auto figures_of(const TrackedObject& o) {
  return std::tie(o.moved, o.newly_known, o.discontinuous, o.plain, o.may_have_moved, o.unobserved,
                  o.displacement, o.accumulated_last_tick, o.accumulated, o.bend, o.motion.shift,
                  o.input.late, o.input.contradicted);
}

// Some objects are silent for long, some move, some leap, two sources claim one, and the time of
// the ticks goes back once in a while.
class Life {
 public:
  Life(const Scene& scene, std::uint64_t seed) : scene_(scene), draw_(seed) {}

  std::vector<PoseSample> next(std::int64_t now_ns) {
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
      if (!chance(i % 2 == 0 ? 0.3 : 0.02)) continue;
      PoseSample sample;
      sample.object = i;
      sample.source = chance(0.02) ? 1 : 0;
      sample.stamp_ns = now_ns - static_cast<std::int64_t>(chance(0.1) ? 15 * kTick : 0);
      if (chance(0.3)) place_[i % place_.size()] += chance(0.05) ? 1e5 : 1e-4;
      sample.world_from_object = at(place_[i % place_.size()], i, 0);
      samples.push_back(sample);
    }
    return samples;
  }
  bool chance(double share) { return std::uniform_real_distribution(0.0, 1.0)(draw_) < share; }

 private:
  const Scene& scene_;
  std::mt19937_64 draw_;
  std::array<double, 5> place_{};
};

TEST(Displacer, LeavesUnvisitedObjectsAsAVisitWould) {
  std::vector<Object> objects;
  for (int i = 0; i < 21; ++i) {
    Object object = i % 7 == 6 ? fixed("fixed" + std::to_string(i), {ball(0.1)}, at(0, i, 1))
                               : moving("body" + std::to_string(i), {ball(0.1)});
    object.age_limit_ns = (5 + i) * kTick;
    if (i % 3 == 0) object.max_speed = 2.0;
    objects.push_back(object);
  }
  const Scene scene = cell_of(objects);
  std::size_t unvisited = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Life life(scene, seed);
    Inputs visited = initial_inputs(scene), left_out = initial_inputs(scene);
    for (Inputs* inputs : {&visited, &left_out}) {
      for (TrackedObject& object : inputs->objects) object.bounding_radius = 0.1;
    }
    Displacer all(scene), some(scene);
    std::int64_t now = kStart;
    for (int tick = 0; tick < 3'000 && !testing::Test::HasFailure(); ++tick) {
      now += life.chance(0.001) ? -50 * kTick : kTick;
      const std::vector<PoseSample> samples = life.next(now);
      ingest(samples, {}, TickTime{now}, scene, visited);
      ingest(samples, {}, TickTime{now}, scene, left_out);
      visited.visits.visit_all();
      left_out.visits.each_due(0, scene.objects.size(), now, [&](std::size_t) { --unvisited; });
      unvisited += scene.objects.size();
      all.displace(visited);
      some.displace(left_out);
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", tick " << tick);
      EXPECT_EQ(figures_of(all.result()), figures_of(some.result()));
      for (std::size_t i = 0; i < scene.objects.size(); ++i)
        EXPECT_EQ(figures_of(visited.objects[i]), figures_of(left_out.objects[i])) << i;
    }
  }
  EXPECT_GT(unvisited, 50'000u) << "of 189,000 states";
}

TEST(Displacer, VisitsNoObjectAtRestUntilItIsLate) {
  Object object = moving("body", {ball(0.1)});
  object.age_limit_ns = 20 * kTick;
  const Scene scene = cell_of({object, moving("other", {ball(0.1)})});
  Inputs inputs = initial_inputs(scene);
  Displacer displacer(scene);
  PoseSample sample;
  sample.stamp_ns = kStart;
  std::vector<std::int64_t> visits;
  for (std::int64_t ms = 0; ms < 30; ++ms) {
    ingest(std::span(&sample, ms == 0 ? 1 : 0), {}, TickTime{kStart + ms * kTick}, scene, inputs);
    inputs.visits.each_due(0, 1, kStart + ms * kTick, [&](std::size_t) { visits.push_back(ms); });
    displacer.displace(inputs);
  }
  EXPECT_EQ(visits, (std::vector<std::int64_t>{0, 1, 21, 22, 23, 24, 25, 26, 27, 28, 29}));
}

}  // namespace
}  // namespace clearance::test
