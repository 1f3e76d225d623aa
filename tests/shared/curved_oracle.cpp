#include "tests/shared/curved_oracle.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace clearance::oracle {
namespace {

using boost::multiprecision::sqrt;
using RealMatrix = std::array<RealVec, 3>;  // stored by rows

// The iteration limit of the ellipsoid method. About forty iterations gain one digit of the bounds.
constexpr int kMostRounds = 20000;
// The limit of a cut's depth, as a fraction of the distance from the centre to the surface. A
// deeper cut would leave a disc-like ellipsoid, and after a few of them fewer digits than doubles
// have.
constexpr double kDeepestCut = 0.5;

Real dot(const RealVec& a, const RealVec& b) {
  return Real(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}
RealVec times(const RealMatrix& m, const RealVec& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
RealVec exact_of(const Vec3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }
Real length(const RealVec& v) { return Real(sqrt(dot(v, v))); }

RealMatrix rotation_of(const Eigen::Quaterniond& q) {
  const Real w(q.w()), x(q.x()), y(q.y()), z(q.z());
  const Real s = 2 / Real(w * w + x * x + y * y + z * z);
  return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

// A body without its radius, placed in the world, with all numbers in Real.
class RealBody {
 public:
  explicit RealBody(const PlacedCurvedBody& placed)
      : shape_(placed.body->shape),
        rotation_(rotation_of(placed.world_from_body.orientation)),
        origin_(exact_of(placed.world_from_body.position)) {
    for (const Vec3& p : placed.body->points) points_.push_back(exact_of(p));
  }

  // The support point along n; one of them if there are several.
  [[nodiscard]] RealVec support(const RealVec& n) const {
    RealVec m;
    for (std::size_t i = 0; i < 3; ++i) {
      m[i] = rotation_[0][i] * n[0] + rotation_[1][i] * n[1] + rotation_[2][i] * n[2];
    }
    RealVec p = times(rotation_, own_support(m));
    for (std::size_t i = 0; i < 3; ++i) p[i] += origin_[i];
    return p;
  }

 private:
  [[nodiscard]] RealVec own_support(const RealVec& m) const {
    if (!points_.empty()) {
      const RealVec* best = &points_[0];
      for (const RealVec& p : points_) {
        if (dot(p, m) > dot(*best, m)) best = &p;
      }
      return *best;
    }
    if (shape_.kind == CurvedShape::Kind::kEllipsoid) return of_ellipsoid(m);
    const RealVec low = of_disc(shape_.discs[0], m), high = of_disc(shape_.discs[1], m);
    return dot(low, m) > dot(high, m) ? low : high;
  }

  [[nodiscard]] RealVec of_ellipsoid(const RealVec& m) const {
    const RealVec axes = exact_of(shape_.semi_axes);
    RealVec p{axes[0] * m[0], axes[1] * m[1], axes[2] * m[2]};
    const Real norm = length(p);
    if (norm == 0) return {axes[0], Real(0), Real(0)};
    for (std::size_t i = 0; i < 3; ++i) p[i] *= axes[i] / norm;
    return p;
  }

  static RealVec of_disc(const Disc& disc, const RealVec& m) {
    const Real across = sqrt(Real(m[0] * m[0] + m[1] * m[1])), radius(disc.radius);
    if (across == 0) return {Real(0), Real(0), Real(disc.height)};
    return {radius * m[0] / across, radius * m[1] / across, Real(disc.height)};
  }

  CurvedShape shape_;
  RealMatrix rotation_;
  RealVec origin_;
  std::vector<RealVec> points_;
};

// The vector from A's support point along n to B's support point along -n.
RealVec apart_at(const RealBody& a, const RealBody& b, const RealVec& n) {
  const RealVec on_a = a.support(n), on_b = b.support({-n[0], -n[1], -n[2]});
  return {on_b[0] - on_a[0], on_b[1] - on_a[1], on_b[2] - on_a[2]};
}

// The set of all centre + root u with |u| <= 1. Storing the root of the matrix instead of the
// matrix halves the number of digits between the longest and the shortest axis.
struct DirectionEllipsoid {
  RealVec centre{Real(0), Real(0), Real(0)};
  RealMatrix root{
      {{Real(1), Real(0), Real(0)}, {Real(0), Real(1), Real(0)}, {Real(0), Real(0), Real(1)}}};

  // Returns root^T a. Over the ellipsoid, a.n differs from a.centre by at most the length of this
  // vector.
  [[nodiscard]] RealVec seen(const RealVec& a) const {
    RealVec out;
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = root[0][i] * a[0] + root[1][i] * a[1] + root[2][i] * a[2];
    }
    return out;
  }

  // Replaces the ellipsoid by the smallest one that contains its part with a.(n - centre) <= -depth
  // |seen(a)|, 0 <= depth < 1.
  void cut(const RealVec& a, const Real& depth) {
    RealVec u = seen(a);
    const Real norm = length(u);
    for (Real& x : u) x /= norm;
    const RealVec along = times(root, u);
    const Real step = (1 + 3 * depth) / 4, stretch = sqrt(Real(Real(9) / 8 * (1 - depth * depth))),
               off = 1 - sqrt(Real((1 - depth) / (2 * (1 + depth))));
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] -= step * along[i];
      for (std::size_t j = 0; j < 3; ++j) {
        root[i][j] = stretch * (root[i][j] - off * along[i] * u[j]);
      }
    }
  }
};

// Bounds the distance without radii. It is never negative, so 0 is a valid lower bound.
RealBounds maximise(const RealBody& a, const RealBody& b, const Real& tolerance) {
  DirectionEllipsoid around;
  RealBounds found{Real(0), Real(std::numeric_limits<double>::max())};
  for (int round = 0; round < kMostRounds && found.upper - found.lower > tolerance; ++round) {
    const RealVec c = around.centre;
    const Real norm = length(c);
    if (norm > 1) {
      const Real depth = norm * (norm - 1) / length(around.seen(c));
      around.cut(c, std::min<Real>(kDeepestCut, depth));
      continue;
    }
    const RealVec apart = apart_at(a, b, c);
    const Real value = dot(c, apart);
    const Real wide = length(around.seen(apart));
    if (value > 0) found.lower = std::max<Real>(found.lower, value / norm);
    found.upper = std::min<Real>(found.upper, value + wide);
    if (wide == 0 || found.lower - value >= wide) break;
    const Real depth = std::min<Real>(kDeepestCut, (found.lower - value) / wide);
    around.cut({-apart[0], -apart[1], -apart[2]}, depth);
  }
  return found;
}

}  // namespace

RealBounds curved_truth(const PlacedCurvedBody& a, const PlacedCurvedBody& b, double tolerance) {
  RealBounds found = maximise(RealBody(a), RealBody(b), Real(tolerance));
  const Real radii = Real(a.body->radius) + Real(b.body->radius);
  if (found.upper - found.lower > tolerance) {
    throw std::logic_error("the oracle has not come to an end");
  }
  found.upper -= radii;
  found.lower =
      found.lower > 0 ? Real(found.lower - radii) : Real(std::numeric_limits<double>::lowest());
  return found;
}

Real apart_along(const PlacedCurvedBody& a, const PlacedCurvedBody& b, const Vec3& n) {
  const RealVec along = exact_of(n);
  return dot(along, apart_at(RealBody(a), RealBody(b), along)) / length(along) -
         Real(a.body->radius) - Real(b.body->radius);
}

}  // namespace clearance::oracle
