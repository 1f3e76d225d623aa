// The monitor of a changed scene, as the loop makes it.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "monitor/inputs/source_numbers.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance::test {

// Takes over from `before`, and expects that this allocates nothing.
inline std::unique_ptr<Monitor> taken_over(const Monitor& before, const Scene& scene_before,
                                           const Scene& scene, SourceNumbers& numbers) {
  auto monitor = std::make_unique<Monitor>(scene, &before);
  const SceneMap map = scene_map(scene_before, scene);
  const std::uint64_t allocations_before = allocations();
  EXPECT_TRUE(monitor->take_over(before, map, numbers));
  EXPECT_EQ(allocations(), allocations_before);
  return monitor;
}

}  // namespace clearance::test
