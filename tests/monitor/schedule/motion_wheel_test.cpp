#include "monitor/schedule/motion_wheel.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

TEST(MotionWheels, NoTimerIsLateAndNoneMoreThanAQuarterEarly) {
  constexpr std::uint32_t kPairs = 500;
  Random random(81);
  MotionWheels wheels(2, kPairs);
  std::vector<double> since(kPairs), due(kPairs);  // displacement of object 1, m
  double accumulated = 0.0;
  std::vector<std::uint32_t> pairs;
  const auto set = [&](std::uint32_t pair) {
    const double displacement = std::pow(10.0, random.uniform(-3.0, 2.5));
    ASSERT_TRUE(wheels.set(2 * pair + 1, 1, displacement));
    since[pair] = accumulated;
    due[pair] = accumulated + displacement;
  };
  for (std::uint32_t p = 0; p < kPairs; ++p) set(p);
  for (int t = 0; t < 20'000; ++t) {
    const double by = std::pow(10.0, random.uniform(-5.0, t % 100 == 0 ? 1.5 : -2.0));
    wheels.advance(1, by);
    const double before = accumulated;
    accumulated += by;
    pairs.clear();
    ASSERT_TRUE(wheels.take_due(1, kPairs, pairs));
    for (const std::uint32_t p : pairs) {
      EXPECT_GE(accumulated - since[p], 0.74 * (due[p] - since[p]) - 2.0 * MotionWheels::kUnit);
    }
    for (std::uint32_t p = 0; p < kPairs; ++p) {
      const bool is_due = due[p] <= accumulated;
      ASSERT_TRUE(!is_due || std::ranges::count(pairs, p) == 1) << before;
    }
    for (const std::uint32_t p : pairs) set(p);
  }
}

TEST(MotionWheels, APairIsTakenOnceAndOffBothWheels) {
  MotionWheels wheels(2, 3);
  ASSERT_TRUE(wheels.set(2, 0, 0.1));
  ASSERT_TRUE(wheels.set(3, 1, 0.1));
  std::vector<std::uint32_t> pairs;
  wheels.advance(0, 1.0);
  wheels.advance(1, 1.0);
  EXPECT_TRUE(wheels.take_due(0, 3, pairs));
  EXPECT_TRUE(wheels.take_due(1, 3, pairs));
  EXPECT_EQ(pairs, std::vector<std::uint32_t>{1});
  EXPECT_FALSE(wheels.is_set(2));
  EXPECT_FALSE(wheels.is_set(3));
}

TEST(MotionWheels, WhatIsLeftForLackOfRoomIsTakenNextTime) {
  MotionWheels wheels(1, 10);
  for (std::uint32_t p = 0; p < 10; ++p) ASSERT_TRUE(wheels.set(2 * p, 0, 0.1 + 0.01 * p));
  wheels.advance(0, 1.0);
  std::vector<std::uint32_t> pairs;
  EXPECT_FALSE(wheels.take_due(0, 4, pairs));
  EXPECT_EQ(pairs.size(), 4u);
  EXPECT_TRUE(wheels.take_due(0, 10, pairs));
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(pairs, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(MotionWheels, LessThanAUnitCannotBeSet) {
  MotionWheels wheels(1, 1);
  EXPECT_FALSE(wheels.set(0, 0, 0.5 * MotionWheels::kUnit));
  EXPECT_FALSE(wheels.is_set(0));
  EXPECT_TRUE(wheels.set(0, 0, kInfinity)) << "as far as the widest ring";
  wheels.cancel(0);
  wheels.cancel(0);
  EXPECT_FALSE(wheels.is_set(0));
}

}  // namespace
}  // namespace clearance
