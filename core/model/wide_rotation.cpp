#include "core/model/wide_rotation.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Of a quaternion that has been scaled.
struct Scaled {
  double value;
  bool zero;   // as given: scaling may have made nothing of what is subnormal
  bool whole;  // zero, or so large that doubles have all digits of its products
};
using Components = std::array<Scaled, 4>;  // x, y, z, w

// A sum or product of wide numbers is off by at most 2^-102 of its terms. Of four products, a
// component of conj(a) b is off by 2^-101; an entry of the matrix has four of those, once more as
// many roundings, and the quotient: 2^-98, and the nine together less than four times that.
constexpr double kWideError = 0x1p-96;

// Products of smaller components, the largest being about 1, leave digits where doubles have none.
constexpr double kSmallest = 1e-140;

// By a power of two: the largest component is in [1, 2).
Components scaled(const RelativePose::Orientation& q) noexcept {
  const int exponent = std::ilogb(q.coeffs().cwiseAbs().maxCoeff());
  Components out;
  for (int i = 0; i < 4; ++i) {
    const double given = q.coeffs()[i], value = std::ldexp(given, -exponent);
    const bool zero = given == 0.0;
    out[static_cast<std::size_t>(i)] = {value, zero, zero || std::abs(value) > kSmallest};
  }
  return out;
}

// One component of a product of quaternions: four products of doubles.
struct FourProducts {
  std::array<DoubleDouble, 4> terms;
  bool whole = true;  // no digit of them is missing

  void put(std::size_t i, double sign, const Scaled& a, const Scaled& b) noexcept {
    if (a.zero || b.zero) return;
    terms[i] = exact::product(sign * a.value, b.value);
    whole = whole && a.whole && b.whole;
  }
  [[nodiscard]] DoubleDouble sum() const noexcept {
    return (terms[0] + terms[1]) + (terms[2] + terms[3]);
  }
  // Is it x for certain?
  [[nodiscard]] bool is_exactly(double x) const noexcept {
    std::array<double, 9> parts;
    for (std::size_t i = 0; i < 4; ++i) {
      parts[2 * i] = terms[i].low;
      parts[2 * i + 1] = terms[i].high;
    }
    parts[8] = -x;
    return whole && exact::sum_is_zero(parts);
  }
};

// conj(a) b.
std::array<FourProducts, 4> relative(const Components& a, const Components& b) noexcept {
  constexpr std::size_t w = 3;
  std::array<FourProducts, 4> out;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    out[x].put(0, 1.0, a[w], b[x]);
    out[x].put(1, -1.0, a[x], b[w]);
    out[x].put(2, 1.0, a[z], b[y]);
    out[x].put(3, -1.0, a[y], b[z]);
    out[w].put(x + 1, 1.0, a[x], b[x]);
  }
  out[w].put(0, 1.0, a[w], b[w]);
  return out;
}

// N(q) / |q|^2.
std::array<WideVec, 3> matrix(const std::array<FourProducts, 4>& of) noexcept {
  const DoubleDouble x = of[0].sum(), y = of[1].sum(), z = of[2].sum(), w = of[3].sum();
  const DoubleDouble xx = x * x, yy = y * y, zz = z * z, ww = w * w;
  const DoubleDouble square = (ww + xx) + (yy + zz);
  const auto twice = [&](const DoubleDouble& v) { return (v + v) / square; };
  return {{{((ww + xx) - (yy + zz)) / square, twice(x * y - w * z), twice(x * z + w * y)},
           {twice(x * y + w * z), ((ww + yy) - (xx + zz)) / square, twice(y * z - w * x)},
           {twice(x * z - w * y), twice(y * z + w * x), ((ww + zz) - (xx + yy)) / square}}};
}

// A component of the relative quaternion, and what is certain of it.
struct Component {
  double rounded;
  bool zero, exact;

  explicit Component(const FourProducts& of) noexcept
      : rounded(static_cast<double>(of.sum())),
        zero(of.is_exactly(0.0)),
        exact(zero || (std::abs(rounded) > kSmallest && of.is_exactly(rounded))) {
    if (zero) rounded = 0.0;
  }
};
using Components4 = std::array<Component, 4>;

// Is i k + sign * j l = 0, for certain?
bool cancel(const Component& i, const Component& k, double sign, const Component& j,
            const Component& l) noexcept {
  if ((i.zero || k.zero) && (j.zero || l.zero)) return true;
  if (!i.exact || !k.exact || !j.exact || !l.exact) return false;
  const DoubleDouble p = exact::product(i.rounded, k.rounded);
  const DoubleDouble q = exact::product(j.rounded, l.rounded);
  return p.high == -sign * q.high && p.low == -sign * q.low;
}

// Is an entry of the matrix 0, for certain?
bool is_zero(const Components4& q, std::size_t row, std::size_t column) noexcept {
  if (row != column) {
    const double sign = column == (row + 1) % 3 ? -1.0 : 1.0;
    return cancel(q[row], q[column], sign, q[3], q[3 - row - column]);
  }
  FourProducts squares;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!q[k].exact) return false;
    const DoubleDouble square = exact::product(q[k].rounded, q[k].rounded);
    squares.terms[k] = k == row || k == 3 ? square : -square;
  }
  return squares.is_exactly(0.0);
}

DoubleDouble& entry(WideRotation& r, std::size_t row, std::size_t column) noexcept {
  WideVec& of = r.rows[row];
  return column == 0 ? of.x : column == 1 ? of.y : of.z;
}

// The axes that the exact rotation only exchanges: their entries are 0 and 1, whatever rounding has
// made of them. If it does so with all three, there is no error left.
void set_axes(const std::array<FourProducts, 4>& of, WideRotation& r) noexcept {
  const Components4 q = {Component(of[0]), Component(of[1]), Component(of[2]), Component(of[3])};
  int known = 0;
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t next = (row + 1) % 3, last = (row + 2) % 3;
      if (!is_zero(q, next, column) || !is_zero(q, last, column)) continue;
      const double way = std::copysign(1.0, entry(r, row, column).high);
      for (std::size_t k = 0; k < 3; ++k) {
        entry(r, row, k) = 0.0;
        entry(r, k, column) = 0.0;
      }
      entry(r, row, column) = way;
      r.lands_on[column] = static_cast<int>(row);
      ++known;
    }
  }
  if (known == 3) r.error = 0.0;
}

// Somebody may have given the pose another rotation than its orientations have.
bool agrees(const WideRotation& wide, const RelativePose& pose) noexcept {
  double off2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 row = pose.rotation.row(i);
    off2 += (narrow(wide.rows[static_cast<std::size_t>(i)]) - row).squaredNorm();
  }
  return std::sqrt(off2) <= 2.0 * pose.rotation_error;
}

}  // namespace

WideRotation wide_rotation(const RelativePose& pose) noexcept {
  WideRotation as_given;
  for (int i = 0; i < 3; ++i) {
    as_given.rows[static_cast<std::size_t>(i)] = wide(Vec3(pose.rotation.row(i)));
  }
  as_given.error = pose.rotation_error;
  const double known = std::min(pose.world_from_a.coeffs().cwiseAbs().maxCoeff(),
                                pose.world_from_b.coeffs().cwiseAbs().maxCoeff());
  if (as_given.exact() || !(known > 0.0)) return as_given;

  const Components a = scaled(pose.world_from_a), b = scaled(pose.world_from_b);
  const std::array<FourProducts, 4> of = relative(a, b);
  WideRotation out;
  out.rows = matrix(of);
  out.of_quaternions = true;
  out.error = kWideError;
  set_axes(of, out);
  return agrees(out, pose) ? out : as_given;
}

std::optional<RelativePose> rounded_once(const RelativePose& a_from_b) noexcept {
  const WideRotation known = wide_rotation(a_from_b);
  if (!known.of_quaternions) return {};
  RelativePose out = a_from_b;
  for (int i = 0; i < 3; ++i) {
    out.rotation.row(i) = narrow(known.rows[static_cast<std::size_t>(i)]);
  }
  out.rotation_error = known.exact() ? 0.0 : kRoundedRotationError;
  return out;
}

}  // namespace clearance
