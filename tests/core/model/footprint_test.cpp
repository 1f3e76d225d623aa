// The declared memory use of a body, compared with what a copy of it requests from the allocator.
#include "core/query_tables.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using test::half_space;
using test::made;

// operator new returns whole multiples of this size.
constexpr std::uint64_t kGrain = alignof(std::max_align_t);

void expect_counted(const ConvexBody& body, const std::string& what) {
  const std::uint64_t tables = allocations(), before = allocated_bytes();
  const ConvexBody copy = body;
  const std::uint64_t asked = sizeof copy + (allocated_bytes() - before);
  EXPECT_LE(footprint(body), asked) << what;
  EXPECT_GT(footprint(body) + kGrain * (allocations() - tables), asked) << what;
}

TEST(Footprint, IsWhatABodyAndItsTablesTake) {
  expect_counted(made(box({0.5, 0.4, 0.3})), "box");
  expect_counted(made(segment({0, 0, 0}, {0, 0, 1}, 0.1)), "capsule");
  expect_counted(made(hard::facet_ball(4)), "facet-ball");
  expect_counted(half_space({0, 0, 1}, 0.0), "floor");
  const hard::Body corner{{{{0, 1, 1}, 1}, {{0, 0, 1}, 1}, {{1, 0, 0}, 1}}, {}};
  expect_counted(made(corner), "corner");
}

}  // namespace
}  // namespace clearance
