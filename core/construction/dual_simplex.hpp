// The deepest point inside a set of half-spaces, by a linear programme that is solved exactly.
//
// The programme is max t subject to n.x + m t <= d for every row, in four variables. Here m > 0 is
// the power of two next below the largest component of |n|. The method is the dual simplex method
// from a vertex of a box. Pivots are in integers. Pricing is in doubles, with an exact check
// wherever rounding could matter. At the end every row holds exactly.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/construction/integer_vector.hpp"
#include "core/construction/strictly_inside.hpp"
#include "core/shapes.hpp"

namespace clearance::exact {

// One constraint a.(x, t) <= b, and its doubles: a and b up to a positive factor, exactly. NaN: use
// the integers.
struct InteriorConstraint {
  Integer4 a;
  Integer b;
  std::array<double, 5> rounded;
  bool fixed = false;  // never leaves the basis: an equation
};

// Four constraints that hold with equality, and their inverse: `adjugate` / `determinant`.
struct InteriorBasis {
  std::array<int, 4> member{};
  std::array<Integer4, 4> adjugate;
  Integer determinant;  // > 0

  void invert(const std::vector<InteriorConstraint>& constraints);
  // The coefficients of `a` as a combination of the members, times `determinant`.
  [[nodiscard]] Integer4 combination(const Integer4& a) const;
  // The point in which the members meet, times `determinant`.
  [[nodiscard]] Integer4 solution(const std::vector<InteriorConstraint>& constraints) const;
};

class InteriorProgramme {
 public:
  // Lengths are in units of 2^unit_exponent m, in which no plane is farther than 1 from the origin.
  // The coordinates that are not `free` stay 0: the free ones must give the normals their full
  // rank.
  InteriorProgramme(std::span<const HalfSpace> rows, const std::array<bool, 3>& free,
                    int unit_exponent);

  // Keeps |x| <= box (units) and t <= 1.
  void solve(const Integer& box);

  // A box that holds a deepest point whatever the rows are.
  [[nodiscard]] Integer ample_box() const;

  [[nodiscard]] bool has_interior() const { return sgn(solution_[3]) > 0; }
  // Does (x, t) = xt / denominator satisfy every row?
  [[nodiscard]] bool allows(const Integer4& xt, const Integer& denominator) const;
  // (x, t) times denominator(), in units.
  [[nodiscard]] const Integer4& solution() const { return solution_; }
  [[nodiscard]] const Integer& denominator() const { return basis_.determinant; }

  // Why there is no interior; nothing when the box takes part in the proof.
  [[nodiscard]] std::optional<NoInterior> proof() const;

 private:
  int violated(bool first) const;
  void pivot(int entering);

  int rows_;
  std::array<bool, 3> free_;
  std::vector<InteriorConstraint> constraints_;  // the rows, then the box and the cap of solve()
  InteriorBasis basis_;
  Integer4 solution_;
};

}  // namespace clearance::exact
