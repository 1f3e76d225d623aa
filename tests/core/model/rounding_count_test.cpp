// Precision::error_bound compared with the worst combined effect of all roundings of a query.
//
// Oracle: the straight-line code of feature tracking, repeated in numbers that record their
// roundings (tests/core/model/counted.hpp). The resulting doubles must equal those of feature
// tracking, which shows that the code is the same. A random hill climb searches for the poses with
// the worst roundings.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "core/feature_tracking/feature_tracking.hpp"
#include "core/model/error_bounds.hpp"
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

Counted3 operator*(const Counted& s, const Counted3& a) { return {s * a[0], s * a[1], s * a[2]}; }
Counted3 cross(const Counted3& a, const Counted3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Counted inverse_norm_near_1(const Counted3& a) { return 1.5 - 0.5 * dot(a, a); }

struct CountedQuaternion {
  Counted3 v;
  Counted w;
  explicit CountedQuaternion(const Eigen::Quaterniond& q) : v(counted(q.vec())), w(q.w()) {}
  CountedQuaternion(const Counted3& vector, const Counted& scalar) : v(vector), w(scalar) {}
};

// conj(a) b, like relative() of core/model/relative_pose-inl.hpp.
CountedQuaternion relative(const CountedQuaternion& a, const CountedQuaternion& b) {
  const auto& [ax, ay, az] = a.v;
  const auto& [bx, by, bz] = b.v;
  return {{(a.w * bx + az * by) - (ay * bz + ax * b.w), (a.w * by - az * bx) + (ax * bz - ay * b.w),
           (ay * bx - ax * by) + (a.w * bz - az * b.w)},
          (ax * bx + ay * by) + (az * bz + a.w * b.w)};
}

Counted two_over_square(const CountedQuaternion& q) {
  const Counted square = (q.w * q.w + q.v[0] * q.v[0]) + (q.v[1] * q.v[1] + q.v[2] * q.v[2]);
  return doubled(2.0 - square);
}

struct CountedPlace {
  std::array<Counted3, 3> rotation;
  Counted3 translation;

  CountedPlace(const Pose& a, const Pose& b) {
    const CountedQuaternion q_a(a.orientation), q = relative(q_a, CountedQuaternion(b.orientation));
    set_rotation(q);
    const Counted3 between = counted(b.position) - counted(a.position), c = cross(q_a.v, between);
    translation = between + two_over_square(q_a) * (cross(q_a.v, c) - q_a.w * c);
  }
  void set_rotation(const CountedQuaternion& q) {
    const Counted s = two_over_square(q);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      rotation[i][i] = 1.0 - s * (q.v[j] * q.v[j] + q.v[k] * q.v[k]);
      const Counted product = q.v[i] * q.v[j], by_w = q.w * q.v[k];
      rotation[i][j] = s * (product - by_w);
      rotation[j][i] = s * (product + by_w);
    }
  }
  [[nodiscard]] Counted3 direction(const Counted3& v) const {
    return product(v, [&](std::size_t i, std::size_t j) { return rotation[i][j]; });
  }
  [[nodiscard]] Counted3 point(const Counted3& p) const { return direction(p) + translation; }

 private:
  template <class Entry>
  static Counted3 product(const Counted3& v, const Entry& entry) {
    Counted3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      out[i] = (entry(i, i) * v[i] + entry(i, j) * v[j]) + entry(i, k) * v[k];
    }
    return out;
  }
};

// A pair of closest features, each with the radius of a ball around its body's origin that contains
// it.
struct Pair {
  ConvexBody a, b;
  Pose pose_a, pose_b;
  double reach_a, reach_b;
};

// The parameters of a pair: two rotations, two witness points, the vector between them, two edges.
using Genes = std::array<double, 26>;

struct Made {
  Pose pose_a, pose_b;
  Vec3 on_a, on_b, n, own_n;  // witness points and normal, the latter in frame A and in frame B
  Vec3 edge_a, edge_b;        // normal to it, each in its own frame
  double from_a, from_b;      // starts of the edges
};

Made made_of(const Genes& g) {
  const auto vec = [&](std::size_t i) { return Vec3(g[i], g[i + 1], g[i + 2]); };
  const auto turn = [&](std::size_t i) {
    return Eigen::Quaterniond(g[i + 3], g[i], g[i + 1], g[i + 2]).normalized();
  };
  Made m;
  m.pose_a = {Vec3(0.3, -0.7, 0.2), turn(0)};
  const Eigen::Quaterniond b = turn(4), between = m.pose_a.orientation.conjugate() * b;
  m.on_a = vec(8);
  m.on_b = vec(11);
  m.n = vec(14).normalized();
  m.own_n = between.conjugate() * m.n;
  const Vec3 offset = m.on_a + std::abs(g[17]) * m.n - between * m.on_b;
  m.pose_b = {m.pose_a.position + m.pose_a.orientation * offset, b};
  m.edge_a = m.n.cross(vec(18)).normalized();
  m.edge_b = between.conjugate() * m.n.cross(vec(23)).normalized();
  m.from_a = g[21];
  m.from_b = g[22];
  return m;
}

ConvexBody through(const Vec3& p, const Vec3& along, double from) {
  return made(segment(p - std::abs(from) * along, p + 0.5 * std::abs(from) * along, 0.0));
}
ConvexBody below(const Vec3& p, const Vec3& n) {
  const HalfSpace row{n, n.dot(p)};
  return made(polyhedron_from_halfspaces({&row, 1}));
}
ConvexBody at_point(const Vec3& p) { return made(point(p, 0.0)); }

struct Kind {
  const char* name;
  FeatureKind kind_a, kind_b;
  Pair (*pair)(const Made&);
  Counted (*apart)(const Pair&, const CountedPlace&);
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

Counted3 start_of(const ConvexBody& body) { return counted(body.edges[0].point); }
Counted3 along(const ConvexBody& body) { return counted(body.edges[0].direction); }
Counted3 corner(const ConvexBody& body) { return counted(body.vertices[0].position); }
double farthest(const ConvexBody& body) { return body.bounding_radius; }

constexpr Kind kKinds[] = {
    {"vertex, vertex", FeatureKind::kVertex, FeatureKind::kVertex,
     [](const Made& m) {
       return Pair{at_point(m.on_a), at_point(m.on_b), m.pose_a, m.pose_b, 0, 0};
     },
     [](const Pair& p, const CountedPlace& at) {
       return norm(at.point(corner(p.b)) - corner(p.a));
     }},
    {"edge, vertex", FeatureKind::kEdge, FeatureKind::kVertex,
     [](const Made& m) {
       return Pair{through(m.on_a, m.edge_a, m.from_a), at_point(m.on_b), m.pose_a, m.pose_b, 0, 0};
     },
     [](const Pair& p, const CountedPlace& at) {
       return norm(cross(at.point(corner(p.b)) - start_of(p.a), along(p.a)));
     }},
    {"vertex, edge", FeatureKind::kVertex, FeatureKind::kEdge,
     [](const Made& m) {
       return Pair{at_point(m.on_a), through(m.on_b, m.edge_b, m.from_b), m.pose_a, m.pose_b, 0, 0};
     },
     [](const Pair& p, const CountedPlace& at) {
       const Counted3 e = at.direction(along(p.b)), start = at.point(start_of(p.b));
       return inverse_norm_near_1(e) * norm(cross(corner(p.a) - start, e));
     }},
    {"facet, vertex", FeatureKind::kFacet, FeatureKind::kVertex,
     [](const Made& m) {
       return Pair{below(m.on_a, m.n), at_point(m.on_b), m.pose_a, m.pose_b, m.on_a.norm(), 0};
     },
     [](const Pair& p, const CountedPlace& at) {
       const Facet& facet = p.a.facets[0];
       return dot(counted(facet.normal), at.point(corner(p.b))) - facet.offset;
     }},
    {"vertex, facet", FeatureKind::kVertex, FeatureKind::kFacet,
     [](const Made& m) {
       const Vec3 out = -m.own_n;
       return Pair{at_point(m.on_a), below(m.on_b, out), m.pose_a, m.pose_b, 0, m.on_b.norm()};
     },
     [](const Pair& p, const CountedPlace& at) {
       const Facet& facet = p.b.facets[0];
       const Counted3 n = at.direction(counted(facet.normal));
       return inverse_norm_near_1(n) * dot(n, corner(p.a) - at.translation) - facet.offset;
     }},
    {"edge, edge", FeatureKind::kEdge, FeatureKind::kEdge,
     [](const Made& m) {
       return Pair{through(m.on_a, m.edge_a, m.from_a),
                   through(m.on_b, m.edge_b, m.from_b),
                   m.pose_a,
                   m.pose_b,
                   0,
                   0};
     },
     // The upper bound. The points may be anywhere along the edges.
     [](const Pair& p, const CountedPlace& at) {
       const Counted3 e = along(p.a), f = at.direction(along(p.b)),
                      start_b = at.point(start_of(p.b));
       const Counted3 between = start_b - start_of(p.a), n = cross(e, f);
       const Counted sine2 = dot(n, n), cosine = dot(e, f), along_e = dot(between, e);
       const Counted t = dot(cross(between, e), n) / sine2, s = along_e + cosine * t;
       return norm((start_b + t.forgotten() * f) - (start_of(p.a) + s.forgotten() * e));
     }}};

// The lower bound across two edges, evaluated up to the far ends of both, relative to their starts.
// It counts the roundings along n as it is. It also counts what the subtracted tilts may hide: 1.5
// ulps of their products, and one ulp of the edge.
Counted lower_across(const Pair& p, const CountedPlace& at) {
  const Counted3 e = along(p.a), f = at.direction(along(p.b)), start_b = at.point(start_of(p.b));
  Counted3 n = cross(e, f);
  for (Counted& x : n) x = x.forgotten();
  const Counted between = dot(start_b - start_of(p.a), n), sine = sqrt(dot(n, n));
  Counted far_f = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    far_f = plain_sum(far_f, plain_scaled(f[i], n[i].value() * p.b.edges[0].end));
  }
  return plain_sum(between, far_f) / sine;
}

struct Worst {
  double by_roundings, error_bound, size;  // m
};

struct Evaluated {
  const Kind& kind;
  Pair pair;

  [[nodiscard]] double reach_a() const { return std::max(pair.reach_a, farthest(pair.a)); }
  [[nodiscard]] double reach_b() const { return std::max(pair.reach_b, farthest(pair.b)); }

  [[nodiscard]] Worst worst() const {
    Counted::forget_all();
    const CountedPlace at(pair.pose_a, pair.pose_b);
    const Counted apart = kind.apart(pair, at);
    double by_roundings = apart.worst();
    if (kind.kind_a == FeatureKind::kEdge && kind.kind_b == FeatureKind::kEdge) {
      const double lengths = pair.a.edges[0].end + pair.b.edges[0].end;
      by_roundings = std::max(by_roundings, lower_across(pair, at).worst() + 2.5 * lengths);
    }
    // The error bound of precision(), for bodies whose bounding radii are these.
    const double o = (pair.pose_b.position - pair.pose_a.position).norm();
    const double a = reach_a(), b = reach_b();
    const double turned = std::min(b, a + o + kStretched * apart.value());
    const double error_bound = kUlp * (kUlpsOnA * a + kUlpsOnB * b + kUlpsBetween * o) +
                               kTranslationError * o + kRotationError * turned;
    return {kUlp * by_roundings, error_bound, a + b + o};
  }
};

class RoundingCounts : public testing::TestWithParam<Kind> {};

Genes random_genes(Random& random) {
  Genes g;
  const double size_a = random.log_uniform(1e-3, 10.0), size_b = random.log_uniform(1e-3, 10.0);
  for (double& x : g) x = random.uniform(-1.0, 1.0);
  for (std::size_t i : {8, 9, 10, 21}) g[i] *= size_a;
  for (std::size_t i : {11, 12, 13, 22}) g[i] *= size_b;
  g[17] *= random.log_uniform(1e-3, 10.0);
  return g;
}

TEST_P(RoundingCounts, AreOfTheOperationsOfTheWalk) {
  Random random(1);
  int proved = 0;
  for (int k = 0; k < 300; ++k) {
    const Pair pair = GetParam().pair(made_of(random_genes(random)));
    TrackingState state{{GetParam().kind_a, false, 0}, {GetParam().kind_b, false, 0}};
    DistanceResult r;
    const RelativePose at_pose = relative_pose(pair.pose_a, pair.pose_b);
    const TrackingEnd end = track_features({pair.a, pair.b, at_pose, state}, r);
    if (end != TrackingEnd::kCertified || r.iterations != 1) continue;
    ++proved;
    Counted::forget_all();
    const CountedPlace at(pair.pose_a, pair.pose_b);
    EXPECT_EQ(GetParam().apart(pair, at).value(), r.distance) << k;
  }
  EXPECT_GT(proved, 100);
}

TEST_P(RoundingCounts, CoverAllRoundingsAtOnceWhereTheyAreWorst) {
  using Sample = std::pair<double, Genes>;
  Random random(2);
  const auto used = [&](const Genes& g) {
    const Worst w = Evaluated{GetParam(), GetParam().pair(made_of(g))}.worst();
    if (!std::isfinite(w.by_roundings)) return 0.0;  // the direction between them is undefined
    EXPECT_LE(w.by_roundings, w.error_bound);
    return w.by_roundings / w.error_bound;
  };
  std::vector<Sample> best;
  const auto keep_best = [&](std::size_t count) {
    std::sort(best.begin(), best.end(),
              [](const Sample& x, const Sample& y) { return x.first > y.first; });
    best.resize(count);
  };
  const auto try_this = [&](const Genes& g) {
    // Segments that degenerate to points, and edges that hardly cross, are left out.
    if (std::abs(g[21]) < 1e-6 || std::abs(g[22]) < 1e-6) return;
    best.emplace_back(used(g), g);
  };
  for (int k = 0; k < 500; ++k) try_this(random_genes(random));
  keep_best(20);
  double step = 0.3;
  for (int round = 0; round < 60; ++round, step *= 0.95) {
    for (int k = 0; k < 60; ++k) {
      Genes g = best[static_cast<std::size_t>(k) % 20].second;
      for (double& x : g) {
        if (random.chance(0.2)) x += step * random.uniform(-1.0, 1.0) * (std::abs(x) + 0.01);
      }
      try_this(g);
    }
    keep_best(20);
  }
  EXPECT_GT(best[0].first, 0.6) << "the counts are larger than they need be, or nothing was found";
  RecordProperty("used", std::to_string(best[0].first));
}

// The bounds that kMatrixError consists of, in ulps.
double matrix_bound(const Eigen::Quaterniond& q) {
  const Vec3 x = q.vec();
  const Mat3 r = rotation_matrix(q);
  Mat3 bounds;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double p = x[j] * x[j] + x[k] * x[k];
    const double products = 2.0 * (std::abs(x[i] * x[j]) + std::abs(q.w() * x[k]));
    bounds(i, i) = 4.0 * p * (1.0 - p) + 4.0 * p + 0.5;
    bounds(i, j) = 3.0 * std::abs(r(i, j)) + products;
    bounds(j, i) = 3.0 * std::abs(r(j, i)) + products;
  }
  const Mat3 square = bounds.transpose() * bounds;
  const double largest = Eigen::SelfAdjointEigenSolver<Mat3>(square).eigenvalues()[2];
  return 6.0 * x.norm() + std::sqrt(largest);
}

TEST(RoundingCountsOfTheMatrix, AreAsLargeAsTheLargestSumOfTheirParts) {
  Random random(3);
  Eigen::Quaterniond best = random.rotation();
  double most = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double step = k < 10000 ? 10.0 : std::exp(-k / 1500.0);
    Eigen::Quaterniond q = random.rotation();
    q.coeffs() = (best.coeffs() + step * q.coeffs()).normalized();
    const double bound = matrix_bound(q);
    if (bound > most) best = q;
    most = std::max(most, bound);
  }
  EXPECT_LT(most, kMatrixError / kUlp);
  EXPECT_GT(most, kMatrixError / kUlp - 0.2);
}

INSTANTIATE_TEST_SUITE_P(Of, RoundingCounts, testing::ValuesIn(kKinds), [](const auto& test) {
  std::string name = test.param.name;
  name.replace(name.find(", "), 2, "_and_");
  return name;
});

}  // namespace
}  // namespace clearance
