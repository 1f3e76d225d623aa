#include "tools/bench/thesis/rows.hpp"

#include <fmt/format.h>

#include "tools/bench/clocks.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/thesis/moved_body.hpp"
#include "tools/bench/thesis/variant_loop.hpp"

namespace clearance::bench {
namespace {

// Starts from the last active set or from the centres, as the thesis does.
void place(ActiveFeature& side, const TrackingState::Side& hint) {
  if (!side.place_tracked(hint)) side.place_inside(side.body().interior);
}

template <Release kRelease, Scan kScan>
class Variant {
 public:
  using Shape = const ConvexBody*;
  static Shape shape(const ConvexBody& body) { return &body; }

  Variant(Shape a, Shape b) : a_(*a), b_(*b) {}
  void forget() { tracking_ = {}; }
  [[nodiscard]] const TrackingState& tracking() const { return tracking_; }
  void restore(const TrackingState& tracking) { tracking_ = tracking; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const RelativePose a_from_b = relative_pose(world_from_a, world_from_b);
    ActiveFeature a(a_, nullptr), b(b_, &a_from_b);
    place(a, tracking_.a);
    place(b, tracking_.b);
    const LoopEnd end = dqp3_variant<kRelease, kScan>(a, b);
    tracking_ = {a.tracked(), b.tracked()};
    return {(b.point_A() - a.point_A()).norm(), end.ok, end.cycles};
  }

 private:
  const ConvexBody& a_;
  const ConvexBody& b_;
  TrackingState tracking_;
};

class Moved {
 public:
  using Shape = const ConvexBody*;
  static Shape shape(const ConvexBody& body) { return &body; }

  Moved(Shape a, Shape b) : Moved(*a, *b) {}
  Moved(const ConvexBody& a, const ConvexBody& b) : a_(a), b_(b) {}
  void forget() { tracking_ = {}; }
  void move(const Pose& world_from_a, const Pose& world_from_b) {
    a_.move(world_from_a);
    b_.move(world_from_b);
  }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    move(world_from_a, world_from_b);
    return loop();
  }
  [[nodiscard]] const TrackingState& tracking() const { return tracking_; }
  void restore(const TrackingState& tracking) { tracking_ = tracking; }
  // At the poses of the last move().
  Answer loop() {
    ActiveFeature a(a_.at_pose(), nullptr), b(b_.at_pose(), nullptr);
    tracking_.a.point = a_.point(tracking_.a.point);
    tracking_.b.point = b_.point(tracking_.b.point);
    place(a, tracking_.a);
    place(b, tracking_.b);
    const LoopEnd end = dqp3_variant<Release::kBase, Scan::kNeighbours>(a, b);
    tracking_ = {a.tracked(), b.tracked()};
    tracking_.a.point = a_.point_of_body(tracking_.a.point);
    tracking_.b.point = b_.point_of_body(tracking_.b.point);
    return {(b.point_A() - a.point_A()).norm(), end.ok, end.cycles};
  }

 private:
  MovedBody a_, b_;
  TrackingState tracking_;
};

// The base variant at poses that are set before the query.
class Unmoved {
 public:
  Unmoved(const ConvexBody& a, const ConvexBody& b) : pair_(&a, &b) {}
  void move(const Pose& world_from_a, const Pose& world_from_b) {
    world_from_a_ = world_from_a;
    world_from_b_ = world_from_b;
  }
  [[nodiscard]] const TrackingState& tracking() const { return pair_.tracking(); }
  void restore(const TrackingState& tracking) { pair_.restore(tracking); }
  Answer loop() { return pair_.query(world_from_a_, world_from_b_); }

 private:
  Variant<Release::kBase, Scan::kNeighbours> pair_;
  Pose world_from_a_, world_from_b_;
};

// The part of a query that remains when its bodies have been transformed before. Reading the clock
// costs as much as several queries, so each is repeated, from what the last pose left, after one
// that is not timed.
template <class Pair>
void time_repeated(benchmark::State& state, const std::string& name) {
  constexpr int kRepeats = 64;
  const Workload& load = workload(name);
  const double clock_cost = cost_of(cpu_ns), queries = static_cast<double>(load.queries());
  Verdict verdict;
  double spent_ns = 0.0, sum = 0.0;
  for (auto _ : state) {
    verdict = {};
    for (std::size_t i = 0; i < load.trajectories.size(); ++i) {
      const Trajectory& t = load.trajectories[i];
      Pair pair(*t.a, *t.b);
      for (std::size_t k = 0; k < t.poses.size(); ++k) {
        const TrackingState last = pair.tracking();
        pair.move(t.poses[k].first, t.poses[k].second);
        verdict.add(pair.loop(), load.truth[i][k]);
        const double start = cpu_ns();
        for (int repeat = 0; repeat < kRepeats; ++repeat) {
          pair.restore(last);
          sum += pair.loop().distance;
        }
        spent_ns += cpu_ns() - start - clock_cost;
      }
    }
  }
  benchmark::DoNotOptimize(sum);
  verdict.iterations /= queries;
  state.counters["ns"] = spent_ns / (kRepeats * queries * static_cast<double>(state.iterations()));
  count(state, verdict);
}

template <class Pair>
void register_repeated(const std::string& name) {
  for (const int order : kOrders) {
    const std::string load = fmt::format("f{}", order);
    benchmark::RegisterBenchmark((fmt::format("variant/{}/tracked/{}", name, load)).c_str(),
                                 [=](benchmark::State& s) { time_repeated<Pair>(s, load); });
  }
}

template <class Solver>
void register_variant(const std::string& name) {
  for (const std::string& load : workload_names()) {
    register_row<Solver>(fmt::format("variant/{}/tracked/{}", name, load), load, kTracked);
    register_row<Solver>(fmt::format("variant/{}/cold/{}", name, load), load, kCold);
  }
}

}  // namespace

void register_variants() {
  register_variant<Variant<Release::kBase, Scan::kNeighbours>>("base");
  register_variant<Variant<Release::kAggressive, Scan::kNeighbours>>("aggressive");
  register_variant<Variant<Release::kDual, Scan::kNeighbours>>("dual");
  register_variant<Variant<Release::kConsistent, Scan::kNeighbours>>("consistent");
  register_variant<Variant<Release::kBase, Scan::kAllFacets>>("all-facets");
  register_variant<Moved>("moved");
  register_repeated<Unmoved>("base-repeated");
  register_repeated<Moved>("moved-before");
  register_intervals<Variant<Release::kBase, Scan::kNeighbours>>("variant/base/");
}

}  // namespace clearance::bench
