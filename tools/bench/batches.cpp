#include "tools/bench/rows.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/batch.hpp"
#include "core/distance.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/measure.hpp"

namespace clearance::bench {
namespace {

// The number of pairs in a cell with two arms. All data of the queries fit into the second-level
// cache.
constexpr std::size_t kPairs = 512;

// Pairs on the same trajectory start this many steps after each other.
constexpr std::size_t kApart = 8;

// Bodies share shapes, as in a cell, or each body has a shape of its own in memory.
enum class Shapes { kInCommon, kOfTheirOwn };

// Many pairs of a workload at once, each of two bodies that move by themselves, back and forth
// along its trajectory.
struct Fleet {
  Fleet(const Workload& of, Shapes whose, std::size_t count = kPairs) : load(of) {
    copies.reserve(2 * count);
    const auto add = [&](const ConvexBody& shape) {
      shapes.push_back(whose == Shapes::kInCommon ? &shape : &copies.emplace_back(shape));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
      add(*trajectory(i).a);
      add(*trajectory(i).b);
      pairs.push_back({2 * i, 2 * i + 1});
    }
    poses.resize(shapes.size());
  }

  [[nodiscard]] std::size_t steps() const { return 2 * load.trajectories[0].poses.size(); }
  [[nodiscard]] const Trajectory& trajectory(std::size_t pair) const {
    return load.trajectories[pair % load.trajectories.size()];
  }
  [[nodiscard]] std::size_t pose_of(std::size_t pair, std::size_t step) const {
    const std::size_t at = (step + kApart * (pair / load.trajectories.size())) % steps();
    return std::min(at, steps() - 1 - at);
  }
  [[nodiscard]] const Truth& truth(std::size_t pair, std::size_t step) const {
    return load.truth[pair % load.trajectories.size()][pose_of(pair, step)];
  }
  void move_to(std::size_t step) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::tie(poses[2 * i], poses[2 * i + 1]) = trajectory(i).poses[pose_of(i, step)];
    }
  }

  const Workload& load;
  std::vector<ConvexBody> copies;
  std::vector<const ConvexBody*> shapes;
  std::vector<BodyPair> pairs;
  std::vector<Pose> poses;  // of this step
};

class Batched {
 public:
  explicit Batched(const Fleet& fleet) : batch_(fleet.shapes, fleet.pairs) {}
  std::span<const DistanceResult> step(const Fleet& fleet) { return batch_.evaluate(fleet.poses); }

 private:
  DistanceBatch batch_;
};

class OneByOne {
 public:
  explicit OneByOne(const Fleet& fleet)
      : states_(fleet.pairs.size()), results_(fleet.pairs.size()) {}
  std::span<const DistanceResult> step(const Fleet& fleet) {
    for (std::size_t i = 0; i < results_.size(); ++i) {
      const auto [a, b] = fleet.pairs[i];
      results_[i] =
          distance(*fleet.shapes[a], *fleet.shapes[b], fleet.poses[a], fleet.poses[b], states_[i]);
    }
    return results_;
  }

 private:
  std::vector<TrackingState> states_;
  std::vector<DistanceResult> results_;
};

// All steps of a fleet, after an untimed round, so that every pair is tracked. Only the queries are
// timed: the poses have been set before, as by a caller.
template <class Solver>
void time_fleet(benchmark::State& state, Fleet& fleet) {
  Solver solver(fleet);
  Verdict verdict;
  for (std::size_t step = 0; step < fleet.steps(); ++step) {
    fleet.move_to(step);
    const auto results = solver.step(fleet);
    for (std::size_t i = 0; i < kPairs; ++i) {
      const DistanceResult& r = results[i];
      verdict.add({r.distance, r.status != DistanceStatus::kIterationLimit, r.iterations,
                   r.upper - r.lower},
                  fleet.truth(i, step));
    }
  }
  const auto queries = static_cast<double>(kPairs * fleet.steps());
  verdict.iterations /= queries;
  const double clock_cost = cost_of(cpu_ns);
  double spent_ns = 0.0;
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(queries))) {
    for (std::size_t step = 0; step < fleet.steps(); ++step) {
      fleet.move_to(step);
      const double start = cpu_ns();
      benchmark::DoNotOptimize(solver.step(fleet).data());
      spent_ns += cpu_ns() - start - clock_cost;
    }
  }
  state.counters["ns"] = spent_ns / static_cast<double>(state.iterations());
  count(state, verdict);
}

// A few pairs of robot links or boxes. A round of them is shorter than reading the clock, so all
// rounds are timed at once, with the poses of all of them in memory.
template <class Solver>
void time_few(benchmark::State& state, Fleet& fleet) {
  Solver solver(fleet);
  std::vector<std::vector<Pose>> poses;
  for (std::size_t step = 0; step < fleet.steps(); ++step) {
    fleet.move_to(step);
    poses.push_back(fleet.poses);
    benchmark::DoNotOptimize(solver.step(fleet).data());
  }
  const std::size_t queries = fleet.pairs.size() * fleet.steps();
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(queries))) {
    for (std::vector<Pose>& of_step : poses) {
      fleet.poses.swap(of_step);
      benchmark::DoNotOptimize(solver.step(fleet).data());
      fleet.poses.swap(of_step);
    }
  }
  state.counters["ns"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// The mask of a target and of all narrower ones, because single queries are not compiled for every
// target. In Highway, wider vectors have lower bits. 0: all targets of this machine.
std::int64_t up_to(std::int64_t target) {
  return target == 0 ? 0 : (hwy::SupportedTargets() & -target) | target;
}

void use_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

template <class Solver>
void register_fleet(const std::string& name, const std::string& load, std::int64_t target,
                    Shapes shapes = Shapes::kInCommon) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    Fleet fleet(workload(load), shapes);
    use_targets(up_to(target));
    time_fleet<Solver>(state, fleet);
    use_targets(0);
  });
}

template <class Solver>
void register_few(const std::string& name, const std::string& load, std::size_t count) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    Fleet fleet(workload(load), Shapes::kInCommon, count);
    time_few<Solver>(state, fleet);
  });
}

}  // namespace

void register_batches() {
  for (const std::string& load : workload_names()) {
    register_fleet<Batched>(fmt::format("batch/{}", load), load, 0);
    register_fleet<OneByOne>(fmt::format("batch/single/{}", load), load, 0);
    for (const std::int64_t target : {HWY_SCALAR, HWY_SSE4, HWY_NEON, HWY_AVX2, HWY_AVX3}) {
      if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) continue;
      register_fleet<Batched>(fmt::format("batch/{}/{}", hwy::TargetName(target), load), load,
                              target);
    }
  }
  for (const std::string load : {"ellipsoid-ellipsoid", "cylinder-link"}) {
    register_fleet<Batched>(fmt::format("batch/curved/{}", load), load, 0);
    register_fleet<OneByOne>(fmt::format("batch/curved/single/{}", load), load, 0);
  }
  for (const std::string load : {"boxes", "links"}) {
    for (const std::size_t count : {1, 2, 4, 8, 16, 32, 64}) {
      register_few<Batched>(fmt::format("batch/few/{}/{}", load, count), load, count);
      register_few<OneByOne>(fmt::format("batch/few/single/{}/{}", load, count), load, count);
    }
    register_fleet<Batched>(fmt::format("batch/own/{}", load), load, 0, Shapes::kOfTheirOwn);
    register_fleet<OneByOne>(fmt::format("batch/own/single/{}", load), load, 0,
                             Shapes::kOfTheirOwn);
  }
}

}  // namespace clearance::bench
