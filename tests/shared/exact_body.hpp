// A convex body in exact rational arithmetic: which points it contains, and its support value in a
// direction.
//
// It is slow and simple, and shares nothing with core/ but the plain structs of the input. It is
// therefore unlikely that both have one mistake. Linear programs are solved by the simplex
// method with Bland's rule (R. G. Bland, "New finite pivoting rules for the simplex method", 1977),
// which cannot cycle. The arithmetic is GMP's, which does not round.
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

// A body as its user gives it: the intersection of `rows` if there are any, otherwise the hull of
// `points`. One point is a point, two are a segment. A ball of `radius` is added to either.
struct Body {
  std::vector<HalfSpace> rows;
  std::vector<Vec3> points;
  double radius = 0.0;
};

// The maximiser of a linear function over a body: a point, or a ray along which the function is
// unbounded.
struct Support {
  RationalVec vector;
  bool is_ray = false;
};

// The body without its radius, prepared for exact queries in its own frame. The constructor throws
// std::invalid_argument if the body is empty.
class ExactBody {
 public:
  explicit ExactBody(const Body& body);

  // Returns a vertex at which `direction` is largest, or an extreme ray along which it is
  // unbounded. If the body has no vertices, the result is a point of a minimal face. The search
  // starts at the last call's result.
  [[nodiscard]] Support support(const IntegerVec& direction);

  // Returns true if `x` satisfies every row. Only for bodies that are given by rows.
  [[nodiscard]] bool rows_hold_at(const RationalVec& x) const;

  // Proves direction.x <= value for all points of the body. The proof checks each point, or uses
  // non-negative multipliers of the rows at the last support (weak duality). False means "no
  // proof", and is never expected after support(direction).
  [[nodiscard]] bool proves_bound(const RationalVec& direction, const Rational& value) const;

  [[nodiscard]] bool given_by_rows() const { return !rows_.empty(); }
  [[nodiscard]] long pivots() const { return pivots_; }

 private:
  // The half-space n.x <= d with integers. Phase one has a fourth variable.
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

  std::vector<Row> rows_;  // the given rows first, then those that pin the lines
  std::size_t given_rows_ = 0;
  std::vector<IntegerVec> lines_;  // the body contains x + s * line for each of its points x
  std::vector<int> basis_;         // three independent rows that meet in a vertex
  std::vector<IntegerVec> points_;
  Integer points_scale_ = 1;  // the points are points_ / points_scale_
  long pivots_ = 0;
};

}  // namespace clearance::oracle
