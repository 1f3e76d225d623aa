#include "tools/bench/thesis/rows.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tools/bench/measure.hpp"
#include "tools/bench/thesis/chapter5/alternating.hpp"
#include "tools/bench/thesis/chapter5/digits50.hpp"
#include "tools/bench/thesis/chapter5/facet_ball.hpp"
#include "tools/bench/thesis/chapter5/methods.hpp"
#include "tools/bench/thesis/chapter5/point_families.hpp"

namespace clearance::bench {
namespace {

constexpr double kOfTable52 = 1e-4;

void count_ns(benchmark::State& state, double queries) {
  state.counters["ns"] =
      benchmark::Counter(queries * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void judge(benchmark::State& state, const ClosestPoints& found, const TruePoints& truth) {
  const double error = std::abs(found.distance() - truth.distance);
  state.counters["max_error"] = error;
  state.counters["x_error"] = x_error(found, truth.points);
  state.counters["failures"] = !found.converged || !(error <= kFailure);
  count_steps(state, found.rounds);
}

void time_run(benchmark::State& state, const Run& run, int rounds, const TruePoints& truth) {
  judge(state, run(rounds), truth);
  for (auto _ : state) benchmark::DoNotOptimize(run(rounds).on_a);
  count_ns(state, static_cast<double>(state.iterations()));
}

void register_crossed(const Method& method, double separation) {
  const std::string name = fmt::format("ellipsoids/{}/{}", method.name, separation);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    const CrossedTest test = crossed_test(separation);
    state.SetLabel(method.label);
    time_run(state, method.prepared(test.pair), method.most_rounds, test.truth);
  });
  if (method.most_rounds == 0) return;
  const std::string to = fmt::format("ellipsoids/{}/to-1e-4/{}", method.name, separation);
  benchmark::RegisterBenchmark(to.c_str(), [=](benchmark::State& state) {
    const CrossedTest test = crossed_test(separation);
    const Run run = method.prepared(test.pair);
    const int rounds = rounds_to(kOfTable52, run, method.most_rounds, test.truth.points);
    if (rounds == 0) {
      state.SkipWithError("it never comes so near");
      return;
    }
    state.SetLabel(method.label);
    time_run(state, run, rounds, test.truth);
  });
}

// The places of B while it is tracked: a circle around the test's place in steps of 0.02, as §4.1
// moves balls of radius 1.
std::vector<Vec3> circle_around(const Vec3& place) {
  constexpr int kSteps = 100;
  constexpr double kStep = 0.02, kRadius = kSteps * kStep / (2.0 * std::numbers::pi);
  std::vector<Vec3> places;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSteps;
    places.push_back(place + kRadius * Vec3(std::cos(angle) - 1.0, std::sin(angle), 0.0));
  }
  return places;
}

// Table 5.1. Errors are those of the first place, the test's own.
template <Scan kScan>
void time_facet_balls(benchmark::State& state, int order, bool tracked) {
  const CrossedTest test = crossed_test(kStandard);
  FacetBallPair models(test.pair, order);
  judge(state, models.closest<kScan>(test.pair.apart), test.truth);
  state.counters["facets"] = static_cast<double>(models.facets());
  const std::vector<Vec3> places =
      tracked ? circle_around(test.pair.apart) : std::vector<Vec3>{test.pair.apart};
  std::size_t k = 0;
  for (auto _ : state) {
    if (!tracked) models.forget();
    benchmark::DoNotOptimize(models.closest<kScan>(places[k]).on_a);
    k = k + 1 == places.size() ? 0 : k + 1;
  }
  count_ns(state, static_cast<double>(state.iterations()));
}

template <Scan kScan>
void register_facet_ball_rows(const char* prefix) {
  for (const int order : kOrders) {
    for (const bool tracked : {false, true}) {
      const std::string name =
          fmt::format("facet-ball/{}{}/{}", prefix, tracked ? "tracked" : "cold", order);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        time_facet_balls<kScan>(state, order, tracked);
      });
    }
  }
}

// Errors are shares of the size: the longest semi-axis and how far out the point is.
void judge_points(benchmark::State& state, NearestPointMethod* nearest,
                  const std::vector<PointCase>& cases) {
  double worst = 0.0, failures = 0.0, iterations = 0.0, most = 0.0;
  for (const PointCase& c : cases) {
    const NearestPoint<3> found = nearest(c.axes, c.p);
    const double error = std::abs((found.point - c.p).norm() - c.distance) / c.size();
    failures += !(error <= kFailure);
    if (!std::isnan(error)) worst = std::max(worst, error);
    iterations += found.iterations;
    most = std::max(most, static_cast<double>(found.iterations));
  }
  state.counters["max_error"] = worst;
  state.counters["failures"] = failures;
  state.counters["most_iterations"] = most;
  count_steps(state, iterations / static_cast<double>(cases.size()));
}

void register_points(const char* name, NearestPointMethod* nearest) {
  for (const PointFamily& family : kPointFamilies) {
    const std::string row = fmt::format("point/{}/{}", name, family.name);
    benchmark::RegisterBenchmark(row.c_str(), [=](benchmark::State& state) {
      const std::vector<PointCase> cases = point_cases(family.name);
      state.SetLabel(family.what);
      judge_points(state, nearest, cases);
      while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(cases.size()))) {
        for (const PointCase& c : cases) benchmark::DoNotOptimize(nearest(c.axes, c.p).point);
      }
      count_ns(state, static_cast<double>(state.iterations()));
    });
  }
}

}  // namespace

void register_chapter5() {
  for (const Method& method : methods()) {
    for (const double separation : kSeparations) register_crossed(method, separation);
  }
  register_facet_ball_rows<Scan::kAllFacets>("");
  register_facet_ball_rows<Scan::kNeighbours>("neighbours-");
  register_points("dominant", by_dominant_term);
  register_points("as-printed", by_dominant_term_as_printed);
  register_points("newton", by_newton);
}

}  // namespace clearance::bench
