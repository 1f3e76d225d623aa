// Oracle: the neighbouring doubles, compared as rationals.
#include "core/construction/rounded_once.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/shared/random.hpp"
#include "tests/shared/vertex_enumeration.hpp"

namespace clearance::exact {
namespace {

Integer random_integer(Random& random, int bits) {
  Integer result = 0;
  for (int i = 0; i < bits; i += 32)
    result = (result << 32) + static_cast<unsigned>(random.next() >> 32);
  return (result >> random.integer(0, bits - 1)) * (random.chance(0.5) ? 1 : -1);
}

TEST(ExactRounding, QuotientIsTheNearestDouble) {
  Random random(1);
  for (int round = 0; round < 5000; ++round) {
    const Integer numerator = random_integer(random, 256);
    const Integer denominator = abs(random_integer(random, 256)) + 1;
    const Rounded rounded = nearest_quotient(numerator, denominator);
    mpq_class exact(numerator, denominator);
    exact.canonicalize();
    EXPECT_TRUE(oracle::is_nearest(rounded.value, exact));
    EXPECT_EQ(rounded.exact, mpq_class(rounded.value) == exact);
  }
}

TEST(ExactRounding, TiesGoToEvenAndAHairBeyondDoesNot) {
  const Integer one = Integer(1) << 60;
  const Integer half_ulp = Integer(1) << 7;
  EXPECT_EQ(nearest_quotient(one + half_ulp, one).value, 1.0);
  EXPECT_EQ(nearest_quotient(one + 3 * half_ulp, one).value, 1.0 + 0x1p-51);
  const Integer far = Integer(1) << 2000;
  EXPECT_EQ(nearest_quotient((one + half_ulp) * far + 1, one * far).value, 1.0 + 0x1p-52);
  EXPECT_FALSE(nearest_quotient(one + half_ulp, one).exact);
  EXPECT_TRUE(nearest_quotient(-3 * one, 4 * one).exact);
}

TEST(ExactRounding, OutOfRangeIsInfiniteOrZeroAndNotExact) {
  EXPECT_EQ(nearest_quotient(Integer(1) << 2000, 1).value, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(nearest_quotient(Integer(1) << 2000, 1).exact);
  EXPECT_EQ(nearest_quotient(-1, Integer(1) << 2000).value, 0.0);
  EXPECT_FALSE(nearest_quotient(-1, Integer(1) << 2000).exact);
}

TEST(ExactRounding, QuotientByARootIsTheNearestDouble) {
  Random random(2);
  for (int round = 0; round < 5000; ++round) {
    const Integer numerator = abs(random_integer(random, 200)) + 1;
    const Integer square = abs(random_integer(random, 300)) + 1;
    const double value = nearest_over_root(numerator, square).value;
    EXPECT_EQ(nearest_over_root(-numerator, square).value, -value);
    // The squares of the midpoints to the neighbouring doubles enclose numerator^2 / square.
    const mpq_class low = (mpq_class(value) + mpq_class(std::nextafter(value, 0.0))) / 2;
    const mpq_class high = (mpq_class(value) + mpq_class(std::nextafter(value, HUGE_VAL))) / 2;
    mpq_class exact(numerator * numerator, square);
    exact.canonicalize();
    EXPECT_LE(low * low, exact);
    EXPECT_GE(high * high, exact);
  }
  EXPECT_EQ(nearest_over_root(6, 4).value, 3.0);
  EXPECT_TRUE(nearest_over_root(6, 4).exact);
  EXPECT_FALSE(nearest_over_root(6, 5).exact);
}

// With square = floor(4^k numerator^2 / q^2), the quotient is q / 2^k but for one part in 2^200.
TEST(ExactRounding, AHairBeyondATieOfAQuotientByARootDoesNotGoToEven) {
  const Integer one = Integer(1) << 53;
  const Integer tie = (one << 6) + (1 << 6);  // halfway between 1 and the next double, times 2^59
  const Integer numerator = (Integer(1) << 260) + 1;
  const Integer scaled = (numerator * numerator) << 118;
  const Integer square = scaled / (tie * tie);
  ASSERT_NE(square * tie * tie, scaled);
  EXPECT_EQ(nearest_over_root(numerator, square).value, 1.0 + 0x1p-52);
  EXPECT_EQ(nearest_over_root(tie, one * one << 12).value, 1.0);
}

TEST(ExactVectors, AreReducedByTheirLargestDivisorAndStayWhereTheyAreZero) {
  Integer3 vector{-12, 0, 18}, zero{0, 0, 0};
  reduce(vector);
  reduce(zero);
  EXPECT_EQ(vector, (Integer3{-2, 0, 3}));
  EXPECT_EQ(zero, (Integer3{0, 0, 0}));
}

TEST(ExactRounding, UnitVectorsAreWithinAnUlpOfTheirDirection) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    const int bits = random.integer(1, 20) * 64;
    const Integer3 v = {random_integer(random, bits), random_integer(random, bits),
                        random_integer(random, bits)};
    if (is_zero(v)) continue;
    const Vec3 u = unit(v);
    // u x v| <= 2^-53 |v| and |u| is within 2^-53 of 1, evaluated in rationals.
    mpq_class squared_error = 0, squared_length = 0, squared_unit = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const mpq_class c = mpq_class(u[i]) * v[static_cast<std::size_t>(j)] -
                          mpq_class(u[j]) * v[static_cast<std::size_t>(i)];
      squared_error += c * c;
      squared_length += v[static_cast<std::size_t>(i)] * v[static_cast<std::size_t>(i)];
      squared_unit += mpq_class(u[i]) * mpq_class(u[i]);
      EXPECT_LE(sgn(mpq_class(u[i]) * v[static_cast<std::size_t>(i)]), 1);
      EXPECT_GE(sgn(mpq_class(u[i]) * v[static_cast<std::size_t>(i)]), 0);
    }
    EXPECT_LE(squared_error, mpq_class(0x1p-106) * squared_length);
    EXPECT_LE(abs(mpq_class(squared_unit - 1)), mpq_class(0x1p-52));
  }
  EXPECT_EQ(unit({0, -7, 0}), Vec3(0, -1, 0));
  EXPECT_EQ(unit({3, 0, 4}), Vec3(0.6, 0, 0.8));
}

TEST(ExactRounding, DirectionsThatDoublesCanHoldAreExact) {
  const Integer odd = (Integer(1) << 53) - 1;
  const RoundedDirection kept = nearest_direction({odd << 90, 0, -3});
  EXPECT_TRUE(kept.exact);
  EXPECT_EQ(kept.vector.z() / kept.vector.x(), -3.0 / (0x1p53 - 1.0) * 0x1p-90);
  EXPECT_TRUE(nearest_direction({Integer(7 * odd), Integer(-14 * odd), 0}).exact);
  const RoundedDirection axis = nearest_direction({0, 0, Integer(-5) << 300});
  EXPECT_TRUE(axis.exact);
  EXPECT_EQ(axis.vector, Vec3(0, 0, -1));
  const RoundedDirection tilted = nearest_direction({-(Integer(1) << 1074), 0, 1});
  EXPECT_TRUE(tilted.exact);
  EXPECT_EQ(tilted.vector, Vec3(-1, 0, 0x1p-1074));
  EXPECT_FALSE(nearest_direction({Integer(1) << 1075, 0, 1}).exact);
  const RoundedDirection lost = nearest_direction({(Integer(1) << 53) + 1, 1, 0});
  EXPECT_FALSE(lost.exact);
  EXPECT_NEAR(lost.vector.norm(), 1.0, 1e-15);
}

TEST(ExactRounding, OppositeDirectionsStayOpposite) {
  const Integer large = (Integer(1) << 1200) + 1;
  const RoundedDirection there = nearest_direction({large, -3, 7 * large}),
                         back = nearest_direction({-large, 3, -7 * large});
  EXPECT_FALSE(there.exact);
  EXPECT_EQ(there.vector, -back.vector);
}

}  // namespace
}  // namespace clearance::exact
