// Tests the counter that the tests of "allocates nothing" rely on.
#include "tests/shared/allocation_count.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace clearance {
namespace {

// A place where the compiler cannot see that the pointer is never read.
void* volatile last_allocation = nullptr;

template <class Allocate>
std::uint64_t allocations_of(const Allocate& allocate) {
  const std::uint64_t before = allocations();
  last_allocation = allocate();
  const std::uint64_t after = allocations();
  std::free(last_allocation);
  return after - before;
}

TEST(AllocationCount, SeesTheFunctionsOfC) {
  EXPECT_EQ(allocations_of([] { return std::malloc(100); }), 1u);
  EXPECT_EQ(allocations_of([] { return std::calloc(10, 10); }), 1u);
  EXPECT_EQ(allocations_of([] { return std::realloc(nullptr, 100); }), 1u);
  EXPECT_EQ(allocations_of([] { return std::aligned_alloc(64, 128); }), 1u);
  EXPECT_EQ(allocations_of([] {
              void* memory = nullptr;
              return posix_memalign(&memory, 64, 128) == 0 ? memory : nullptr;
            }),
            1u);
}

TEST(AllocationCount, SeesOperatorNewAndWhatEigenAllocates) {
  std::uint64_t before = allocations();
  const auto number = std::make_unique<int>(1);
  last_allocation = number.get();
  EXPECT_EQ(allocations() - before, 1u);
  before = allocations();
  std::vector<double> numbers(100);
  last_allocation = numbers.data();
  EXPECT_EQ(allocations() - before, 1u);
  before = allocations();
  Eigen::VectorXd vector(100);
  last_allocation = vector.data();
  EXPECT_EQ(allocations() - before, 1u);
}

TEST(AllocationCount, IsOfOneThread) {
  std::thread other([] { last_allocation = std::malloc(100); });
  const std::uint64_t before = allocations();
  other.join();
  EXPECT_EQ(allocations(), before);
  std::free(last_allocation);
}

}  // namespace
}  // namespace clearance
