// A convex body in exact rational arithmetic: what lies in it, and how far it reaches in a
// direction.
//
// Slow, simple and sharing nothing with core/ but the plain structs that describe the input, so
// that both being wrong in the same way is unlikely. Linear programs are solved by the simplex
// method with Bland's rule (R. G. Bland, "New finite pivoting rules for the simplex method", 1977),
// which cannot cycle; arithmetic is GMP's, which cannot round.
#pragma once

#include <gmpxx.h>

#include <array>
#include <vector>

#include "core/shapes.hpp"

namespace clearance::oracle {

using Rational = mpq_class;
using Integer = mpz_class;
using RationalVec = std::array<Rational, 3>;
using IntegerVec = std::array<Integer, 3>;

[[nodiscard]] Rational dot(const RationalVec& a, const RationalVec& b);
[[nodiscard]] RationalVec exact(const Vec3& v);
// The shortest integer vector in the direction of v (zero for zero).
[[nodiscard]] IntegerVec primitive(const RationalVec& v);

// A body as its user gives it: the intersection of `rows` when there are any, else the hull of
// `points` (one is a point, two are a segment); and a ball of `radius` added to either.
struct Body {
  std::vector<HalfSpace> rows;
  std::vector<Vec3> points;
  double radius = 0.0;
};

// Where a linear function is largest over a body: at a point of it, or without end along a ray.
struct Support {
  RationalVec vector;
  bool is_ray = false;
};

// The body without its radius, made ready for exact questions in its own frame. Throws
// std::invalid_argument when it is empty.
class ExactBody {
 public:
  explicit ExactBody(const Body& body);

  // A vertex where `direction` is largest (for a body without vertices: a point of a minimal face),
  // or an extreme ray along which it grows for ever. Starts where the last call ended.
  [[nodiscard]] Support support(const IntegerVec& direction);

  // True when `x` satisfies every row. Only for bodies that were given by rows.
  [[nodiscard]] bool rows_hold_at(const RationalVec& x) const;

  // Proves direction.x <= value all over the body: by looking at each point, or by non-negative
  // multipliers of the rows at the last support (weak duality). False means "no proof", and is
  // never expected after support(direction).
  [[nodiscard]] bool proves_bound(const RationalVec& direction, const Rational& value) const;

  [[nodiscard]] bool given_by_rows() const { return !rows_.empty(); }
  [[nodiscard]] long pivots() const { return pivots_; }

 private:
  // n.x <= d with integers; in phase one there is a fourth variable.
  struct Row {
    std::vector<Integer> normal;
    Integer offset;
  };
  // A point in homogeneous integers: x / w, w > 0.
  struct Point {
    std::vector<Integer> x;
    Integer w;
  };
  struct Program;

  void pin_lines();
  [[nodiscard]] std::vector<Rational> feasible_point() const;
  [[nodiscard]] Support support_of_points(const IntegerVec& direction) const;

  std::vector<Row> rows_;  // the given ones first, then those that pin the lines
  std::size_t given_rows_ = 0;
  std::vector<IntegerVec> lines_;  // the body contains x + s * line for each of its points x
  std::vector<int> basis_;         // three independent rows that meet in a vertex
  std::vector<IntegerVec> points_;
  Integer points_scale_ = 1;  // the points are points_ / points_scale_
  long pivots_ = 0;
};

}  // namespace clearance::oracle
