#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

#include "monitor/tick/spsc_ring.hpp"

namespace clearance {
namespace {

TEST(SpscRing, SaysWhenItIsFullAndWhenItIsEmpty) {
  SpscRing<int> ring(3);  // rounded up to 4
  EXPECT_EQ(ring.capacity(), 4u);
  EXPECT_EQ(ring.front(), nullptr);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(ring.back(), nullptr);
    *ring.back() = i;
    ring.push();
  }
  EXPECT_EQ(ring.back(), nullptr);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), i);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_NE(ring.back(), nullptr);
}

TEST(SpscRing, CarriesEveryValueInOrderBetweenTwoThreads) {
  constexpr std::uint64_t kValues = 20'000;
  SpscRing<std::uint64_t> ring(8);
  std::thread filler([&] {
    for (std::uint64_t value = 0; value < kValues;) {
      std::uint64_t* slot = ring.back();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      *slot = value++;
      ring.push();
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < kValues;) {
    const std::uint64_t* slot = ring.front();
    if (slot == nullptr) {
      std::this_thread::yield();
      continue;
    }
    wrong += *slot != expected++;
    ring.pop();
  }
  filler.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace clearance
