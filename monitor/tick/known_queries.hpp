// Distance queries whose answers are known to the bit: they show that processor, libraries and
// tables still compute what they computed when this was built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

struct KnownQuery {
  const char* what = nullptr;
  ConvexBody a, b;
  Pose a_from_b;
  std::uint64_t answer = 0;  // a checksum of the result

  // A checksum of the result that it has now. noexcept, no heap.
  [[nodiscard]] std::uint64_t ask() const noexcept;
};

// Bodies apart, bodies that overlap, and a curved one. Made at the first call.
[[nodiscard]] std::span<const KnownQuery> known_queries();

}  // namespace clearance
