// Rows of monitor/clouds: building a cloud from a frame, and the element nearest to a box.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/random.hpp"
#include "tools/bench/rows.hpp"

namespace clearance::bench {
namespace {

constexpr PinholeCamera kCamera{640, 480, 571.7, 568.9, 320.9, 238.7};
constexpr DepthError kError{0.001, 0.0025};
constexpr DepthRange kRange{0.25, 4.0};
constexpr float kBallRadius = 0.004F;  // m

// A floor 0.8 m below the camera, a wall 2.5 m away, a disc and a slanted step in front of it, with
// noise of 80 % of the stated error.
struct Frame {
  std::vector<float> metres;
  std::vector<std::uint16_t> millimetres;
  std::vector<MeasuredPoint> points;

  [[nodiscard]] DepthImage image(DepthImage::Format format) const {
    const bool is_metres = format == DepthImage::Format::kMetres32;
    return {format, kCamera.width, kCamera.height, kCamera.width * (is_metres ? 4U : 2U),
            is_metres ? std::as_bytes(std::span(metres)) : std::as_bytes(std::span(millimetres))};
  }
};

double depth_of(double x, double y) {
  double z = y > 0.0 ? std::min(2.5, 0.8 / y) : 2.5;
  if (std::hypot(x - 0.1, y + 0.05) < 0.1) z = 1.2;
  return x < -0.2 && y > -0.1 ? std::min(z, 1.6 + x) : z;
}

const Frame& frame() {
  static const Frame made = [] {
    Frame out;
    Random random(1);
    for (std::uint32_t v = 0; v < kCamera.height; ++v) {
      for (std::uint32_t u = 0; u < kCamera.width; ++u) {
        const double x = (u - kCamera.cx) / kCamera.fx, y = (v - kCamera.cy) / kCamera.fy;
        const double exact = depth_of(x, y);
        const double z = exact + 0.8 * kError.at(exact) * random.uniform(-1.0, 1.0);
        out.metres.push_back(static_cast<float>(z));
        out.millimetres.push_back(static_cast<std::uint16_t>(std::lround(1000.0 * z)));
        out.points.push_back({static_cast<float>(x * z), static_cast<float>(y * z),
                              static_cast<float>(z), kBallRadius});
      }
    }
    return out;
  }();
  return made;
}

void build_slabs(benchmark::State& state, DepthImage::Format format) {
  DepthCloud cloud(kCamera.width, kCamera.height);
  for (auto _ : state) {
    if (cloud.build(kCamera, frame().image(format), kError, kRange) != DepthBuild::kBuilt) {
      state.SkipWithError("refused");
    }
  }
  state.counters["pixels"] = kCamera.width * kCamera.height;
}

void build_balls(benchmark::State& state) {
  PointCloud cloud(frame().points.size());
  for (auto _ : state) {
    if (cloud.build(frame().points, {{0, 0, 2}, 10.0}) != CloudBuild::kBuilt) {
      state.SkipWithError("refused");
    }
  }
  state.counters["pixels"] = static_cast<double>(frame().points.size());
}

struct SlabQuery {
  DepthCloud cloud{kCamera.width, kCamera.height};
  SlabBody body;
  SlabQuery() {
    static_cast<void>(
        cloud.build(kCamera, frame().image(DepthImage::Format::kMetres32), kError, kRange));
  }
  NearestElement operator()(const ConvexBody& part, const RelativePose& pose,
                            CloudTracking& tracking) {
    return nearest_element(part, cloud, body, pose, tracking);
  }
};
struct BallQuery {
  PointCloud cloud{frame().points.size()};
  BallQuery() { static_cast<void>(cloud.build(frame().points, {{0, 0, 2}, 10.0})); }
  NearestElement operator()(const ConvexBody& part, const RelativePose& pose,
                            CloudTracking& tracking) {
    return nearest_element(part, cloud, pose, tracking);
  }
};
// The core's query of every point, tracked from one to the next.
struct BruteForce {
  ConvexBody origin = std::get<ConvexBody>(point(Vec3::Zero(), 0.0));
  NearestElement operator()(const ConvexBody& part, const RelativePose& pose, CloudTracking&) {
    NearestElement least;
    TrackingState features;
    RelativePose at;
    for (const MeasuredPoint& p : frame().points) {
      at.translation = pose.rotation * Vec3(p.x, p.y, p.z) + pose.translation;
      const DistanceResult r = distance(part, origin, at, features);
      least.lower = std::min(least.lower, r.lower - p.radius);
      least.upper = std::min(least.upper, r.upper - p.radius);
      ++least.queries;
    }
    return least;
  }
};

// Starts of boxes among the scene. A tracked box moves by 0.4 mm before each of its queries, and
// the first of them, a cold one, is not timed.
template <class Query>
void query(benchmark::State& state, bool tracked) {
  constexpr std::size_t kStarts = 200, kSteps = 20;
  Query ask;
  const ConvexBody part = std::get<ConvexBody>(box({0.05, 0.06, 0.12}));
  Random random(2);
  std::vector<RelativePose> poses;
  for (std::size_t i = 0; i < kStarts; ++i) {
    Pose pose;
    pose.position = Vec3(0, 0, 1) + random.uniform(0.1, 0.5) * random.direction();
    pose.orientation = random.turn();
    for (std::size_t step = 0; step <= kSteps; ++step) {
      poses.push_back(relative_pose(pose, {}));
      pose.position += Vec3(0.0003, 0.0002, -0.0001);
      if (!tracked) break;
    }
  }
  const std::size_t timed = tracked ? kSteps : 1;
  double queries = 0.0, widest = 0.0, asked = 0.0;
  CloudTracking tracking;
  std::size_t i = 0;
  for (auto _ : state) {
    tracking.forget();
    if (tracked) static_cast<void>(ask(part, poses[i++], tracking));
    const double begin = cpu_ns();
    for (std::size_t step = 0; step < timed; ++step) {
      const NearestElement r = ask(part, poses[i++], tracking);
      queries += r.queries;
      widest = std::max(widest, r.upper - r.lower);
      asked += 1.0;
    }
    state.SetIterationTime(1e-9 * (cpu_ns() - begin) / static_cast<double>(timed));
    i %= poses.size();
  }
  state.counters["queries"] = queries / asked;
  state.counters["widest_gap"] = widest;
}

}  // namespace

void register_clouds() {
  using Format = DepthImage::Format;
  const auto add = [](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(("cloud/" + name).c_str(), run)
        ->Unit(benchmark::kMicrosecond);
  };
  add("build/slabs/16UC1", [](benchmark::State& s) { build_slabs(s, Format::kMillimetres16); });
  add("build/slabs/32FC1", [](benchmark::State& s) { build_slabs(s, Format::kMetres32); });
  add("build/balls", build_balls);
  for (const bool tracked : {false, true}) {
    const std::string how = tracked ? "tracked/" : "cold/";
    add(how + "slabs", [tracked](benchmark::State& s) {
      query<SlabQuery>(s, tracked);
    })->UseManualTime();
    add(how + "balls", [tracked](benchmark::State& s) {
      query<BallQuery>(s, tracked);
    })->UseManualTime();
  }
  add("brute_force/balls", [](benchmark::State& s) {
    query<BruteForce>(s, false);
  })->UseManualTime();
}

}  // namespace clearance::bench
