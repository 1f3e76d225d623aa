// Rows of monitor/clouds: building a cloud from a frame, and the element nearest to a box.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "monitor/intake/camera_messages.hpp"
#include "monitor/intake/measured_points.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/cloud_frame.hpp"
#include "tools/bench/peers/cloud_peers.hpp"
#include "tools/bench/rows.hpp"

namespace clearance::bench {
namespace {

void build_slabs(benchmark::State& state, DepthImage::Format format) {
  DepthCloud cloud(kCloudCamera.width, kCloudCamera.height);
  for (auto _ : state) {
    if (cloud.build(kCloudCamera, cloud_frame().image(format), kCloudError, kCloudRange) !=
        DepthBuild::kBuilt) {
      state.SkipWithError("refused");
    }
  }
  state.counters["pixels"] = kCloudCamera.width * kCloudCamera.height;
}

void build_balls(benchmark::State& state) {
  PointCloud cloud(cloud_frame().points.size());
  for (auto _ : state) {
    if (cloud.build(cloud_frame().points, {{0, 0, 2}, 10.0}) != CloudBuild::kBuilt) {
      state.SkipWithError("refused");
    }
  }
  state.counters["pixels"] = static_cast<double>(cloud_frame().points.size());
}

// The frame's points as a PointCloud2, whose points have 16 bytes, as drivers send them.
std::vector<std::byte> points_message() {
  constexpr std::uint32_t kStep = 16;
  constexpr std::uint8_t kFloat32 = 7;
  const std::vector<MeasuredPoint>& points = cloud_frame().points;
  Sample<sensor_msgs_msg_dds__PointCloud2_> message;
  message->height = 1;
  message->width = static_cast<std::uint32_t>(points.size());
  message->point_step = kStep;
  message->row_step = kStep * message->width;
  reserve_sequence(message->fields, 3);
  message->fields._length = 3;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    message->fields._buffer[axis] = {dds_string_dup(name.c_str()), 4 * axis, kFloat32, 1};
  }
  reserve_sequence(message->data, message->row_step);
  message->data._length = message->row_step;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float at[4] = {points[i].x, points[i].y, points[i].z, 0.0F};
    std::memcpy(message->data._buffer + kStep * i, at, kStep);
  }
  CdrEncoder encoder;
  const auto bytes = encoder.encode(*message);
  return {bytes.begin(), bytes.end()};
}

// All that the daemon does with a message of points, but for the own image of a robot.
void build_message(benchmark::State& state) {
  const std::vector<std::byte> bytes = points_message();
  Sensor sensor;
  sensor.kind = SensorKind::kPoints;
  sensor.error_constant = kCloudError.constant;
  sensor.error_quadratic = kCloudError.quadratic;
  sensor.least_depth = kCloudRange.least;
  sensor.greatest_depth = kCloudRange.greatest;
  const std::size_t most = cloud_frame().points.size();
  PointCloud cloud(most);
  std::vector<MeasuredPoint> points;
  CdrDecoder decoder;
  Sample<sensor_msgs_msg_dds__PointCloud2_> message;
  for (auto _ : state) {
    PointsView view;
    if (!decoder.decode(bytes, message) ||
        clearance::view(*message, most, view) != FrameFault::kNoFault ||
        measured_points(view, sensor, points) != FrameFault::kNoFault ||
        cloud.build(points, {{0, 0, 2}, 10.0}) != CloudBuild::kBuilt) {
      state.SkipWithError("refused");
    }
  }
  state.counters["pixels"] = static_cast<double>(most);
}

struct SlabQuery {
  DepthCloud cloud{kCloudCamera.width, kCloudCamera.height};
  SlabBody body;
  SlabQuery() {
    static_cast<void>(cloud.build(kCloudCamera, cloud_frame().image(DepthImage::Format::kMetres32),
                                  kCloudError, kCloudRange));
  }
  NearestElement operator()(const ConvexBody& part, const RelativePose& pose,
                            CloudTracking& tracking) {
    return nearest_element(part, cloud, body, pose, tracking);
  }
};
struct BallQuery {
  PointCloud cloud{cloud_frame().points.size()};
  BallQuery() { static_cast<void>(cloud.build(cloud_frame().points, {{0, 0, 2}, 10.0})); }
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
    for (const MeasuredPoint& p : cloud_frame().points) {
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
  const ConvexBody part = std::get<ConvexBody>(box(kCloudBox));
  std::vector<RelativePose> poses;
  for (Pose pose : cloud_places(kStarts)) {
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
  add("build/balls/PointCloud2", build_message);
  for (const bool tracked : {false, true}) {
    const std::string how = tracked ? "tracked/" : "cold/";
    add(how + "slabs", [tracked](benchmark::State& s) {
      query<SlabQuery>(s, tracked);
    })->UseManualTime();
    add(how + "balls", [tracked](benchmark::State& s) {
      query<BallQuery>(s, tracked);
    })->UseManualTime();
  }
  register_deep_clouds();
  register_cloud_ticks();
#ifdef CLEARANCE_BENCH_NANOFLANN
  register_nanoflann_clouds();
#endif
#if defined(CLEARANCE_BENCH_OCTOMAP) && defined(CLEARANCE_BENCH_FCL)
  register_octomap_clouds();
#endif
  add("brute_force/balls", [](benchmark::State& s) {
    query<BruteForce>(s, false);
  })->UseManualTime();
}

}  // namespace clearance::bench
