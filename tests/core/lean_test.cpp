// How two rays lean apart, against what quaternions of few components say in closed form.
#include "core/lean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

Lean lean(const Quat& a, const Quat& b) {
  return Lean(relative_pose({Vec3::Zero(), a}, {Vec3::Zero(), b}));
}

// Each two of these leave a part of one bit, two bits above the last one.
ExactSum of_single_bits(int count) {
  ExactSum sum;
  sum.add(1.0);
  for (int k = 0; k < count; ++k) {
    const double far = std::ldexp(1.0, 54 + 2 * k);
    sum.add(far + std::ldexp(1.0, 2 * k + 2));
    sum.add(-far);
  }
  return sum;
}

TEST(ExactSum, OfPartsOfSingleBitsIsScaledToTwiceTheDigits) {
  const DoubleDouble sum = of_single_bits(10).scaled(-20);
  EXPECT_EQ(sum.high, 1398101.0 / 1048576.0);  // 1 + 4 + 16 + ... + 4^10
  EXPECT_EQ(sum.low, 0.0);
}

TEST(ExactSum, HoldsAnyNumberOfParts) {
  ExactSum sum = of_single_bits(400);
  EXPECT_LE(sum.end() - sum.begin(), 48);
  for (int k = 400; k > 0; --k) sum.add(-std::ldexp(1.0, 2 * k));
  EXPECT_EQ(sum.rounded(), 1.0);
  EXPECT_EQ(sum.end() - sum.begin(), 1);
}

TEST(Lean, OfALineTurnedByASubnormalIsAcrossTheTurn) {
  const Vec3 z = Vec3::UnitZ();
  for (const double tilt : {1e-20, 1e-200, kLeast, -kLeast}) {
    const Lean::Apart apart = lean({1, 0, 0, 0}, {1, tilt, 0, 0}).apart(z, z);
    ASSERT_TRUE(apart.known) << tilt;
    EXPECT_EQ(apart.sign, 1.0);
    EXPECT_LE((narrow(apart.way) - Vec3(0, tilt > 0.0 ? -1 : 1, 0)).norm(), 1e-15) << tilt;
  }
}

TEST(Lean, OfALineUpsideDownRunsAgainstTheOther) {
  const Vec3 z = Vec3::UnitZ();
  const Lean::Apart apart = lean({1, 0, 0, 0}, {0, 1, 0, kLeast}).apart(z, z);
  ASSERT_TRUE(apart.known);
  EXPECT_EQ(apart.sign, -1.0);
  EXPECT_LE((narrow(apart.way) - Vec3(1, 0, 0)).norm(), 1e-15);
}

TEST(Lean, OfATurnAboutTheLineIsNone) {
  const Vec3 along(1, 1, 0);
  const Lean::Apart apart = lean({1, 0, 0, 0}, {0.3, 0.7, 0.7, 0}).apart(along, along);
  ASSERT_TRUE(apart.known);
  EXPECT_TRUE(narrow(apart.way).isZero(0.0));
  EXPECT_FALSE(lean({1, 0, 0, 0}, {1, 1, 0, 0.5}).apart(along, {1, 2, 0}).known);
}

TEST(Lean, SaysOnWhichSideOfAWallALineEnds) {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  for (const double tilt : {1e-20, 1e-200, kLeast}) {
    EXPECT_EQ(lean({1, 0, 0, 0}, {1, 0, tilt, 0}).sign(x, z), 1);
    EXPECT_EQ(lean({1, 0, 0, 0}, {1, 0, -tilt, 0}).sign(x, z), -1);
    EXPECT_EQ(lean({1, 0, 0, 0}, {1, tilt, 0, 0}).sign(x, z), 0);
  }
  // What two tilts do one after the other is the product of both.
  EXPECT_EQ(lean({1, 0, 0, 0}, {1, 0x1p-300, 0, 0x1p-300}).sign(x, z), 1);
}

}  // namespace
}  // namespace clearance
