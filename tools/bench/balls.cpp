#include "tools/bench/balls.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/distance.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

constexpr int kTrajectories = 40;
constexpr int kSteps = 100;

void time_balls(benchmark::State& state, const ConvexPolyhedron& body,
                const std::vector<Trajectory>& motion, bool tracked) {
  double sum = 0.0, widest = 0.0;
  std::uint64_t iterations = 0, queries = 0, failures = 0;
  for (auto _ : state) {
    for (const Trajectory& t : motion) {
      TrackingState tracking;
      for (const auto& [a, b] : t.poses) {
        if (!tracked) tracking = {};
        const DistanceResult r = distance(body, body, relative_pose(a, b), tracking);
        sum += r.distance;
        widest = std::max(widest, r.upper - r.lower);
        failures += r.status != DistanceStatus::kConverged;
        iterations += r.iterations;
      }
      queries += t.poses.size();
    }
  }
  benchmark::DoNotOptimize(sum);
  state.counters["ns"] =
      benchmark::Counter(static_cast<double>(queries) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(queries);
  state.counters["widest_gap"] = widest;
  state.counters["failures"] =
      static_cast<double>(failures) / static_cast<double>(state.iterations());
}

}  // namespace

void register_balls() {
  const auto motion =
      std::make_shared<std::vector<Trajectory>>(trajectories(kTrajectories, kSteps));
  for (const bool tracked : {true, false}) {
    for (const char kind : {'f', 'v'}) {
      for (const int order : {2, 4, 6, 8, 10, 15, 20, 30, 40}) {
        const auto body = std::make_shared<ConvexPolyhedron>(ball(kind, order));
        const std::string name =
            (tracked ? "tracked/" : "cold/") + std::string(1, kind) + std::to_string(order);
        benchmark::RegisterBenchmark(
            name.c_str(), [=](benchmark::State& s) { time_balls(s, *body, *motion, tracked); });
      }
    }
  }
}

}  // namespace clearance::bench
