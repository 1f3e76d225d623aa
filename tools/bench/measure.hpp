// One row of the benchmark: a solver on a workload, its time, its error and its failures.
//
// A Solver is
//   struct Solver {
//     using Shape = ...;                              // its own form of a body, made once per body
//     static Shape shape(const ConvexBody&);
//     Solver(const Shape& a, const Shape& b);         // one a pair; may remember the last query
//     void forget();                                  // the next query is cold
//     Answer query(const Pose& world_from_a, const Pose& world_from_b);
//   };
#pragma once

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/crossed_ellipsoids.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {

struct Answer {
  double distance;  // 0 or less: they overlap; infinity: they do not, and nothing more is known
  bool ok = true;   // false: the solver reports a failure
  int iterations = 0;
  double width = 0.0;  // m: upper - lower bound, for solvers that certify
};

// A query has failed when it reports so, is NaN, or is wrong by more than this, m.
inline constexpr double kFailure = 1e-6;

// Over all queries of a workload, from a pass of its own outside the timed loop.
struct Verdict {
  double max_error = 0.0;  // m, of the queries that did not report a failure
  double failures = 0.0;
  double iterations = 0.0;  // mean
  double widest_gap = 0.0;  // m: of the solver's own bounds
  double truth_gap = 0.0;   // m: the error bound of the reference itself
  double overlapping = 0.0;
  bool measures = false;  // an answer was more than that they do not overlap

  void add(const Answer& answer, const Truth& truth) {
    const bool only_apart = answer.distance == kInfinity && truth.distance > 0.0;
    const double error =
        only_apart ? 0.0 : std::abs(std::max(0.0, answer.distance) - truth.distance);
    failures += !answer.ok || !(error <= kFailure) || std::isnan(answer.distance);
    if (answer.ok && !std::isnan(answer.distance)) max_error = std::max(max_error, error);
    measures = measures || (answer.distance > 0.0 && answer.distance < kInfinity);
    iterations += answer.iterations;
    widest_gap = std::max(widest_gap, answer.width);
    truth_gap = std::max(truth_gap, truth.gap);
    overlapping += truth.distance == 0.0;
  }
};

// The solver's, mean. Google's own count of queries is called iterations as well.
inline void count_steps(benchmark::State& state, double steps) {
  state.counters["iterations"] = state.counters["steps"] = steps;
}

// ns per iteration, which is a query.
inline void count_time(benchmark::State& state) {
  const double queries = static_cast<double>(state.iterations());
  state.counters["ns"] =
      benchmark::Counter(queries * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Writes a verdict into a row's counters.
inline void count(benchmark::State& state, const Verdict& verdict) {
  if (verdict.measures) state.counters["max_error"] = verdict.max_error;
  state.counters["failures"] = verdict.failures;
  count_steps(state, verdict.iterations);
  state.counters["truth_gap"] = verdict.truth_gap;
  state.counters["overlapping"] = verdict.overlapping;
  if (verdict.widest_gap > 0.0) state.counters["widest_gap"] = verdict.widest_gap;
}

inline constexpr int kTracked = std::numeric_limits<int>::max();
inline constexpr int kCold = 1;

// Queries of a workload. `follow(i, use)` makes those of trajectory i, one after another, and calls
// use(k, answer) after the k-th one.
template <class Follow>
Verdict judge_trajectories(const Workload& load, const Follow& follow) {
  Verdict verdict;
  for (std::size_t i = 0; i < load.trajectories.size(); ++i) {
    follow(i, [&](std::size_t k, const Answer& a) { verdict.add(a, load.truth[i][k]); });
  }
  verdict.iterations /= static_cast<double>(load.queries());
  return verdict;
}
// One iteration of the benchmark is one query.
template <class Follow>
void time_trajectories(benchmark::State& state, const Workload& load, const Follow& follow) {
  double sum = 0.0;
  while (state.KeepRunningBatch(load.queries())) {
    for (std::size_t i = 0; i < load.trajectories.size(); ++i) {
      follow(i, [&](std::size_t, const Answer& answer) { sum += answer.distance; });
    }
    benchmark::DoNotOptimize(sum);
  }
  count_time(state);
}

template <class Solver>
class Row {
 public:
  // The solver forgets what it knew after every `interval` queries, and between trajectories.
  Row(const Workload& load, int interval) : load_(load), interval_(interval) {
    for (const Trajectory& t : load.trajectories) {
      for (const Body& body : {t.a, t.b}) {
        if (!shapes_.contains(body.get())) shapes_.emplace(body.get(), Solver::shape(*body));
      }
      solvers_.push_back(std::make_unique<Solver>(shapes_.at(t.a.get()), shapes_.at(t.b.get())));
    }
    verdict_ = judge_trajectories(load, [this](std::size_t i, const auto& use) { follow(i, use); });
  }

  void time(benchmark::State& state) {
    time_trajectories(state, load_, [this](std::size_t i, const auto& use) { follow(i, use); });
    count(state, verdict_);
  }

 private:
  template <class Use>
  void follow(std::size_t i, const Use& use) {
    const auto& poses = load_.trajectories[i].poses;
    int left = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (left-- == 0) {
        solvers_[i]->forget();
        left = interval_ - 1;
      }
      use(k, solvers_[i]->query(poses[k].first, poses[k].second));
    }
  }

  const Workload& load_;
  int interval_;
  std::map<const ConvexBody*, typename Solver::Shape> shapes_;
  std::vector<std::unique_ptr<Solver>> solvers_;
  Verdict verdict_;
};

// The workload is made when the row is run.
template <class Solver>
void register_row(const std::string& name, const std::string& load, int interval) {
  const auto row = std::make_shared<std::unique_ptr<Row<Solver>>>();
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    if (!*row) *row = std::make_unique<Row<Solver>>(workload(load), interval);
    (*row)->time(state);
  });
}

// PREFIXtracked/NAME and PREFIXcold/NAME for every workload.
template <class Solver>
void register_rows(const std::string& prefix) {
  for (const std::string& name : workload_names()) {
    register_row<Solver>(fmt::format("{}tracked/{}", prefix, name), name, kTracked);
    register_row<Solver>(fmt::format("{}cold/{}", prefix, name), name, kCold);
  }
}

// PREFIXcurved/tracked/A-B, PREFIXpair/cold/A-B ... for every pair of kinds but `lacking` ones, of
// which the solver has no shape.
template <class Solver>
void register_kind_rows(const std::string& prefix,
                        std::initializer_list<std::string_view> lacking = {}) {
  for (const KindPair& pair : kind_pairs()) {
    const auto lacks = [&](const std::string& kind) {
      return std::find(lacking.begin(), lacking.end(), kind) != lacking.end();
    };
    if (lacks(pair.a) || lacks(pair.b)) continue;
    const std::string group = prefix + pair.group();
    register_row<Solver>(fmt::format("{}/tracked/{}", group, pair.load()), pair.load(), kTracked);
    register_row<Solver>(fmt::format("{}/cold/{}", group, pair.load()), pair.load(), kCold);
  }
}

// ellipsoids/WHO/D: the crossed ellipsoids of chapter 5, cold.
template <class Solver>
void register_crossed_rows(const std::string& who) {
  for (const double separation : kSeparations) {
    register_row<Solver>(fmt::format("ellipsoids/{}/{}", who, separation),
                         fmt::format("crossed/{}", separation), kCold);
  }
}

}  // namespace clearance::bench
