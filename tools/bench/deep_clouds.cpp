// Rows of parts that are deep in a cloud, where thousands of elements overlap the part.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/cloud_frame.hpp"
#include "tools/bench/random.hpp"
#include "tools/bench/rows.hpp"

namespace clearance::bench {
namespace {

SeenCloud dense_balls() {
  const std::vector<MeasuredPoint> points = dense_points({0, 0, 1});
  SeenCloud cloud = SeenCloud::of_points(points.size());
  static_cast<void>(cloud.points()->build(points, {{0, 0, 1}, 10.0}));
  return cloud;
}

SeenCloud image() {
  SeenCloud cloud = SeenCloud::of_images(kCloudCamera.width, kCloudCamera.height);
  static_cast<void>(cloud.depth()->build(
      kCloudCamera, cloud_frame().image(DepthImage::Format::kMetres32), kCloudError, kCloudRange));
  return cloud;
}

// Turned places whose origins are within the elements.
std::vector<Pose> places(const SeenCloud& cloud, std::size_t count) {
  Random random(7);
  std::vector<Vec3> middles;
  cloud.for_each([&](std::size_t, std::size_t, const Vec3& at, double) { middles.push_back(at); });
  std::vector<Pose> out(count);
  for (Pose& pose : out) {
    const double share = random.uniform(0.0, 1.0);
    pose.position =
        middles[static_cast<std::size_t>(share * static_cast<double>(middles.size() - 1))];
    pose.orientation = random.turn();
  }
  return out;
}

void run(benchmark::State& state, const SeenCloud& cloud, const ConvexBody& part) {
  const std::vector<Pose> poses = places(cloud, 200);
  SlabBody body;
  CloudTracking tracking;
  double most = 0.0, work = 0.0, widest = 0.0, asked = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    tracking.forget();
    const double begin = cpu_ns();
    const NearestElement found =
        cloud.nearest(part, relative_pose(poses[i++ % poses.size()], {}), body, tracking);
    const double took = cpu_ns() - begin;
    state.SetIterationTime(1e-9 * took);
    most = std::max(most, took);
    work += found.queries;
    widest = std::max(widest, found.upper - found.lower);
    asked += 1.0;
  }
  state.counters["max_us"] = 1e-3 * most;
  state.counters["queries"] = work / asked;
  state.counters["widest_gap"] = widest;
}

}  // namespace

void register_deep_clouds() {
  for (const bool is_image : {false, true}) {
    for (const bool is_cylinder : {false, true}) {
      const std::string name = std::string("cloud/deep/") + (is_image ? "slabs/" : "balls/") +
                               (is_cylinder ? "cylinder" : "box");
      benchmark::RegisterBenchmark(name.c_str(),
                                   [=](benchmark::State& state) {
                                     const ConvexBody part = std::get<ConvexBody>(
                                         is_cylinder ? cylinder(0.06, 0.12) : box(kCloudBox));
                                     run(state, is_image ? image() : dense_balls(), part);
                                   })
          ->UseManualTime()
          ->Iterations(200)
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

}  // namespace clearance::bench
