#include "core/overlap.hpp"

#include <array>

#include "core/simplex.hpp"

namespace clearance {
namespace {

constexpr int kSteps = 32;
constexpr int kHullSteps = 24;

// The largest n.x - d over the facets of both bodies, as a function of x.
class Violation {
 public:
  Violation(const ActiveSide& a, const ActiveSide& b) noexcept : sides_{&a, &b} {}

  // Calls visit(value at x, normal) for every facet, all in the common frame.
  template <class Visit>
  void each(const Vec3& x, Visit&& visit) const noexcept {
    for (const ActiveSide* side : sides_) {
      const Vec3 origin = side->point_to_common(Vec3::Zero());
      const Vec3 own = side->direction_to_own(x - origin);
      for (const Facet& f : side->body().facets) {
        visit(f.normal.dot(own) - f.offset, *side, f);
      }
    }
  }

  [[nodiscard]] double at(const Vec3& x) const noexcept {
    double worst = -kInfinity;
    each(x, [&](double v, const ActiveSide&, const Facet&) { worst = std::max(worst, v); });
    return worst;
  }

 private:
  std::array<const ActiveSide*, 2> sides_;
};

// The normals of the facets that are (nearly) the worst, and the shortest vector of their hull
// (Gilbert).
class WorstNormals {
 public:
  void add(const Vec3& n) noexcept {
    if (size_ < items_.size()) items_[size_++] = n;
  }
  [[nodiscard]] Vec3 shortest() const noexcept {
    std::array<WideVec, 4> simplex{wide(items_[0])};
    std::size_t size = 1;
    Vec3 p = items_[0];
    for (int k = 0; k < kHullSteps; ++k) {
      std::size_t lowest = 0;
      for (std::size_t i = 1; i < size_; ++i) {
        if (items_[i].dot(p) < items_[lowest].dot(p)) lowest = i;
      }
      if (p.squaredNorm() - items_[lowest].dot(p) < 1e-9 * p.squaredNorm() || size == 4) break;
      simplex[size++] = wide(items_[lowest]);
      const ClosestPoint closest = closest_to_origin(simplex, size);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < size; ++i) {
        if (closest.weights[i].high > 0.0) simplex[kept++] = simplex[i];
      }
      size = kept;
      p = narrow(closest.point);
    }
    return p;
  }

 private:
  std::array<Vec3, 24> items_;
  std::size_t size_ = 0;
};

// How far along `direction` (unit) the largest violation falls: follows its piecewise linear
// course.
double descent(const Violation& violation, const Vec3& x, const Vec3& direction,
               double farthest) noexcept {
  double s = 0.0, height = violation.at(x), slope = -kInfinity;
  violation.each(x, [&](double v, const ActiveSide& side, const Facet& f) {
    if (v == height) slope = std::max(slope, side.direction_to_common(f.normal).dot(direction));
  });
  while (slope < 0.0 && s < farthest) {
    double next = farthest, next_slope = 0.0;
    violation.each(x, [&](double v, const ActiveSide& side, const Facet& f) {
      const double g = side.direction_to_common(f.normal).dot(direction);
      if (!(g > slope)) return;
      const double crossing = (height - v) / (g - slope);
      if (crossing > s && crossing < next) {
        next = crossing;
        next_slope = g;
      }
    });
    // Lines through (0, value): continue on the one that takes over.
    height += next_slope == 0.0 ? 0.0 : (slope - next_slope) * next;
    s = next;
    slope = next_slope;
  }
  return s;
}

// A point or a segment against a solid: what is left of it after each facet has cut its part off.
bool share_a_point_of(const ActiveSide& flat, const ActiveSide& solid, const Precision& p,
                      Vec3& shared) noexcept {
  const bool is_point = flat.body().edges.empty();
  const Vec3 start = is_point ? flat.body().vertices[0].position : flat.body().edges[0].point;
  const Vec3 along = is_point ? Vec3(Vec3::Zero()) : flat.body().edges[0].direction;
  const Vec3 origin = solid.point_to_common(Vec3::Zero());
  const Vec3 from = solid.direction_to_own(flat.point_to_common(start) - origin);
  const Vec3 way = solid.direction_to_own(flat.direction_to_common(along));
  double first = 0.0, last = is_point ? 0.0 : flat.body().edges[0].end;
  for (const Facet& f : solid.body().facets) {
    const double room = f.offset - f.normal.dot(from) - 2.0 * p.slack, speed = f.normal.dot(way);
    if (speed > 0.0) {
      last = std::min(last, room / speed);
    } else if (speed < 0.0) {
      first = std::max(first, room / speed);
    } else if (!(room > 0.0)) {
      return false;
    }
  }
  if (!(first <= last)) return false;
  shared = flat.point_to_common(start + 0.5 * (first + last) * along);
  return true;
}

}  // namespace

bool share_a_point(const ActiveSide& a, const ActiveSide& b, const Precision& p,
                   Vec3& shared) noexcept {
  if (a.body().facets.empty() && b.body().facets.empty()) return false;
  if (a.body().facets.empty()) return share_a_point_of(a, b, p, shared);
  if (b.body().facets.empty()) return share_a_point_of(b, a, p, shared);
  const Violation violation(a, b);
  Vec3 x = 0.5 * (a.common() + b.common());
  double band = 4.0 * p.slack;
  for (int k = 0; k < kSteps; ++k) {
    const double worst = violation.at(x);
    if (worst < -2.0 * p.slack) {
      shared = x;
      return true;
    }
    WorstNormals normals;
    violation.each(x, [&](double v, const ActiveSide& side, const Facet& f) {
      if (v >= worst - band) normals.add(side.direction_to_common(f.normal));
    });
    const Vec3 up = normals.shortest();
    const double length = up.norm();
    if (!(length > 1e-12)) return false;
    const Vec3 direction = -up / length;
    const double s = descent(violation, x, direction, p.size);
    const Vec3 next = x + s * direction;
    if (!(violation.at(next) < worst)) {
      band *= 16.0;
      if (band > 1e-3 * p.size) return false;
      continue;
    }
    x = next;
  }
  return false;
}

}  // namespace clearance
