#include "tools/bench/overlaps.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "tools/bench/bodies.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

constexpr int kMotions = 10, kSteps = 100;

struct How {
  const char* name;
  double apart;  // of what the origins are apart when the bodies touch
};
constexpr How kHow[] = {
    {"shallow", 0.97}, {"half", 0.5}, {"near", 0.1}, {"nearer", 0.01}, {"middle", 0.0}};

Body body(const std::string& kind, Random& random) {
  if (kind == "boxes") return std::make_shared<const ConvexPolyhedron>(random_box(random));
  if (kind == "links") return std::make_shared<const ConvexPolyhedron>(random_link(random));
  return std::make_shared<const ConvexPolyhedron>(ball(kind[0], std::stoi(kind.substr(1))));
}

bool are_apart(const Trajectory& pair, const Pose& a, const Pose& b) {
  TrackingState state;
  return distance(*pair.a, *pair.b, relative_pose(a, b), state, {.depth = false}).lower > 0.0;
}

// How far the origins are apart along a direction when the bodies touch, m.
double apart_at_touch(const Trajectory& pair, const Pose& a, Pose b, const Vec3& along) {
  double least = 0.0, most = pair.a->bounding_radius + pair.b->bounding_radius;
  for (int round = 0; round < 40; ++round) {
    const double middle = 0.5 * (least + most);
    b.position = middle * along;
    (are_apart(pair, a, b) ? most : least) = middle;
  }
  return most;
}

// B swings by a hundredth of the way and by 0.01 rad, from step to step by a sixteenth of that.
Trajectory swing(const std::string& kind, const How& how, Random& random) {
  Trajectory pair{body(kind, random), body(kind, random), {}};
  const Pose a{Vec3::Zero(), random.turn()}, b{Vec3::Zero(), random.turn()};
  const Vec3 along = random.direction(), across = random.direction(), axis = random.direction();
  const double apart = how.apart * apart_at_touch(pair, a, b, along);
  for (int k = 0; k < kSteps; ++k) {
    const double part = 0.01 * std::sin(2.0 * std::numbers::pi * k / kSteps);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(part, axis));
    pair.poses.emplace_back(a, Pose{apart * (along + part * across), turn * b.orientation});
  }
  return pair;
}

// From a pass of its own outside the timed loop.
void count(benchmark::State& state, const std::vector<Trajectory>& load) {
  double widest = 0.0, iterations = 0.0, overlapping = 0.0, failures = 0.0;
  for (const Trajectory& t : load) {
    TrackingState tracking;
    for (const auto& [a, b] : t.poses) {
      const DistanceResult r = distance(*t.a, *t.b, a, b, tracking);
      widest = std::max(widest, r.upper - r.lower);
      iterations += r.iterations;
      overlapping += r.status == DistanceStatus::kOverlapping;
      failures += r.status == DistanceStatus::kIterationLimit || !std::isfinite(r.distance);
    }
  }
  state.counters["widest_gap"] = widest;
  state.counters["iterations"] = iterations / (kMotions * kSteps);
  state.counters["overlapping"] = overlapping;
  state.counters["failures"] = failures;
}

std::vector<Trajectory> swings(const std::string& kind, const How& how) {
  Random random(4);
  std::vector<Trajectory> load;
  for (int i = 0; i < kMotions; ++i) load.push_back(swing(kind, how, random));
  return load;
}

// One iteration is one query.
void time_swings(benchmark::State& state, const std::vector<Trajectory>& load, bool tracked) {
  double sum = 0.0;
  while (state.KeepRunningBatch(kMotions * kSteps)) {
    for (const Trajectory& t : load) {
      TrackingState tracking;
      for (const auto& [a, b] : t.poses) {
        if (!tracked) tracking = {};
        sum += distance(*t.a, *t.b, a, b, tracking).distance;
      }
    }
    benchmark::DoNotOptimize(sum);
  }
  state.counters["ns"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  count(state, load);
}

}  // namespace

void register_overlaps() {
  for (const char* kind : {"boxes", "links", "f10", "v10", "f40", "v40"}) {
    for (const How& how : kHow) {
      const auto load = std::make_shared<std::vector<Trajectory>>();  // made when a row is run
      for (const bool tracked : {true, false}) {
        const std::string name =
            std::string("overlap/") + (tracked ? "tracked/" : "cold/") + kind + "/" + how.name;
        benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
          if (load->empty()) *load = swings(kind, how);
          time_swings(state, *load, tracked);
        });
      }
    }
  }
}

}  // namespace clearance::bench
