// How two rays lean apart, against what quaternions of few components say in closed form.
#include "core/model/lean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

Lean lean(const Quat& a, const Quat& b) {
  return Lean(relative_pose({Vec3::Zero(), a}, {Vec3::Zero(), b}), true);
}
Apart apart(const Lean& lean, const Vec3& e, const Vec3& f) {
  return apart(lean.kept(long_vec(e)), lean.turned(long_vec(f)));
}

TEST(LongSum, LosesNothingBetweenTheLargestAndTheLeastDouble) {
  LongSum<1> sum;
  sum.add(1e308);
  sum.add(kLeast);
  EXPECT_EQ(sum.sign(), 1);
  sum.add(-1e308);
  EXPECT_EQ(sum.sign(), 1);
  EXPECT_EQ(sum.scaled(1074).high, 1.0);
  sum.add(-2.0 * kLeast);
  EXPECT_EQ(sum.sign(), -1);
  sum.add(kLeast);
  EXPECT_EQ(sum.sign(), 0);
}

TEST(LongSum, OfProductsIsKnownToTwiceTheDigitsAndCancelsToTheLast) {
  const double x = 1.0 + 0x1p-52, y = 1.0 - 0x1p-53;
  for (const int exponent : {0, -1000, 900}) {
    LongSum<1> a, b;
    a.add(std::ldexp(x, exponent));
    b.add(std::ldexp(y, exponent));
    LongSum<2> sum;
    sum.add_product(a, b);
    EXPECT_EQ(sum.scaled(-2 * exponent).high, exact::product(x, y).high);
    EXPECT_EQ(sum.scaled(-2 * exponent).low, exact::product(x, y).low);
    sum.add_product(b, a, -1);
    EXPECT_EQ(sum.sign(), 0);
  }
}

TEST(LongSum, IsCopiedWithTheDigitsThatAreInUse) {
  LongSum<1> wide, narrow;
  wide.add(1e300);
  wide.add(kLeast);
  narrow.add(3.0);
  LongSum<1> copy = wide;
  copy.add(-1e300);
  EXPECT_EQ(copy.scaled(1074).high, 1.0);
  copy = narrow;
  EXPECT_EQ(copy.scaled(0).high, 3.0);
  copy = wide;
  copy.add(-1e300);
  EXPECT_EQ(copy.scaled(1074).high, 1.0);
}

TEST(Lean, OfALineTurnedByASubnormalIsAcrossTheTurn) {
  const Vec3 z = Vec3::UnitZ();
  for (const double tilt : {1e-20, 1e-200, kLeast, -kLeast}) {
    const Apart found = apart(lean({1, 0, 0, 0}, {1, tilt, 0, 0}), z, z);
    EXPECT_EQ(found.sign, 1.0);
    EXPECT_LE((narrow(found.way) - Vec3(0, tilt > 0.0 ? -1 : 1, 0)).norm(), 1e-15) << tilt;
  }
}

TEST(Lean, OfALineUpsideDownRunsAgainstTheOther) {
  const Vec3 z = Vec3::UnitZ();
  const Apart found = apart(lean({1, 0, 0, 0}, {0, 1, 0, kLeast}), z, z);
  EXPECT_EQ(found.sign, -1.0);
  EXPECT_LE((narrow(found.way) - Vec3(1, 0, 0)).norm(), 1e-15);
}

TEST(Lean, OfATurnAboutTheLineIsNone) {
  const Vec3 along(1, 1, 0);
  const Apart found = apart(lean({1, 0, 0, 0}, {0.3, 0.7, 0.7, 0}), along, along);
  EXPECT_TRUE(narrow(found.way).isZero(0.0));
}

TEST(Lean, SaysOnWhichSideOfAWallALineEnds) {
  const auto side = [](const Lean& of) {
    return dot(long_vec(Vec3(Vec3::UnitX())), of.turned(long_vec(Vec3(Vec3::UnitZ())))).sign();
  };
  for (const double tilt : {1e-20, 1e-200, kLeast}) {
    EXPECT_EQ(side(lean({1, 0, 0, 0}, {1, 0, tilt, 0})), 1);
    EXPECT_EQ(side(lean({1, 0, 0, 0}, {1, 0, -tilt, 0})), -1);
    EXPECT_EQ(side(lean({1, 0, 0, 0}, {1, tilt, 0, 0})), 0);
  }
  // What two tilts do one after the other is the product of both.
  EXPECT_EQ(side(lean({1, 0, 0, 0}, {1, 0x1p-300, 0, 0x1p-300})), 1);
}

}  // namespace
}  // namespace clearance
