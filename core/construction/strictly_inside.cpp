#include "core/construction/strictly_inside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/construction/dual_simplex.hpp"

namespace clearance::exact {
namespace {

Integer3 exact_normal(const HalfSpace& row) {
  return head(integer_multiple({row.normal.x(), row.normal.y(), row.normal.z(), 0.0}));
}

// Coordinates in which the normals keep their full rank. A move along the others has no effect or
// is not needed.
std::array<bool, 3> spanning_axes(std::span<const HalfSpace> rows) {
  const NormalSpan span = normal_span(rows);
  std::array<bool, 3> free{};
  if (span.rank == 3) {
    free.fill(true);
    return free;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(span.direction[i]) == 0) continue;
    free.fill(span.rank == 2);
    free[i] = !free[i];
    break;
  }
  return free;
}

// A power of two above the distance of every plane from the origin; 1 when all pass through it.
int unit_exponent(std::span<const HalfSpace> rows) {
  int largest = std::numeric_limits<int>::min();
  for (const HalfSpace& row : rows) {
    if (row.offset == 0.0) continue;
    largest = std::max(largest,
                       std::ilogb(row.offset) - std::ilogb(row.normal.cwiseAbs().maxCoeff()) + 1);
  }
  return largest == std::numeric_limits<int>::min() ? 0 : largest;
}

// Homogeneous, in units; coordinates rounded to `bits` bits of the largest.
Integer4 rounded_solution(const InteriorProgramme& programme, int bits) {
  const auto length = [](const Integer& x) {
    return sgn(x) == 0 ? 0L : static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
  };
  const Integer4& solution = programme.solution();
  const long longest = std::max({length(solution[0]), length(solution[1]), length(solution[2])});
  const long fraction = std::max(bits + length(programme.denominator()) - longest, 0L);
  Integer4 point{0, 0, 0, Integer(1) << static_cast<mp_bitcnt_t>(fraction)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer scaled = solution[i] << static_cast<mp_bitcnt_t>(fraction);
    mpz_fdiv_q(point[i].get_mpz_t(), scaled.get_mpz_t(), programme.denominator().get_mpz_t());
  }
  return point;
}

// Is the homogeneous point at least half as deep as the solution?
bool deep_enough(const InteriorProgramme& programme, const Integer4& point) {
  Integer4 xt;
  for (std::size_t i = 0; i < 3; ++i) xt[i] = 2 * point[i] * programme.denominator();
  xt[3] = programme.solution()[3] * point[3];
  return programme.allows(xt, 2 * point[3] * programme.denominator());
}

Integer4 in_metres(Integer4 point, int unit) {
  for (std::size_t i = 0; i < 3; ++i) point[i] <<= static_cast<mp_bitcnt_t>(std::max(unit, 0));
  point[3] <<= static_cast<mp_bitcnt_t>(std::max(-unit, 0));
  reduce(point);
  return point;
}

}  // namespace

NormalSpan normal_span(std::span<const HalfSpace> rows) {
  NormalSpan span{1, exact_normal(rows[0])};
  const Integer3 first = span.direction;
  for (const HalfSpace& row : rows) {
    const Integer3 normal = exact_normal(row);
    if (span.rank == 1) {
      const Integer3 line = cross(first, normal);
      if (!is_zero(line)) span = {2, line};
    } else if (sgn(dot(span.direction, normal)) != 0) {
      return {3, {}};
    }
  }
  reduce(span.direction);
  return span;
}

std::variant<Integer4, NoInterior> interior_point(std::span<const HalfSpace> rows) {
  const int unit = unit_exponent(rows);
  InteriorProgramme programme(rows, spanning_axes(rows), unit);
  // A deep point of a body of ordinary proportions is near its planes. A point between planes that
  // are almost parallel may be far away, and an infeasibility proof may not use the box. These
  // cases need a larger box.
  for (const Integer& box : {Integer(4), Integer(Integer(1) << 40), programme.ample_box()}) {
    programme.solve(box);
    if (programme.has_interior()) break;
    if (const std::optional<NoInterior> proof = programme.proof()) return *proof;
  }
  // Short coordinates keep the numbers of all later computations short.
  for (const int bits : {24, 53, 106, 212}) {
    const Integer4 point = rounded_solution(programme, bits);
    if (deep_enough(programme, point)) return in_metres(point, unit);
  }
  Integer4 point = programme.solution();
  point[3] = programme.denominator();
  return in_metres(point, unit);
}

}  // namespace clearance::exact
