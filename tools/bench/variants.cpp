#include "tools/bench/variants.hpp"

#include "tools/bench/clocks.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/moved_body.hpp"
#include "tools/bench/variant_loop.hpp"

namespace clearance::bench {
namespace {

// As in the thesis: from the last active set, or else from the middle.
void place(ActiveSide& side, const TrackingState::Side& hint) {
  if (!side.place_tracked(hint)) side.place_inside(side.body().interior);
}

template <Release kRelease, Scan kScan>
class Variant {
 public:
  using Shape = const ConvexPolyhedron*;
  static Shape shape(const ConvexPolyhedron& body) { return &body; }

  Variant(Shape a, Shape b) : a_(*a), b_(*b) {}
  void forget() { tracking_ = {}; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const RelativePose a_from_b = relative_pose(world_from_a, world_from_b);
    ActiveSide a(a_, nullptr), b(b_, &a_from_b);
    place(a, tracking_.a);
    place(b, tracking_.b);
    const LoopEnd end = dqp3_variant<kRelease, kScan>(a, b);
    tracking_ = {a.tracked(), b.tracked()};
    return {(b.common() - a.common()).norm(), end.ok, end.cycles};
  }

 private:
  const ConvexPolyhedron& a_;
  const ConvexPolyhedron& b_;
  TrackingState tracking_;
};

class Moved {
 public:
  using Shape = const ConvexPolyhedron*;
  static Shape shape(const ConvexPolyhedron& body) { return &body; }

  Moved(Shape a, Shape b) : a_(*a), b_(*b) {}
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
    ActiveSide a(a_.at_pose(), nullptr), b(b_.at_pose(), nullptr);
    tracking_.a.point = a_.point(tracking_.a.point);
    tracking_.b.point = b_.point(tracking_.b.point);
    place(a, tracking_.a);
    place(b, tracking_.b);
    const LoopEnd end = dqp3_variant<Release::kBase, Scan::kNeighbours>(a, b);
    tracking_ = {a.tracked(), b.tracked()};
    tracking_.a.point = a_.point_of_body(tracking_.a.point);
    tracking_.b.point = b_.point_of_body(tracking_.b.point);
    return {(b.common() - a.common()).norm(), end.ok, end.cycles};
  }

 private:
  MovedBody a_, b_;
  TrackingState tracking_;
};

// The loop on tables that are at their poses already. Reading the clock costs as much as several
// queries, so each is repeated, from what the last pose left.
void time_moved(benchmark::State& state, const std::string& name) {
  constexpr int kRepeats = 256;
  const Trajectory& t = workload(name).trajectories[0];
  Moved pair(t.a.get(), t.b.get());
  double spent = 0.0, queries = 0.0, sum = 0.0;
  for (auto _ : state) {
    pair.forget();
    for (const auto& [a, b] : t.poses) {
      pair.move(a, b);
      const TrackingState last = pair.tracking();
      const double start = cpu_ns();
      for (int i = 0; i < kRepeats; ++i) {
        pair.restore(last);
        sum += pair.loop().distance;
      }
      spent += cpu_ns() - start;
      queries += kRepeats;
    }
  }
  benchmark::DoNotOptimize(sum);
  state.counters["ns"] = spent / queries;
}

template <class Solver>
void register_variant(const std::string& name) {
  for (const std::string& load : workload_names()) {
    if (load[0] == 'v') continue;
    register_row<Solver>("variant/" + name + "/tracked/" + load, load, kTracked);
    register_row<Solver>("variant/" + name + "/cold/" + load, load, kCold);
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
  for (const int order : kOrders) {
    const std::string load = "f" + std::to_string(order);
    benchmark::RegisterBenchmark(("variant/moved-before/tracked/" + load).c_str(),
                                 [=](benchmark::State& s) { time_moved(s, load); });
  }
}

}  // namespace clearance::bench
