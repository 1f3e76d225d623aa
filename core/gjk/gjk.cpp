#include "core/gjk/gjk.hpp"

#include <algorithm>
#include <cmath>

#include "core/active_set/certificate.hpp"
#include "core/gjk/closest_on_simplex.hpp"
#include "core/model/support_function.hpp"
#include "core/vec.hpp"

namespace clearance {
namespace {

// Bounds that are wider than promised then say so by the status kIterationLimit.
constexpr int kRounds = 64;

// A point of the Minkowski difference B - A, and where it comes from.
struct DifferenceVertex {
  Vec3 a;      // in frame A
  Vec3 own_b;  // in frame B
  WideVec b;   // the same in frame A
  WideVec difference;
};

// B - A by its support points, placed in twice the precision: simplices are slender where bodies
// nearly touch, and differences of their vertices would be left with few digits.
class WideMinkowskiDifference {
 public:
  WideMinkowskiDifference(const ActiveFeature& a, const ActiveFeature& b,
                          const RelativePose& a_from_b, const Precision& p) noexcept
      : a_(a), b_(b), pose_(a_from_b), p_(p) {}

  // The support point along -n, n in the common frame.
  [[nodiscard]] DifferenceVertex support_point(const Vec3& n) const noexcept {
    return make(cut_off_support(a_.body(), n, p_.extent_a),
                cut_off_support(b_.body(), -b_.direction_to_local(n), p_.extent_b));
  }
  [[nodiscard]] DifferenceVertex make(const Vec3& a, const Vec3& b_own) const noexcept {
    DifferenceVertex c{a, b_own, to_a(b_own), {}};
    c.difference = c.b - wide(c.a);
    return c;
  }

 private:
  // Unbounded bodies are cut off far beyond the closest points.
  static Vec3 cut_off_support(const ConvexBody& body, const Vec3& m, double reach) noexcept {
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
    if (steepest) point += (4.0 * reach / steepest->direction.norm()) * steepest->direction;
    return point;
  }
  [[nodiscard]] WideVec to_a(const Vec3& v) const noexcept {
    const Mat3& r = pose_.rotation;
    const WideVec w = wide(v);
    return WideVec{dot(wide(r.row(0)), w), dot(wide(r.row(1)), w), dot(wide(r.row(2)), w)} +
           wide(pose_.translation);
  }

  const ActiveFeature& a_;
  const ActiveFeature& b_;
  const RelativePose& pose_;
  const Precision& p_;
};

// The vertices whose hull has the point closest to the origin, four at most.
class Simplex {
 public:
  // False when it is there already: no progress is possible.
  bool add(const DifferenceVertex& c) noexcept {
    for (std::size_t i = 0; i < size_; ++i) {
      if (vertices_[i].a == c.a && narrow(vertices_[i].b) == narrow(c.b)) return false;
    }
    vertices_[size_++] = c;
    return true;
  }
  // Keeps only what the closest point needs, and returns it.
  ClosestPoint reduce() noexcept {
    std::array<WideVec, 4> points;
    for (std::size_t i = 0; i < size_; ++i) points[i] = vertices_[i].difference;
    ClosestPoint closest = closest_to_origin(points, size_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (closest.weights[i].high <= 0.0) continue;
      vertices_[kept] = vertices_[i];
      weights_[kept++] = static_cast<double>(closest.weights[i]);
    }
    size_ = kept;
    return closest;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] Vec3 point_on_a() const noexcept { return weighted(&DifferenceVertex::a); }
  // In frame B.
  [[nodiscard]] Vec3 own_point_on_b() const noexcept { return weighted(&DifferenceVertex::own_b); }
  [[nodiscard]] Vec3 point_on_b() const noexcept {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < size_; ++i) p += weights_[i] * narrow(vertices_[i].b);
    return p;
  }

 private:
  [[nodiscard]] Vec3 weighted(Vec3 DifferenceVertex::*part) const noexcept {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < size_; ++i) p += weights_[i] * (vertices_[i].*part);
    return p;
  }

  std::array<DifferenceVertex, 4> vertices_;
  std::array<double, 4> weights_{};
  std::size_t size_ = 0;
};

// The sides keep their features and take the points: as near to them as the features allow, a
// tracked query begins there. Of points that are as close to rounding, those are taken that belong
// to the direction found last, and that one of those that prove as much.
void improve_upper(ActiveFeature& a, ActiveFeature& b, DistanceResult& r, const Simplex& simplex,
                   double length, const Precision& p) noexcept {
  if (length > r.distance + p.gap_tolerance) return;
  a.place(a.feature(), a.index(), simplex.point_on_a());
  b.place(b.feature(), b.index(), simplex.own_point_on_b());
  r.upper = std::min(r.upper, length + p.error_bound);
  r.distance = length;
  r.point_on_a = a.point_in_a();
  r.point_on_b = simplex.point_on_b();
}

}  // namespace

void refine(ActiveFeature& a, ActiveFeature& b, const RelativePose& a_from_b, const Precision& p,
            DistanceResult& r) noexcept {
  // The point of the simplex bounds the distance from above, its direction's support values from
  // below: each round's n is the normal at that point (Gilbert, Johnson and Keerthi 1988).
  const WideMinkowskiDifference body(a, b, a_from_b, p);
  Simplex simplex;
  // Far out on an unbounded body, a point is off it by more than the bounds allow for.
  const bool near =
      a.local_point().norm() <= 4.0 * p.extent_a && b.local_point().norm() <= 4.0 * p.extent_b;
  simplex.add(near ? body.make(a.local_point(), b.local_point())
                   : body.make(a.body().anchors[0], b.body().anchors[0]));
  for (int round = 0; round < kRounds; ++round) {
    const ClosestPoint closest = simplex.reduce();
    const double length = static_cast<double>(sqrt(closest.length2));
    improve_upper(a, b, r, simplex, length, p);
    if (simplex.size() == 4 || !(length > 0.0)) break;  // the origin is inside
    const Vec3 n = narrow(DoubleDouble(1.0) / sqrt(closest.length2) * closest.point);
    const DifferenceVertex next = body.support_point(n);
    const double separated = separation({n}, a, b, p);
    if (separated - p.error_bound > r.lower - p.gap_tolerance)
      r.normal = unit_along(n);  // squares may underflow
    r.lower = std::max(r.lower, separated - p.error_bound);
    if (length - separated <= p.gap_tolerance || !simplex.add(next)) break;
  }
  const bool converged = p.converged(r.upper - r.lower);
  if (r.lower > 0.0) {
    r.status = converged ? DistanceStatus::kConverged : DistanceStatus::kIterationLimit;
  } else {
    r.status = r.upper <= 2.0 * (p.error_bound + p.gap_tolerance) ? DistanceStatus::kTouching
                                                                  : DistanceStatus::kIterationLimit;
  }
}

}  // namespace clearance
