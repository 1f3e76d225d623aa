// The shortest rotation between two directions.
#include <gtest/gtest.h>

#include <cmath>

#include "core/model/rotation_between.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// Checks that the rotation takes `from` to `to` and rotates no farther than the angle between them.
void expect_shortest(const Vec3& from, const Vec3& to) {
  const Eigen::Quaterniond rotation = rotation_between(from, to);
  EXPECT_NEAR(rotation.norm(), 1.0, 1e-12);
  EXPECT_LT((rotation * from.normalized() - to.normalized()).norm(), 4e-10);
  const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
  EXPECT_NEAR(2.0 * std::atan2(rotation.vec().norm(), rotation.w()), angle, 3e-6);
}

TEST(RotationBetween, TakesOneDirectionToTheOtherByTheAngleBetweenThem) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    expect_shortest(random.direction() * 3.0, random.direction() * 0.2);
  }
}

TEST(RotationBetween, IsAHalfTurnBetweenOppositeDirectionsAndShortNearThem) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = random.direction();
    for (const double off : {0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3}) {
      expect_shortest(from, -from + off * random.direction());
    }
  }
  for (const int axis : {0, 1, 2}) expect_shortest(Vec3::Unit(axis), -Vec3::Unit(axis));
}

TEST(RotationBetween, IsTheIdentityBetweenEqualDirections) {
  EXPECT_EQ(rotation_between(Vec3::UnitZ(), Vec3::UnitZ()).coeffs(),
            Eigen::Quaterniond::Identity().coeffs());
}

}  // namespace
}  // namespace clearance
