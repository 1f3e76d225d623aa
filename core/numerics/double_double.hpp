// A number of about 32 digits: the unevaluated sum of two doubles.
//
// Sums and products of doubles are exact by the error-free transformations of Knuth and Dekker.
// They need no fused multiply-add and give the same bits on every machine. Magnitudes must be
// between 1e-140 and 1e140.
#pragma once

#include <cmath>

namespace clearance {

struct DoubleDouble {
  double high = 0.0, low = 0.0;

  constexpr DoubleDouble() noexcept = default;
  constexpr DoubleDouble(double value) noexcept : high(value) {}  // NOLINT: exact, so implicit
  constexpr DoubleDouble(double h, double l) noexcept : high(h), low(l) {}
  explicit constexpr operator double() const noexcept { return high + low; }
};

namespace exact {

constexpr DoubleDouble sum(double a, double b) noexcept {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

// |a| >= |b|, or a = 0.
constexpr DoubleDouble ordered_sum(double a, double b) noexcept {
  const double s = a + b;
  return {s, b - (s - a)};
}

constexpr DoubleDouble split(double a) noexcept {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double high = c - (c - a);
  return {high, a - high};
}

constexpr DoubleDouble product(double a, double b) noexcept {
  const double p = a * b;
  const DoubleDouble x = split(a), y = split(b);
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

}  // namespace exact

constexpr DoubleDouble operator-(const DoubleDouble& a) noexcept { return {-a.high, -a.low}; }

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  const DoubleDouble s = exact::sum(a.high, b.high), t = exact::sum(a.low, b.low);
  const DoubleDouble u = exact::ordered_sum(s.high, s.low + t.high);
  return exact::ordered_sum(u.high, u.low + t.low);
}

constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a + (-b);
}

constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  const DoubleDouble p = exact::product(a.high, b.high);
  return exact::ordered_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(first);
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - b * DoubleDouble(second);
  return DoubleDouble(first) + DoubleDouble(second) + DoubleDouble(last.high / b.high);
}

constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}
constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) noexcept { return b < a; }
constexpr bool operator<=(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return !(b < a);
}
constexpr bool operator>=(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return !(a < b);
}

inline DoubleDouble sqrt(const DoubleDouble& a) noexcept {
  if (!(a.high > 0.0)) return {};
  const double root = std::sqrt(a.high);
  const DoubleDouble rest = a - exact::product(root, root);
  return exact::ordered_sum(root, rest.high / (2.0 * root));
}

}  // namespace clearance
