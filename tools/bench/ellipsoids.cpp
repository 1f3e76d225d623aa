#include "tools/bench/ellipsoids.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <variant>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/bench/measure.hpp"

namespace clearance::bench {
namespace {

// B is A turned by a quarter about y; both frames are parallel here, and B's origin is `apart`.
struct Crossed {
  Vec3 axes_a{1.0, 2.0, 5.0}, axes_b{5.0, 2.0, 1.0};
  Vec3 apart;
  Truth truth;
};

ConvexPolyhedron made(const Vec3& axes) { return std::get<ConvexPolyhedron>(ellipsoid(axes)); }

// Along [1 1 1], as the thesis has it, so far that the distance is `separation`; at p = [4 4 4] it
// is 1.29549481993874080913966969921.
Crossed crossed(double separation) {
  Crossed pair;
  const ConvexPolyhedron a = made(pair.axes_a), b = made(pair.axes_b);
  double near = 2.0, far = 10.0;
  for (int round = 0; round < 100; ++round) {
    const double middle = 0.5 * (near + far);
    TrackingState cold;
    const Pose there{Vec3::Constant(middle)};
    (distance(a, b, Pose{}, there, cold).distance < separation ? near : far) = middle;
  }
  pair.apart = Vec3::Constant(separation == 1.2955 ? 4.0 : near);
  pair.truth = TrueDistance(a, b).at(Pose{}, Pose{pair.apart});
  return pair;
}

struct Projection {
  Vec3 point;
  int steps;
};

// (5.1.9): the point of an ellipsoid nearest to y, outside of it, is a_i^2 y_i / (a_i^2 + t), where
// the sum of (a_i y_i / (a_i^2 + t))^2 is 1. The sum is convex and falls with t: Newton's method
// from t = 0 never passes the root.
Projection project(const Vec3& axes, const Vec3& y) {
  const Vec3 squares = axes.cwiseProduct(axes);
  double t = 0.0;
  for (int step = 1; step < 200; ++step) {
    double value = -1.0, slope = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double below = squares[i] + t, term = axes[i] * y[i] / below;
      value += term * term;
      slope -= 2.0 * term * term / below;
    }
    const double next = t - value / slope;
    if (!(next > t)) {
      return {squares.cwiseProduct(y).cwiseQuotient((squares.array() + t).matrix()), step};
    }
    t = next;
  }
  return {y, 200};
}

// §5.2: the point of A nearest to that of B, the point of B nearest to that of A, and so on, until
// they stay where they are.
Answer alternate(const Crossed& pair) {
  constexpr int kMostRounds = 100'000;
  Vec3 on_a = Vec3::Zero(), on_b = pair.apart;
  double before = kInfinity;
  for (int round = 1; round <= kMostRounds; ++round) {
    on_a = project(pair.axes_a, on_b).point;
    on_b = pair.apart + project(pair.axes_b, on_a - pair.apart).point;
    const double now = (on_b - on_a).norm();
    if (!(now < before)) return {now, true, round};
    before = now;
  }
  return {before, false, kMostRounds};
}

class OurMethod {
 public:
  explicit OurMethod(const Crossed& pair)
      : a_(made(pair.axes_a)), b_(made(pair.axes_b)), world_from_b_{pair.apart} {}
  Answer operator()() {
    TrackingState cold;
    const DistanceResult r = distance(a_, b_, Pose{}, world_from_b_, cold);
    return {r.distance, r.status == DistanceStatus::kConverged, r.iterations, r.upper - r.lower};
  }

 private:
  ConvexPolyhedron a_, b_;
  Pose world_from_b_;
};

template <class Method>
void time(benchmark::State& state, const Truth& truth, Method&& method) {
  Verdict verdict;
  verdict.add(method(), truth);
  for (auto _ : state) benchmark::DoNotOptimize(method().distance);
  const double queries = static_cast<double>(state.iterations());
  state.counters["ns"] =
      benchmark::Counter(queries * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  count(state, verdict);
}

}  // namespace

void register_ellipsoids() {
  for (const double separation : {0.001, 0.1, 0.5, 1.2955, 5.0}) {
    benchmark::RegisterBenchmark(fmt::format("ellipsoids/ours/{}", separation).c_str(),
                                 [=](benchmark::State& state) {
                                   const Crossed pair = crossed(separation);
                                   time(state, pair.truth, OurMethod(pair));
                                 });
    benchmark::RegisterBenchmark(fmt::format("ellipsoids/alternating/{}", separation).c_str(),
                                 [=](benchmark::State& state) {
                                   const Crossed pair = crossed(separation);
                                   time(state, pair.truth, [&] { return alternate(pair); });
                                 });
  }
}

}  // namespace clearance::bench
