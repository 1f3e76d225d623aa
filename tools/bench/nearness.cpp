#include "tools/bench/rows.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/random.hpp"

namespace clearance::bench {
namespace {

constexpr int kPairs = 60, kSteps = 20;
constexpr double kGaps[] = {1e-9, 1e-6, 1e-3, 1.0, 1e3};
constexpr double kStep = 0.002, kTurn = 0.005;
// Bodies as near as this are not rotated, because a rotation would make them overlap.
constexpr double kNear = 1e-3;
constexpr double kWide = 1e-13;

// The larger semi-axis is 1 m, the shortest `thinness` times shorter.
struct Kind {
  const char* name;
  const char *a, *b;
  double thinness;
};
constexpr Kind kKindsOfNearness[] = {
    {"ellipsoids-5", "ellipsoid", "ellipsoid", 5.0},
    {"ellipsoids-100", "ellipsoid", "ellipsoid", 100.0},
    {"ellipsoids-1e4", "ellipsoid", "ellipsoid", 1e4},
    {"cylinders-2", "cylinder", "cylinder", 2.0},
    {"cylinders-1e4", "cylinder", "cylinder", 1e4},
    {"cones-2", "cone", "cone", 2.0},
    {"cones-1e4", "cone", "cone", 1e4},
    {"ellipsoid-box-5", "ellipsoid", "box", 5.0},
};

// Discs and needles alike.
ConvexBody thin_body(std::string_view kind, double thinness, Random& random) {
  const auto made = [](ShapeResult shape) { return std::get<ConvexBody>(std::move(shape)); };
  const double least = 1.0 / thinness, middle = std::pow(least, random.uniform(0.0, 1.0));
  if (kind == "ellipsoid") return made(ellipsoid({1.0, middle, least}));
  if (kind == "box") return made(box({1.0, middle, least}));
  const bool disc = random.uniform(0.0, 1.0) < 0.5;
  const double radius = disc ? 1.0 : least, half_length = disc ? least : 1.0;
  return kind == "cone" ? made(cone(radius, half_length)) : made(cylinder(radius, half_length));
}

DistanceResult cold(const Trajectory& pair, const Pose& a, const Pose& b) {
  TrackingState state;
  return distance(*pair.a, *pair.b, a, b, state);
}

// B moves along the line of the closest points. Returns their direction in the world.
Vec3 bring_to(double gap, const Trajectory& pair, const Pose& a, Pose& b) {
  const DistanceResult r = cold(pair, a, b);
  const Vec3 normal = a.orientation * r.normal;
  b.position -= (r.distance - gap) * normal;
  return normal;
}

// B slides across the line of the closest points, and is as far away after every step.
Trajectory sliding(const Kind& kind, double gap, Random& random) {
  const auto body = [&](const char* of) {
    return std::make_shared<const ConvexBody>(thin_body(of, kind.thinness, random));
  };
  Trajectory pair{body(kind.a), body(kind.b), {}};
  const Pose a{Vec3::Zero(), random.turn()};
  Pose b{4.0 * random.direction(), random.turn()};
  const Vec3 along = random.direction();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(kTurn, random.direction()));
  for (int k = 0; k < kSteps; ++k) {
    const Vec3 normal = bring_to(gap, pair, a, b);
    pair.poses.emplace_back(a, b);
    b.position += kStep * (along - along.dot(normal) * normal).normalized();
    if (gap > kNear) b.orientation = turn * b.orientation;
  }
  return pair;
}

class Slides {
 public:
  Slides(const Kind& kind, double gap, bool tracked) : tracked_(tracked) {
    Random random(6);
    for (int i = 0; i < kPairs; ++i) pairs_.push_back(sliding(kind, gap, random));
    states_.resize(pairs_.size());
  }
  [[nodiscard]] std::size_t queries() const { return pairs_.size() * steps(); }

  // Tracked pairs go back and forth.
  template <class Use>
  void follow(const Use& use) {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      for (std::size_t k = 0; k < steps(); ++k) {
        const auto& [a, b] = pairs_[i].poses[std::min(k, steps() - 1 - k)];
        if (!tracked_) states_[i] = {};
        use(pairs_[i], distance(*pairs_[i].a, *pairs_[i].b, a, b, states_[i]));
      }
    }
  }

 private:
  [[nodiscard]] std::size_t steps() const { return tracked_ ? 2 * kSteps : 1; }

  bool tracked_;
  std::vector<Trajectory> pairs_;
  std::vector<TrackingState> states_;
};

void count_supports(benchmark::State& state, Slides& slides) {
  double sum = 0.0, most = 0.0, wide = 0.0;
  slides.follow([&](const Trajectory& pair, const DistanceResult& r) {
    const double size = pair.a->bounding_radius + pair.b->bounding_radius;
    sum += r.iterations;
    most = std::max(most, static_cast<double>(r.iterations));
    wide += !(r.upper - r.lower <= kWide * (size + r.distance));
  });
  count_steps(state, sum / static_cast<double>(slides.queries()));
  state.counters["most_iterations"] = most;
  state.counters["wide"] = wide;
}

void time_slides(benchmark::State& state, const Kind& kind, double gap, bool tracked) {
  Slides slides(kind, gap, tracked);
  slides.follow([](const Trajectory&, const DistanceResult&) {});  // so that all are tracked
  count_supports(state, slides);
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(slides.queries()))) {
    slides.follow([](const Trajectory&, const DistanceResult& r) {
      double lower = r.lower;
      benchmark::DoNotOptimize(lower);
    });
  }
  state.counters["ns"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

void register_nearness() {
  for (const bool tracked : {false, true}) {
    for (const Kind& kind : kKindsOfNearness) {
      for (const double gap : kGaps) {
        const std::string name =
            fmt::format("nearness/{}/{}/{:g}", tracked ? "tracked" : "cold", kind.name, gap);
        benchmark::RegisterBenchmark(
            name.c_str(), [=](benchmark::State& state) { time_slides(state, kind, gap, tracked); });
      }
    }
  }
}

}  // namespace clearance::bench
