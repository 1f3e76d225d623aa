// Oracle: the C library's sine and cosine of long doubles.
#include "monitor/bodies/sine_cosine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "monitor/inputs/joint_batch.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

long double error_at(double angle) {
  const SineCosine at = sine_cosine(angle);
  const auto exact = static_cast<long double>(angle);
  return std::max(std::abs(at.sine - std::sin(exact)), std::abs(at.cosine - std::cos(exact)));
}

TEST(SineCosine, ErrorIsWithinItsBound) {
  Random random(1);
  long double worst = 0.0L;
  for (int i = 0; i < 200000; ++i) {
    worst = std::max(worst, error_at(random.uniform(-7.0, 7.0)));
    worst = std::max(worst, error_at(random.uniform(-kLargestJoint, kLargestJoint)));
    worst = std::max(worst, error_at(random.sign() * random.log_uniform(1e-300, kLargestJoint)));
  }
  EXPECT_LE(worst, 0.5L * kSineError);
}

TEST(SineCosine, ErrorIsWithinItsBoundWhereQuadrantsMeet) {
  Random random(2);
  for (int i = 0; i < 100000; ++i) {
    const double corner = random.integer(-1200000, 1200000) * (0.25 * std::numbers::pi);
    if (std::abs(corner) > kLargestJoint) continue;
    ASSERT_LE(error_at(corner), 0.5L * kSineError) << corner;
    ASSERT_LE(error_at(std::nextafter(corner, 0.0)), 0.5L * kSineError) << corner;
  }
}

// These bits are the same on every machine.
TEST(SineCosine, IsTheSameEverywhere) {
  EXPECT_EQ(sine_cosine(0.0).sine, 0.0);
  EXPECT_EQ(sine_cosine(0.0).cosine, 1.0);
  double sum = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const SineCosine at = sine_cosine(0.01 * i - 500.0);
    sum = 0.7 * sum + at.sine - 0.3 * at.cosine;
  }
  EXPECT_EQ(sum, -0x1.1f41503dc07a6p-1);
}

}  // namespace
}  // namespace clearance
