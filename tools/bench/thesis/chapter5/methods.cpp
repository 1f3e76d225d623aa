#include "tools/bench/thesis/chapter5/methods.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/bench/thesis/chapter5/alternating.hpp"
#include "tools/bench/thesis/chapter5/dominant_term.hpp"
#include "tools/bench/thesis/chapter5/facet_ball.hpp"
#include "tools/bench/thesis/chapter5/free_margin.hpp"
#include "tools/bench/thesis/chapter5/hybrid.hpp"
#include "tools/bench/thesis/chapter5/polyhedron_to_ellipsoid.hpp"
#include "tools/bench/thesis/chapter5/refinement.hpp"
#include "tools/bench/thesis/chapter5/safeguarded_newton.hpp"
#include "tools/bench/thesis/chapter5/support_gjk.hpp"

namespace clearance::bench {
namespace {

ConvexBody made(const Vec3& axes) { return std::get<ConvexBody>(ellipsoid(axes)); }

ClosestPoints of(const DistanceResult& r) {
  return {r.point_on_a, r.point_on_b, r.iterations, r.status == DistanceStatus::kConverged};
}

Run ours_cold(const EllipsoidPair& pair) {
  return [a = made(pair.axes_a), b = made(pair.axes_b), there = Pose{pair.apart}](int) {
    TrackingState cold;
    return of(distance(a, b, Pose{}, there, cold));
  };
}

// B comes from 2 mm beside every other time, and from there goes back to it.
Run ours_tracked(const EllipsoidPair& pair) {
  struct Tracked {
    ConvexBody a, b;
    Pose there, beside;
    TrackingState state;
    bool away = false;
  };
  const auto tracked = std::make_shared<Tracked>(Tracked{made(pair.axes_a),
                                                         made(pair.axes_b),
                                                         Pose{pair.apart},
                                                         Pose{pair.apart + 0.002 * Vec3::UnitY()},
                                                         {}});
  (void)distance(tracked->a, tracked->b, Pose{}, tracked->beside, tracked->state);
  return [tracked](int) {
    Tracked& t = *tracked;
    const ClosestPoints found =
        of(distance(t.a, t.b, Pose{}, t.away ? t.beside : t.there, t.state));
    t.away = !t.away;
    return found;
  };
}

template <NearestPointMethod* kNearest, Turns kTurns = Turns::kInTurn>
Run alternating(const EllipsoidPair& pair) {
  return [pair](int rounds) { return alternate(pair, kNearest, rounds, kTurns); };
}

Run facet_balls(const EllipsoidPair& pair) {
  return [pair, models = std::make_shared<FacetBallPair>(pair, kModelOrder)](int) {
    models->forget();
    return models->closest<Scan::kAllFacets>(pair.apart);
  };
}

template <Cluster kCluster>
Run refining(const EllipsoidPair& pair) {
  return [pair](int cycles) { return refine(pair, kCluster, cycles); };
}

Run hybrid_of(const EllipsoidPair& pair) {
  return [pair, models = std::make_shared<FacetBallPair>(pair, kHybridOrder)](int rounds) {
    return hybrid(*models, pair, rounds);
  };
}

Run facet_ball_to_ellipsoid(const EllipsoidPair& pair) {
  return [pair, model = ellipsoid_model(pair.axes_a, kModelOrder)](int) {
    return polyhedron_to_ellipsoid(model, pair.axes_b, pair.apart);
  };
}

Run margin_of(const EllipsoidPair& pair) {
  return [pair](int) {
    const FreeMargin m = free_margin(pair);
    return ClosestPoints{m.nearest, m.touched, 0, true};
  };
}

template <int kDigits>
Run gjk(const EllipsoidPair& pair) {
  return [pair](int rounds) { return support_gjk(pair, std::pow(10.0, -kDigits), rounds); };
}

}  // namespace

const std::vector<Method>& methods() {
  constexpr int kMany = 100'000, kCycles = 200;
  static const std::vector<Method> all = {
      {"ours", "ours, cold", 0, ours_cold},
      {"ours-tracked", "ours, tracked", 0, ours_tracked},
      {"alternating", "point to ellipsoid iteration (§5.2), Newton", kMany, alternating<by_newton>},
      {"alternating-dominant", "the same, dominant term", kMany, alternating<by_dominant_term>},
      {"facet-balls", "polyhedral model (§5.3), 288 facets each", 0, facet_balls},
      {"refinement-4", "iterative polyhedral (§5.4), 4 facets", kCycles, refining<Cluster::kFour>},
      {"refinement-7", "iterative polyhedral (§5.4), 7 facets", kCycles, refining<Cluster::kSeven>},
      {"hybrid", "hybrid (§5.5.2)", kMany, hybrid_of},
      {"polyhedron-ellipsoid", "288 facets to ellipsoid (§5.5.1)", 0, facet_ball_to_ellipsoid},
      {"free-margin", "free margin (Rimon and Boyd)", 0, margin_of},
      {"gjk", "GJK on support functions, 1e-6", 10'000, gjk<6>},
      {"gjk-tight", "GJK on support functions, 1e-12", 10'000, gjk<12>},
  };
  return all;
}

int rounds_to(double tolerance, const Run& run, int most_rounds, const ClosestPoints& truth) {
  // Doubling first: iterations of thousands of rounds are run a dozen times, not thousands.
  int low = 0, high = 1;
  const auto there = [&](int rounds) { return x_error(run(rounds), truth) < tolerance; };
  while (!there(high)) {
    if (high >= most_rounds) return 0;
    low = high;
    high = std::min(2 * high, most_rounds);
  }
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (there(middle) ? high : low) = middle;
  }
  return high;
}

NearestPoint<3> by_dominant_term(const Vec3& axes, const Vec3& p) {
  return nearest_by_dominant_term<3>(axes, p);
}
NearestPoint<3> by_dominant_term_as_printed(const Vec3& axes, const Vec3& p) {
  return nearest_by_dominant_term<3>(
      axes, p, {.tolerance = 1e-10, .most_iterations = 40, .nearest_to_pole = 1e-3});
}
NearestPoint<3> by_newton(const Vec3& axes, const Vec3& p) { return nearest_by_newton<3>(axes, p); }

}  // namespace clearance::bench
