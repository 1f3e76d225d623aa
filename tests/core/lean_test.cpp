// How two rays lean apart, against what quaternions of few components say in closed form.
#include "core/lean.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

Lean lean(const Quat& a, const Quat& b) {
  return Lean(relative_pose({Vec3::Zero(), a}, {Vec3::Zero(), b}));
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
