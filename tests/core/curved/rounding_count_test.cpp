// kUlpsOfA, kUlpsOfB and kUlpsOfOffset compared with the worst combined effect of all roundings of
// a curved query.
//
// Oracle: the straight-line code of the certificate of Newton's method and of the bounds of the
// search, in numbers that count their roundings (tests/core/model/counted.hpp). In the certificate,
// the resulting doubles equal those of the query, which shows that the code is the same. A random
// hill climb searches for the worst poses. The errors of the pose itself are counted in
// tests/core/model.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/curved/bounds.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/core/model/counted_vectors.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::Counted;
using test::counted;
using test::Counted3;
using test::made;

Counted3 operator-(const Counted3& a) { return {-a[0], -a[1], -a[2]}; }
Counted3 operator*(const Counted3& a, const Counted3& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
Counted3 operator/(const Counted3& a, const Counted& s) { return {a[0] / s, a[1] / s, a[2] / s}; }
Counted3 operator/(const Counted3& a, const Counted3& b) {
  return {a[0] / b[0], a[1] / b[1], a[2] / b[2]};
}
// The error of the matrix is counted elsewhere.
Counted3 product(const Mat3& r, const Counted3& v) {
  Counted3 out;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto at = [&](int column) {
      return Counted(r(i, column)) * v[static_cast<std::size_t>(column)];
    };
    out[static_cast<std::size_t>(i)] = (at(i) + at(j)) + at(k);
  }
  return out;
}

struct Query {
  ConvexBody a, b;
  RelativePose pose;
};

// One smooth part: the one with the greatest support value along m.
struct CountedSupport {
  Counted value;
  Counted3 point;
};
CountedSupport support(const ConvexBody& body, const Counted3& m) {
  const RoundParts round =
      visit(body.curved, [](const auto& shape) { return shape.round_parts(); });
  const Counted3 d = counted(Vec3(SemiAxes(round.semi_axes))), scaled = d * m;
  const Counted length = norm(scaled);
  const auto value = [&](const Disc& part) { return part.height * m[2] + part.radius * length; };
  const Disc* farthest = round.parts;
  for (std::int32_t i = 1; i < round.count; ++i) {
    if (value(round.parts[i]).value() > value(*farthest).value()) farthest = round.parts + i;
  }
  const Counted radius = farthest->radius;
  const Counted3 on_unit = d * scaled;
  const Counted3 out = {radius * on_unit[0], radius * on_unit[1], radius * on_unit[2]};
  return {value(*farthest), out / length + counted(Vec3(0, 0, farthest->height))};
}

// Error bounds in units of 2^-53 m. The bound for the unit direction is the value divided by the
// length of n, which has 2.5 roundings.
struct Worst {
  double lower, upper;
};
double worst_lower(const Counted& value) { return value.worst() + 2.5 * std::abs(value.value()); }

Counted3 forgotten(const Counted3& p) {
  return {p[0].forgotten(), p[1].forgotten(), p[2].forgotten()};
}
// The distance by which a support point along m may lie outside its body. An error along the
// surface does no harm.
double outside(const Counted3& p, const Counted3& m) {
  const auto term = [&](std::size_t i) { return plain_scaled(p[i], m[i].value()); };
  return plain_sum(plain_sum(term(0), term(1)), term(2)).worst();
}
Counted3 placed(const Query& q, const Counted3& p) {
  return product(q.pose.rotation, p) + counted(q.pose.translation);
}
double worst_upper(const Query& q, const Counted3& a, const Counted3& n, const Counted3& b,
                   const Counted3& m) {
  return outside(a, n) + outside(b, m) + norm(placed(q, forgotten(b)) - forgotten(a)).worst();
}

// Counts certify() of newton-inl.hpp.
Worst certified(const Query& q, const Vec3& normal) {
  const Counted3 n = counted(normal), m = -product(q.pose.rotation.transpose(), n);
  const CountedSupport a = support(q.a, n), b = support(q.b, m);
  return {worst_lower((dot(n, counted(q.pose.translation)) - a.value) - b.value),
          worst_upper(q, a.point, n, support(q.b, forgotten(m)).point, m)};
}
double certified_distance(const Query& q, const Vec3& normal) {
  const Counted3 n = counted(normal), m = -product(q.pose.rotation.transpose(), n);
  return norm(placed(q, support(q.b, m).point) - support(q.a, n).point).value();
}

// Counts CurvedPair::support() and add_points(). For a cone, clamp and scaling have fewer roundings
// than the scaling of an ellipsoid, so its support point is counted as it is.
Counted3 pulled_inside(const ConvexBody& body, const Counted3& p) {
  if (has_caps(body)) return p;
  return forgotten(p) / norm(forgotten(p) / counted(body.curved.semi_axes));
}
Worst searched(const Query& q, const Vec3& normal) {
  const Counted3 n = counted(normal), m = -product(q.pose.rotation.transpose(), n);
  const Counted3 a = support(q.a, n).point, b = support(q.b, m).point;
  const Counted3 b_of_m = support(q.b, forgotten(m)).point;
  return {worst_lower(dot(n, placed(q, b) - a)),
          worst_upper(q, pulled_inside(q.a, a), n, pulled_inside(q.b, b_of_m), m)};
}

struct Kind {
  const char* name;
  bool cone_a, cone_b;
  Worst (*worst)(const Query&, const Vec3&);
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

using Genes = std::array<double, 16>;

ConvexBody body_of(const Genes& g, std::size_t at, bool cone) {
  const auto length = [&](std::size_t i) { return std::exp2(3.0 * g[at + i]); };
  return cone ? made(truncated_cone(length(0), length(1), length(2)))
              : made(ellipsoid({length(0), length(1), length(2)}));
}
Query query_of(const Kind& kind, const Genes& g) {
  const Eigen::Quaterniond q(g[6] + 0.1, g[7], g[8], g[9]);
  const Pose b{std::exp2(3.0 * g[10]) * Vec3(g[11], g[12], g[13]), q.normalized()};
  return {body_of(g, 0, kind.cone_a), body_of(g, 3, kind.cone_b), relative_pose(Pose{}, b)};
}

class CurvedRoundingCounts : public testing::TestWithParam<Kind> {};

TEST(CurvedRoundingCountsOfNewton, AreOfTheOperationsOfItsCertificate) {
  Random random(1);
  int certified_ones = 0;
  for (int k = 0; k < 300; ++k) {
    Genes g;
    for (double& x : g) x = random.uniform(-1.0, 1.0);
    const Kind kind{"", false, k % 2 == 0, nullptr};
    Query q = query_of(kind, g);
    q.pose = relative_pose(Pose{}, {20.0 * random.direction(), random.rotation()});
    TrackingState state;
    const DistanceResult r = distance(q.a, q.b, q.pose, state);
    if (r.status != DistanceStatus::kConverged || r.iterations > 12) continue;
    Counted::forget_all();
    certified_ones += certified_distance(q, r.normal) == r.distance;
  }
  EXPECT_GT(certified_ones, 200);
}

// The fraction of the promised error that the worst roundings use.
double used(const Kind& kind, const Genes& g) {
  const Query q = query_of(kind, g);
  const Vec3 n = Vec3(g[14], g[15], g[13] + 0.01).normalized();
  Counted::forget_all();
  const Worst worst = kind.worst(q, n);
  const double promised = kUlpsOfA * q.a.bounding_radius + kUlpsOfB * q.b.bounding_radius +
                          kUlpsOfOffset * q.pose.translation.norm();
  return std::max(worst.lower, worst.upper) / promised;
}

TEST_P(CurvedRoundingCounts, CoverAllRoundingsAtOnceWhereTheyAreWorst) {
  using Sample = std::pair<double, Genes>;
  Random random(2);
  std::vector<Sample> best;
  const auto try_this = [&](const Genes& g) {
    const double share = used(GetParam(), g);
    EXPECT_LE(share, 1.0);
    best.emplace_back(share, g);
  };
  const auto keep_best = [&] {
    std::sort(best.begin(), best.end(),
              [](const Sample& x, const Sample& y) { return x.first > y.first; });
    best.resize(20);
  };
  for (int k = 0; k < 500; ++k) {
    Genes g;
    for (double& x : g) x = random.uniform(-1.0, 1.0);
    try_this(g);
  }
  keep_best();
  double step = 0.3;
  for (int round = 0; round < 40; ++round, step *= 0.93) {
    for (std::size_t k = 0; k < 60; ++k) {
      Genes g = best[k % 20].second;
      for (double& x : g) {
        if (random.chance(0.2)) x = std::clamp(x + step * random.uniform(-1.0, 1.0), -1.0, 1.0);
      }
      try_this(g);
    }
    keep_best();
  }
  EXPECT_GT(best[0].first, 0.45) << "the counts are larger than they need be, or nothing was found";
  RecordProperty("used", std::to_string(best[0].first));
}

constexpr Kind kKinds[] = {{"NewtonOnEllipsoids", false, false, certified},
                           {"NewtonOnCones", true, true, certified},
                           {"NewtonOnEllipsoidAndCone", false, true, certified},
                           {"SearchOnEllipsoids", false, false, searched},
                           {"SearchOnConeAndEllipsoid", true, false, searched}};
INSTANTIATE_TEST_SUITE_P(Of, CurvedRoundingCounts, testing::ValuesIn(kKinds),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace clearance
