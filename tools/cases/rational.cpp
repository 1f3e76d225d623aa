#include "tools/cases/rational.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace clearance {
namespace {

constexpr int kLargestExponent = 10'000;  // far larger than any double

Rational power_of_ten(int exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(exponent)));
  return exponent < 0 ? Rational(1, power) : Rational(power);
}

}  // namespace

std::optional<Rational> rational_from(const std::string& decimal) {
  const std::size_t mantissa_end = std::min(decimal.find_first_of("eE"), decimal.size());
  int exponent = 0;
  if (mantissa_end < decimal.size()) {
    const std::size_t start = mantissa_end + (decimal[mantissa_end + 1] == '+' ? 2 : 1);
    const char* const end = decimal.data() + decimal.size();
    const auto read = std::from_chars(decimal.data() + start, end, exponent);
    const bool usable = read.ec == std::errc() && read.ptr == end;
    if (!usable || exponent < -kLargestExponent || exponent > kLargestExponent) return std::nullopt;
  }
  std::string digits = decimal.substr(0, mantissa_end);
  if (const std::size_t point = digits.find('.'); point != std::string::npos) {
    exponent -= static_cast<int>(digits.size() - point - 1);
    digits.erase(point, 1);
  }
  const bool negative = digits.starts_with('-');
  if (negative) digits.erase(0, 1);
  const bool plain =
      !digits.empty() && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  if (!plain || std::abs(exponent) > kLargestExponent) return std::nullopt;
  const Rational value = Rational(mpz_class(digits, 10)) * power_of_ten(exponent);
  return negative ? Rational(-value) : value;
}

double root_of(const Rational& square) { return std::sqrt(square.get_d()); }

RationalPoint in_body(const Pose& world_from_body, const RationalPoint& in_world) {
  const Eigen::Quaterniond& q = world_from_body.orientation;
  const Rational w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const Rational square = w * w + x * x + y * y + z * z;
  RationalPoint v;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    v[axis] = (in_world[axis] - Rational(world_from_body.position[i])) / square;
  }
  // The transpose of the rotation by q, times its square.
  return {(w * w + x * x - y * y - z * z) * v[0] + 2 * (x * y + w * z) * v[1] +
              2 * (x * z - w * y) * v[2],
          2 * (x * y - w * z) * v[0] + (w * w - x * x + y * y - z * z) * v[1] +
              2 * (y * z + w * x) * v[2],
          2 * (x * z + w * y) * v[0] + 2 * (y * z - w * x) * v[1] +
              (w * w - x * x - y * y + z * z) * v[2]};
}

Rational squared_distance(const RationalPoint& a, const RationalPoint& b) {
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace clearance
