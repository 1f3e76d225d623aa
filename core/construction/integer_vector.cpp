#include "core/construction/integer_vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace clearance::exact {

Integer4 integer_multiple(const std::array<double, 4>& values) {
  // A double is an integer of 53 bits times a power of two, so that all four become integers by the
  // least of those powers. Exact for subnormal numbers as well.
  constexpr int kMantissaBits = 53;
  std::array<std::int64_t, 4> mantissa{};
  std::array<int, 4> exponent{};
  int lowest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < 4; ++i) {
    if (values[i] == 0.0) continue;
    const double fraction = std::frexp(values[i], &exponent[i]);
    mantissa[i] = static_cast<std::int64_t>(std::ldexp(fraction, kMantissaBits));
    lowest = std::min(lowest, exponent[i]);
  }
  Integer4 result;
  for (std::size_t i = 0; i < 4; ++i) {
    if (mantissa[i] == 0) continue;
    mpz_set_si(result[i].get_mpz_t(), mantissa[i]);
    mpz_mul_2exp(result[i].get_mpz_t(), result[i].get_mpz_t(),
                 static_cast<mp_bitcnt_t>(exponent[i] - lowest));
  }
  reduce(result);
  return result;
}

void reduce(std::span<Integer> vector) {
  Integer divisor;
  for (const Integer& component : vector) {
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), component.get_mpz_t());
    if (divisor == 1) return;
  }
  if (divisor == 0) return;
  for (Integer& component : vector) {
    mpz_divexact(component.get_mpz_t(), component.get_mpz_t(), divisor.get_mpz_t());
  }
}

Integer3 cross(const Integer3& a, const Integer3& b) {
  return {Integer(a[1] * b[2] - a[2] * b[1]), Integer(a[2] * b[0] - a[0] * b[2]),
          Integer(a[0] * b[1] - a[1] * b[0])};
}

Integer dot(const Integer3& a, const Integer3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Integer dot(const Integer4& a, const Integer4& b) {
  Integer sum;
  for (std::size_t i = 0; i < 4; ++i) {
    mpz_addmul(sum.get_mpz_t(), a[i].get_mpz_t(), b[i].get_mpz_t());
  }
  return sum;
}

bool is_zero(std::span<const Integer> vector) {
  return std::all_of(vector.begin(), vector.end(), [](const Integer& x) { return sgn(x) == 0; });
}

Integer3 head(const Integer4& vector) { return {vector[0], vector[1], vector[2]}; }

// With w = 1, h.p = n.p - n.a, where n = a x b + b x c + c x a = (b - a) x (c - a).
Integer4 plane_through(const Integer4& a, const Integer4& b, const Integer4& c) {
  const Integer3 bc = cross(head(b), head(c));
  const Integer3 ca = cross(head(c), head(a));
  const Integer3 ab = cross(head(a), head(b));
  Integer4 plane;
  for (std::size_t i = 0; i < 3; ++i) plane[i] = a[3] * bc[i] + b[3] * ca[i] + c[3] * ab[i];
  plane[3] = -dot(head(a), bc);
  return plane;
}

}  // namespace clearance::exact
