#include "core/construction/dual_simplex.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace clearance::exact {
namespace {

constexpr int kNoConstraint = -1;

InteriorConstraint from_row(const HalfSpace& row, int unit_exponent) {
  const Vec3& n = row.normal;
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const double depth = std::ldexp(1.0, std::ilogb(n[axis]));
  InteriorConstraint result;
  result.a = integer_multiple({n.x(), n.y(), n.z(), depth});
  // Multiplies the offset by the factor that has made `depth` an integer. That factor is a power of
  // two or the inverse of one.
  const mpq_class offset = mpq_class(row.offset) * result.a[3] / mpq_class(depth);
  result.b = offset.get_num();
  for (Integer& entry : result.a) entry *= offset.get_den();
  if (unit_exponent > 0) {
    for (Integer& entry : result.a) entry <<= static_cast<mp_bitcnt_t>(unit_exponent);
  } else {
    result.b <<= static_cast<mp_bitcnt_t>(-unit_exponent);
  }
  result.rounded = {n.x(), n.y(), n.z(), depth, std::ldexp(row.offset, -unit_exponent)};
  return result;
}

InteriorConstraint bound(std::size_t variable, int sign, const Integer& limit) {
  InteriorConstraint result;
  result.a[variable] = sign;
  result.b = limit;
  result.rounded.fill(std::numeric_limits<double>::quiet_NaN());
  return result;
}

// The determinant of the 3 x 3 matrix without that row and column.
Integer minor(const std::array<const Integer4*, 4>& m, std::size_t row, std::size_t column) {
  std::array<std::size_t, 3> r{}, c{};
  for (std::size_t i = 0, k = 0, l = 0; i < 4; ++i) {
    if (i != row) r[k++] = i;
    if (i != column) c[l++] = i;
  }
  const auto entry = [&](std::size_t i, std::size_t j) -> const Integer& {
    return (*m[r[i]])[c[j]];
  };
  const auto two = [&](std::size_t i, std::size_t j) {
    return Integer(entry(1, i) * entry(2, j) - entry(1, j) * entry(2, i));
  };
  return entry(0, 0) * two(1, 2) - entry(0, 1) * two(0, 2) + entry(0, 2) * two(0, 1);
}

}  // namespace

// By cofactors: A^-1 = adjugate / determinant. The determinant is positive, so products with the
// adjugate have the signs of those with the inverse. It is 1 at the start, and pivot() makes it a
// positive share.
void InteriorBasis::invert(const std::vector<InteriorConstraint>& constraints) {
  std::array<const Integer4*, 4> m{};
  for (std::size_t i = 0; i < 4; ++i) m[i] = &constraints[at(member[i])].a;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      adjugate[j][i] = minor(m, i, j);
      if ((i + j) % 2 == 1) mpz_neg(adjugate[j][i].get_mpz_t(), adjugate[j][i].get_mpz_t());
    }
  }
  determinant = 0;
  for (std::size_t j = 0; j < 4; ++j) determinant += (*m[0])[j] * adjugate[j][0];
  assert(sgn(determinant) > 0);
}

Integer4 InteriorBasis::combination(const Integer4& a) const {
  Integer4 result;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) result[i] += a[j] * adjugate[j][i];
  }
  return result;
}

Integer4 InteriorBasis::solution(const std::vector<InteriorConstraint>& constraints) const {
  Integer4 result;
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i) result[j] += adjugate[j][i] * constraints[at(member[i])].b;
  }
  return result;
}

InteriorProgramme::InteriorProgramme(std::span<const HalfSpace> rows,
                                     const std::array<bool, 3>& free, int unit_exponent)
    : rows_(static_cast<int>(rows.size())), free_(free) {
  constraints_.reserve(rows.size() + 7);
  for (const HalfSpace& row : rows) constraints_.push_back(from_row(row, unit_exponent));
}

Integer InteriorProgramme::ample_box() const {
  // A vertex is a quotient of determinants of integers: at most 24 products of four over at
  // least 1.
  std::size_t bits = 1;
  for (const InteriorConstraint& constraint : constraints_) {
    bits = std::max(bits, mpz_sizeinbase(constraint.b.get_mpz_t(), 2));
    for (const Integer& entry : constraint.a) {
      bits = std::max(bits, mpz_sizeinbase(entry.get_mpz_t(), 2));
    }
  }
  return Integer(1) << (4 * bits + 5);
}

void InteriorProgramme::solve(const Integer& box) {
  constraints_.resize(at(rows_));
  // The start is a vertex of the box at t = 1, with all of the objective on the last bound. This
  // start is dual feasible, whatever the rows are.
  for (std::size_t i = 0; i < 3; ++i) {
    basis_.member[i] = static_cast<int>(constraints_.size());
    constraints_.push_back(bound(i, 1, free_[i] ? box : Integer(0)));
    constraints_.back().fixed = !free_[i];
    if (free_[i]) constraints_.push_back(bound(i, -1, box));
  }
  basis_.member[3] = static_cast<int>(constraints_.size());
  constraints_.push_back(bound(3, 1, 1));
  // The largest violation is taken first. If that takes suspiciously long, Bland's rule is used,
  // which cannot cycle.
  constexpr int kPatience = 200;
  for (int iteration = 0;; ++iteration) {
    basis_.invert(constraints_);
    solution_ = basis_.solution(constraints_);
    const int entering = violated(iteration > kPatience);
    if (entering == kNoConstraint) return;
    pivot(entering);
  }
}

bool InteriorProgramme::allows(const Integer4& xt, const Integer& denominator) const {
  return std::all_of(
      constraints_.begin(), constraints_.begin() + rows_,
      [&](const InteriorConstraint& row) { return dot(row.a, xt) <= row.b * denominator; });
}

std::optional<NoInterior> InteriorProgramme::proof() const {
  // The multipliers with which the members add up to t <= (t of the solution), by Farkas' lemma.
  const Integer4 multiplier = basis_.combination({0, 0, 0, 1});
  NoInterior result{{}, sgn(solution_[3]) == 0};
  for (std::size_t i = 0; i < 4; ++i) {
    const int member = basis_.member[i];
    if (sgn(multiplier[i]) == 0) continue;
    if (member >= rows_) return std::nullopt;
    result.rows.push_back(member);
  }
  std::sort(result.rows.begin(), result.rows.end());
  return result;
}

// A constraint that the present solution violates (the most violated one, or the first), or
// kNoConstraint when all hold exactly.
int InteriorProgramme::violated(bool first) const {
  std::array<double, 4> x{};
  for (std::size_t i = 0; i < 4; ++i) {
    mpq_class quotient(solution_[i], basis_.determinant);
    quotient.canonicalize();
    x[i] = quotient.get_d();
  }
  // Rounding of x, products and sums: at most 8 * 2^-53 of the sum of absolute values; 16 to be
  // safe.
  constexpr double kPricingError = 0x1p-49;
  int worst = kNoConstraint;
  double largest = 0.0;
  std::vector<int> unsure;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const std::array<double, 5>& a = constraints_[c].rounded;
    double value = -a[4];
    double spread = std::abs(a[4]);
    for (std::size_t i = 0; i < 4; ++i) {
      value += a[i] * x[i];
      spread += std::abs(a[i] * x[i]);
    }
    const double error = kPricingError * spread + std::numeric_limits<double>::min();
    if (value < -error) continue;
    if (!(value > error)) {
      unsure.push_back(static_cast<int>(c));
    } else if (value / a[3] > largest) {
      largest = value / a[3];
      worst = static_cast<int>(c);
      if (first) break;
    }
  }
  if (worst != kNoConstraint && !first) return worst;
  for (const int c : unsure) {
    if (worst != kNoConstraint && c > worst) break;
    const InteriorConstraint& constraint = constraints_[at(c)];
    if (dot(constraint.a, solution_) > constraint.b * basis_.determinant) return c;
  }
  return worst;
}

// Ratio test: among the members in the entering row's combination, the one whose multiplier is used
// up first leaves. There is always one, because a small enough t satisfies every row.
void InteriorProgramme::pivot(int entering) {
  const Integer4 multiplier = basis_.combination({0, 0, 0, 1});
  const Integer4 share = basis_.combination(constraints_[at(entering)].a);
  int leaving = kNoConstraint;
  for (int i = 0; i < 4; ++i) {
    if (sgn(share[at(i)]) <= 0 || constraints_[at(basis_.member[at(i)])].fixed) continue;
    if (leaving == kNoConstraint) {
      leaving = i;
      continue;
    }
    const int order =
        cmp(multiplier[at(i)] * share[at(leaving)], multiplier[at(leaving)] * share[at(i)]);
    if (order < 0 || (order == 0 && basis_.member[at(i)] < basis_.member[at(leaving)])) {
      leaving = i;
    }
  }
  basis_.member[at(leaving)] = entering;
}

}  // namespace clearance::exact
