#include "core/gjk/gjk.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/active_set/certificate.hpp"
#include "core/gjk/simplex.hpp"
#include "core/model/support_function.hpp"
#include "core/vec.hpp"

namespace clearance {
namespace {

// If the bounds are wider than promised after these rounds, the status is kIterationLimit.
constexpr int kRounds = 64;

using Wide = Vector<DoubleDouble>;
Wide wide(const Vec3& v) noexcept { return vector_of<DoubleDouble>(v); }

// A point of the Minkowski difference B - A, and where it comes from.
struct DifferenceVertex {
  Vec3 a;    // in frame A
  Vec3 b_B;  // in frame B
  Wide b;    // the same in frame A
  Wide difference;

  [[nodiscard]] bool operator==(const DifferenceVertex& other) const noexcept {
    return a == other.a && rounded(b) == rounded(other.b);
  }
};
using WideSimplex = Simplex<DifferenceVertex, DoubleDouble>;

// B - A by its support points, placed in double-double. If bodies nearly touch, simplices are
// slender, and in doubles the differences of their vertices would keep few digits.
class WideMinkowskiDifference {
 public:
  WideMinkowskiDifference(const ActiveFeature& a, const ActiveFeature& b,
                          const RelativePose& a_from_b, const Precision& p) noexcept
      : a_(a), b_(b), pose_(a_from_b), p_(p) {}

  // The support point along -n, with n in frame A.
  [[nodiscard]] DifferenceVertex support_point(const Vec3& n) const noexcept {
    return make(cut_off_support(a_.body(), n, p_.extent_a),
                cut_off_support(b_.body(), -b_.direction_A_to_L(n), p_.extent_b));
  }
  [[nodiscard]] DifferenceVertex make(const Vec3& a, const Vec3& b_own) const noexcept {
    DifferenceVertex c{a, b_own, to_a(b_own), {}};
    c.difference = c.b - wide(c.a);
    return c;
  }

 private:
  // Unbounded bodies are cut off four times farther out than the closest points can be.
  static Vec3 cut_off_support(const ConvexBody& body, const Vec3& m, double extent) noexcept {
    Vec3 point = body.anchors[support(body, m).anchor];
    const Ray* steepest = nullptr;
    double slope = 0.0;
    for (const Ray& ray : body.rays) {
      const double s = m.dot(ray.direction) / ray.direction.norm();
      if (s > slope) {
        slope = s;
        steepest = &ray;
      }
    }
    if (steepest) point += (4.0 * extent / steepest->direction.norm()) * steepest->direction;
    return point;
  }
  [[nodiscard]] Wide to_a(const Vec3& v) const noexcept {
    const Mat3& r = pose_.rotation;
    const Wide w = wide(v);
    return Wide{dot(wide(r.row(0)), w), dot(wide(r.row(1)), w), dot(wide(r.row(2)), w)} +
           wide(pose_.translation);
  }

  const ActiveFeature& a_;
  const ActiveFeature& b_;
  const RelativePose& pose_;
  const Precision& p_;
};

// `a` and `b` keep their features and take the points, as near to the features as these allow. The
// next tracked query begins there. Among points that are equally close within rounding, those of
// the latest direction are chosen.
void improve_upper(ActiveFeature& a, ActiveFeature& b, DistanceResult& r,
                   const WideSimplex& simplex, double length, const Precision& p) noexcept {
  if (length > r.distance + p.gap_tolerance) return;
  a.place(a.feature(), a.index(), simplex.mean([](const DifferenceVertex& c) { return c.a; }));
  b.place(b.feature(), b.index(), simplex.mean([](const DifferenceVertex& c) { return c.b_B; }));
  r.upper = std::min(r.upper, length + p.error_bound);
  r.distance = length;
  r.point_on_a = a.point_A();
  r.point_on_b = simplex.mean([](const DifferenceVertex& c) { return rounded(c.b); });
}

}  // namespace

void refine(ActiveFeature& a, ActiveFeature& b, const RelativePose& a_from_b, const Precision& p,
            DistanceResult& r) noexcept {
  // The point of the simplex bounds the distance from above. The support values along its direction
  // bound it from below: n of each round is the normal at that point (Gilbert, Johnson and Keerthi
  // 1988).
  const WideMinkowskiDifference body(a, b, a_from_b, p);
  WideSimplex simplex;
  // Far out on an unbounded body, a point is off it by more than the bounds allow for.
  const bool near =
      a.point_L().norm() <= 4.0 * p.extent_a && b.point_L().norm() <= 4.0 * p.extent_b;
  (void)simplex.add(near ? body.make(a.point_L(), b.point_L())
                         : body.make(a.body().anchors[0], b.body().anchors[0]));
  for (int round = 0; round < kRounds; ++round) {
    const ClosestPoint<DoubleDouble> closest = simplex.reduce();
    const double length = static_cast<double>(sqrt(closest.length2));
    improve_upper(a, b, r, simplex, length, p);
    if (simplex.holds_origin() || !(length > 0.0)) break;  // the origin is inside
    const Vec3 n = rounded(DoubleDouble(1.0) / sqrt(closest.length2) * closest.point);
    const DifferenceVertex next = body.support_point(n);
    const double separated = separation({n}, a, b, p);
    if (separated - p.error_bound > r.lower - p.gap_tolerance)
      r.normal = unit_along(n);  // squares may underflow
    r.lower = std::max(r.lower, separated - p.error_bound);
    if (length - separated <= p.gap_tolerance || !simplex.add(next)) break;
  }
  assert(r.normal.isZero(0.0) || is_unit_or_unknown(r.normal));
}

}  // namespace clearance
