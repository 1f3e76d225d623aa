#include "core/construction/rounded_once.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace clearance::exact {
namespace {

constexpr int kDoubleBits = 53;
constexpr int kLeastExponent = -1074;  // of a double's last bit

long bits(const Integer& x) {
  return sgn(x) == 0 ? 0 : static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
}

// x * 2^shift, rounded towards zero for a negative shift, so that opposite numbers stay opposite.
Integer shifted(const Integer& x, long shift) {
  Integer result;
  if (shift >= 0) {
    mpz_mul_2exp(result.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(shift));
  } else {
    mpz_tdiv_q_2exp(result.get_mpz_t(), x.get_mpz_t(), static_cast<mp_bitcnt_t>(-shift));
  }
  return result;
}

// Rounds (significand + fraction) * 2^exponent, where 0 < fraction < 1 exactly when `more`. The
// significand has 56 to 62 bits, so its conversion is the one rounding and the sticky last bit
// decides no tie wrongly.
Rounded round_significand(const Integer& significand, bool more, long exponent, bool negative) {
  const std::uint64_t sticky = mpz_get_ui(significand.get_mpz_t()) | (more ? 1U : 0U);
  const double rounded = static_cast<double>(sticky);
  const bool exact = !more && static_cast<std::uint64_t>(rounded) == sticky;
  const int clamped = static_cast<int>(std::clamp(exponent, -4000L, 4000L));
  const double value = std::ldexp(rounded, clamped);
  return {negative ? -value : value, exact && std::ldexp(value, -clamped) == rounded};
}

}  // namespace

Rounded nearest_quotient(const Integer& numerator, const Integer& denominator) {
  if (sgn(numerator) == 0) return {0.0, true};
  const long shift = 58 - (bits(numerator) - bits(denominator));
  const Integer above = shifted(abs(numerator), std::max(shift, 0L));
  const Integer below = shifted(denominator, std::max(-shift, 0L));
  Integer quotient, remainder;
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), above.get_mpz_t(), below.get_mpz_t());
  return round_significand(quotient, sgn(remainder) != 0, -shift, sgn(numerator) < 0);
}

Rounded nearest_over_root(const Integer& numerator, const Integer& square) {
  if (sgn(numerator) == 0) return {0.0, true};
  // floor(sqrt(floor(n^2 4^shift / square))) is floor(n 2^shift / sqrt(square)).
  const Integer squared = numerator * numerator;
  const long shift = 59 - (bits(squared) - bits(square)) / 2;
  const Integer above = shifted(squared, std::max(2 * shift, 0L));
  const Integer below = shifted(square, std::max(-2 * shift, 0L));
  Integer quotient, remainder, root, rest;
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), above.get_mpz_t(), below.get_mpz_t());
  mpz_sqrtrem(root.get_mpz_t(), rest.get_mpz_t(), quotient.get_mpz_t());
  return round_significand(root, sgn(rest) != 0 || sgn(remainder) != 0, -shift, sgn(numerator) < 0);
}

namespace {

// direction / |direction| as quotients.
struct UnitQuotients {
  Integer3 numerators;
  Integer denominator;
};

UnitQuotients unit_quotients(const Integer3& direction) {
  // Bits more than 160 below the largest component do not affect the result.
  constexpr long kKept = 160;
  constexpr long kRootBits = 64;
  const long longest = std::max({bits(direction[0]), bits(direction[1]), bits(direction[2])});
  const long drop = std::min(kKept - longest, 0L);
  const Integer3 kept = {shifted(direction[0], drop), shifted(direction[1], drop),
                         shifted(direction[2], drop)};
  return {{shifted(kept[0], kRootBits), shifted(kept[1], kRootBits), shifted(kept[2], kRootBits)},
          sqrt(shifted(dot(kept, kept), 2 * kRootBits))};
}

}  // namespace

Vec3 unit(const Integer3& direction) {
  const UnitQuotients quotients = unit_quotients(direction);
  Vec3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[static_cast<Eigen::Index>(i)] =
        nearest_quotient(quotients.numerators[i], quotients.denominator).value;
  }
  return result;
}

RoundedDirection nearest_direction(const Integer3& direction) {
  Integer3 shortest = direction;
  reduce(shortest);
  long longest = 0, lowest = std::numeric_limits<long>::max();
  bool exact = true;
  for (const Integer& component : shortest) {
    if (sgn(component) == 0) continue;
    longest = std::max(longest, bits(component));
    const long trailing = static_cast<long>(mpz_scan1(component.get_mpz_t(), 0));
    exact = exact && bits(component) - trailing <= kDoubleBits;
    lowest = std::min(lowest, trailing);
  }
  if (!exact || 1 - longest + lowest < kLeastExponent) return {unit(direction), false};
  Vec3 vector;
  for (std::size_t i = 0; i < 3; ++i) {
    long exponent = 0;
    const double significand = mpz_get_d_2exp(&exponent, shortest[i].get_mpz_t());
    vector[static_cast<Eigen::Index>(i)] =
        std::ldexp(significand, static_cast<int>(exponent + 1 - longest));
  }
  return {vector, true};
}

}  // namespace clearance::exact
