#include "monitor/pairs/budget.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

TEST(Budget, KeepsWhatIsReservedFromTheStepsBeforeItsRelease) {
  Budget budget(10);
  budget.spend(2);
  const std::uint32_t kept = budget.reserve(5);
  EXPECT_EQ(budget.left(), 3u);
  budget.spend(3);
  EXPECT_EQ(budget.left(), 0u);
  budget.release(kept);
  EXPECT_EQ(budget.left(), 5u);
}

TEST(Budget, ReservesNoMoreThanThereIs) {
  Budget budget(3);
  EXPECT_EQ(budget.reserve(5), 3u);
  EXPECT_EQ(budget.left(), 0u);
  EXPECT_EQ(budget.reserve(5), 0u);
}

}  // namespace
}  // namespace clearance
