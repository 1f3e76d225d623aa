// Oracle: exact rational arithmetic (GMP). u is 2^-53.
//
// Bounds: Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic" (2017). The relative errors are at most 3 u^2 (sum), 5 u^2 (product), 10
// u^2 (quotient) and 25/8 u^2 (root). Each is rounded up to a power of two here.
#include "core/numerics/double_double.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/vec.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

mpq_class exact_value(const DoubleDouble& x) { return mpq_class(x.high) + mpq_class(x.low); }

// A power of two as a rational.
mpq_class two_to(int exponent) {
  mpq_class one = 1;
  return exponent < 0 ? mpq_class(one >> static_cast<mp_bitcnt_t>(-exponent))
                      : mpq_class(one << static_cast<mp_bitcnt_t>(exponent));
}

// Returns true if `found` differs from the truth by a relative error of at most 2^-bits.
bool good_to(int bits, const mpq_class& found, const mpq_class& truth) {
  const mpq_class error = found - truth;
  return abs(error) <= two_to(-bits) * abs(truth);
}

// Two doubles whose sum rounds to the first of them, with magnitudes over twenty orders.
DoubleDouble any(Random& random) {
  const double high = random.sign() * random.log_uniform(1e-10, 1e10);
  return exact::ordered_sum(high, high * random.uniform(-0x1p-54, 0x1p-54));
}

bool is_normalised(const DoubleDouble& x) { return x.high + x.low == x.high; }

constexpr int kPairs = 20000;

TEST(DoubleDouble, SumsAndProductsOfDoublesAreExact) {
  Random random(34);
  for (int k = 0; k < kPairs; ++k) {
    const double a = any(random).high, b = any(random).high;
    const mpq_class sum = mpq_class(a) + mpq_class(b), product = mpq_class(a) * mpq_class(b);
    EXPECT_EQ(exact_value(exact::sum(a, b)), sum) << k;
    EXPECT_EQ(exact_value(exact::product(a, b)), product) << k;
    const double larger = std::abs(a) < std::abs(b) ? b : a, smaller = larger == a ? b : a;
    EXPECT_EQ(exact_value(exact::ordered_sum(larger, smaller)), sum) << k;
    const DoubleDouble halves = exact::split(a);
    EXPECT_EQ(exact_value(halves), mpq_class(a)) << k;
    // Each half has so few bits that the product of two halves is exact.
    const mpq_class high = halves.high;
    EXPECT_EQ(mpq_class(halves.high * halves.high), mpq_class(high * high)) << k;
  }
}

TEST(DoubleDouble, SumsAreGoodTo104BitsEvenWhereTheyCancel) {
  Random random(35);
  for (int k = 0; k < kPairs; ++k) {
    const DoubleDouble a = any(random);
    const DoubleDouble b = random.chance(0.5) ? any(random) : DoubleDouble(-a.high, a.low);
    const DoubleDouble sum = a + b, difference = a - b;
    EXPECT_TRUE(good_to(104, exact_value(sum), exact_value(a) + exact_value(b))) << k;
    EXPECT_TRUE(good_to(104, exact_value(difference), exact_value(a) - exact_value(b))) << k;
    EXPECT_TRUE(is_normalised(sum) && is_normalised(difference)) << k;
  }
}

TEST(DoubleDouble, ProductsQuotientsAndRootsAreGoodTo102Bits) {
  Random random(36);
  for (int k = 0; k < kPairs; ++k) {
    const DoubleDouble a = any(random), b = any(random);
    EXPECT_TRUE(good_to(103, exact_value(a * b), exact_value(a) * exact_value(b))) << k;
    EXPECT_TRUE(good_to(102, exact_value(a / b), exact_value(a) / exact_value(b))) << k;
    // If a root has the relative error e, its square has the relative error 2 e.
    const DoubleDouble positive = a.high < 0.0 ? -a : a, root = sqrt(positive);
    EXPECT_TRUE(good_to(102, exact_value(root) * exact_value(root), exact_value(positive))) << k;
    EXPECT_TRUE(is_normalised(a * b) && is_normalised(a / b) && is_normalised(root)) << k;
  }
}

TEST(DoubleDouble, IsOrderedAsTheNumbersAre) {
  Random random(37);
  for (int k = 0; k < kPairs; ++k) {
    const DoubleDouble a = any(random);
    const DoubleDouble b = random.chance(0.5) ? any(random) : DoubleDouble(a.high, -a.low);
    EXPECT_EQ(a < b, exact_value(a) < exact_value(b)) << k;
    EXPECT_EQ(a > b, exact_value(a) > exact_value(b)) << k;
    EXPECT_EQ(a <= b, exact_value(a) <= exact_value(b)) << k;
    EXPECT_EQ(a >= b, exact_value(a) >= exact_value(b)) << k;
  }
  EXPECT_TRUE(DoubleDouble(1.0) <= DoubleDouble(1.0));
  EXPECT_FALSE(DoubleDouble(1.0) < DoubleDouble(1.0));
}

TEST(DoubleDouble, RootOfWhatIsNotPositiveIsZero) {
  for (const double x : {0.0, -0.0, -1.0, std::nan("")}) {
    const DoubleDouble root = sqrt(DoubleDouble(x));
    EXPECT_EQ(root.high, 0.0);
    EXPECT_EQ(root.low, 0.0);
  }
}

TEST(DoubleDouble, HoldsWhatADoubleLoses) {
  const DoubleDouble sum = DoubleDouble(1.0) + DoubleDouble(0x1p-80);
  EXPECT_EQ(static_cast<double>(sum), 1.0);
  EXPECT_EQ(static_cast<double>(sum - DoubleDouble(1.0)), 0x1p-80);
}

TEST(UnitAlong, IsTheVectorItselfWhereItHasNoDirection) {
  EXPECT_EQ(unit_along(Vec3(0.0, 0.0, 0.0)), Vec3::Zero());
  EXPECT_EQ(unit_along(Vec3(0.0, HUGE_VAL, 1.0)), Vec3(0.0, HUGE_VAL, 1.0));
  EXPECT_TRUE(std::isnan(unit_along(Vec3(0.0, std::nan(""), 1.0)).y()));
  for (const double length : {1e-310, 1e-200, 1.0, 1e300}) {
    EXPECT_LE((unit_along(Vec3(3.0 * length, 0.0, -4.0 * length)) - Vec3(0.6, 0.0, -0.8)).norm(),
              length < 1e-300 ? 1e-13 : 1e-15)
        << length;
  }
}

}  // namespace
}  // namespace clearance
