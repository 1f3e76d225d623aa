// Rows of whole ticks beside a cloud: what a camera adds to the tick of an arm.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/tick/monitor.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/cloud_frame.hpp"
#include "tools/bench/rows.hpp"

namespace clearance::bench {
namespace {

constexpr std::int64_t kTickNs = 1'000'000, kStart = 1'700'000'000'000'000'000;
constexpr int kTicksAFrame = 33, kLinks = 7, kParts = 20;

struct TickRow {
  const char* name;
  bool with_camera, is_deep, is_round;
};

// Seven links of 20 boxes (or cylinders) in all, a post, and what a camera sees. Without the
// camera, no pair names what it sees.
Scene arm_and_camera(const TickRow& row) {
  Scene scene;
  scene.name = "cloud_ticks";
  scene.revision = 1;
  for (int link = 0; link < kLinks; ++link) {
    Object object;
    object.name = "link" + std::to_string(link);
    object.age_limit_ns = 20 * kTickNs;
    object.max_speed = 2.0;
    for (int part = link; part < kParts; part += kLinks) {
      Pose at;
      at.position = Vec3(0.0, 0.0, 0.06 * (part / kLinks));
      const double half = 0.03 + 0.001 * part;
      object.parts.push_back(
          {"part",
           std::get<ConvexBody>(row.is_round ? cylinder(0.045, half) : box({0.04, 0.05, half})),
           at});
    }
    scene.objects.push_back(std::move(object));
  }
  Object post;
  post.name = "post";
  post.fixed = true;
  post.world_from_object.position = Vec3(0.8, 0.5, 1.5);
  post.parts.push_back({"post", std::get<ConvexBody>(box({0.05, 0.05, 1.0})), {}});
  scene.objects.push_back(std::move(post));
  Object seen;
  seen.name = "camera";
  seen.age_limit_ns = 100 * kTickNs;
  seen.max_speed = 1.6;
  seen.may_jump = true;
  seen.sensor = 0;
  Sensor sensor;
  sensor.object = kLinks + 1;
  sensor.error_constant = kCloudError.constant;
  sensor.error_quadratic = kCloudError.quadratic;
  sensor.least_depth = kCloudRange.least;
  sensor.greatest_depth = kCloudRange.greatest;
  seen.parts.push_back(
      {"view", std::get<ConvexBody>(point(Vec3::Zero(), sensor.view_radius())), {}});
  scene.objects.push_back(std::move(seen));
  scene.sensors.push_back(sensor);
  for (std::uint32_t link = 0; link < kLinks; ++link) {
    for (std::uint32_t other = link + 2; other < kLinks; ++other)
      scene.pairs.push_back({link, other, true});
    scene.pairs.push_back({link, kLinks, true});
    if (row.with_camera) scene.pairs.push_back({link, kLinks + 1, true});
  }
  return scene;
}

// An arm that hangs into the scene and swings. No point is faster than 0.6 m/s.
std::vector<PoseSample> arm_at(int tick, std::int64_t stamp_ns) {
  std::vector<PoseSample> samples;
  const double swing = 0.3 * std::sin(1e-3 * tick);
  for (std::uint32_t link = 0; link < kLinks; ++link) {
    PoseSample sample;
    sample.object = link;
    sample.stamp_ns = stamp_ns;
    sample.world_from_object.position =
        Vec3(0.1 + swing * (1.0 + 0.1 * link), -0.3 + 0.12 * link, 0.9 + 0.05 * link);
    sample.world_from_object.orientation =
        Eigen::AngleAxisd(swing, Vec3(0.3, 0.5, 0.8).normalized());
    samples.push_back(sample);
  }
  return samples;
}

// The arm is within these balls.
const std::vector<SeenCloud>& dense_clouds() {
  static const std::vector<SeenCloud> made = [] {
    std::vector<SeenCloud> out;
    const std::vector<MeasuredPoint> points = dense_points({0.1, 0.1, 1.1});
    out.push_back(SeenCloud::of_points(points.size()));
    static_cast<void>(out.back().points()->build(points, {{0, 0, 1}, 10.0}));
    return out;
  }();
  return made;
}

const std::vector<SeenCloud>& clouds() {
  static const std::vector<SeenCloud> made = [] {
    std::vector<SeenCloud> out;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      out.push_back(SeenCloud::of_images(kCloudCamera.width, kCloudCamera.height));
      static_cast<void>(out.back().depth()->build(
          kCloudCamera, make_cloud_frame(seed).image(DepthImage::Format::kMetres32), kCloudError,
          kCloudRange));
    }
    return out;
  }();
  return made;
}

void run(benchmark::State& state, const TickRow& row) {
  const int ticks = row.is_deep ? 330 : 3000;
  std::vector<double> times;
  double clock_cost = cost_of(wall_ns), queries = 0.0;
  for (auto _ : state) {
    const Scene scene = arm_and_camera(row);
    const std::vector<SeenCloud>& frames = row.is_deep ? dense_clouds() : clouds();
    Monitor monitor(scene);
    double sum = 0.0;
    for (int tick = 0; tick < ticks; ++tick) {
      const std::int64_t now = kStart + tick * kTickNs;
      const std::vector<PoseSample> samples = arm_at(tick, now);
      if (tick % kTicksAFrame == 0) {
        monitor.show(
            0, {.cloud = &frames[static_cast<std::size_t>(tick / kTicksAFrame) % frames.size()],
                .stamp_ns = now,
                .world_from_sensor = {},
                .pose_error = 0.0});
      }
      const double begin = wall_ns();
      const Report& report = monitor.tick(samples, now);
      const double took = wall_ns() - begin - clock_cost;
      times.push_back(took);
      sum += took;
      queries += report.queries;
    }
    state.SetIterationTime(1e-9 * sum / ticks);
  }
  std::ranges::sort(times);
  const auto at = [&](double share) {
    return 1e-3 * times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  state.counters["p50_us"] = at(0.5);
  state.counters["p99_us"] = at(0.99);
  state.counters["p999_us"] = at(0.999);
  state.counters["max_us"] = times.back() * 1e-3;
  state.counters["queries"] = queries / static_cast<double>(times.size());
}

}  // namespace

void register_cloud_ticks() {
  for (const TickRow& row :
       {TickRow{"without", false, false, false}, TickRow{"with", true, false, false},
        TickRow{"deep/boxes", true, true, false}, TickRow{"deep/cylinders", true, true, true}}) {
    const std::string name = std::string("cloud/tick/") + row.name;
    benchmark::RegisterBenchmark(name.c_str(), [row](benchmark::State& state) { run(state, row); })
        ->UseManualTime()
        ->Iterations(2)  // of 3,000 ticks
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace clearance::bench
