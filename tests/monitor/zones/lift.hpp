// An allowed contact of balls for tests.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "config/scene/contact.hpp"

namespace clearance::test {

inline constexpr double kDepth = 0.002;   // m, allowed
inline constexpr double kTouching = 0.2;  // distance of the centres at which two balls touch, m

[[nodiscard]] inline AllowedContact lift(std::vector<std::uint32_t> pairs) {
  AllowedContact contact;
  contact.name = "lift";
  contact.depth = kDepth;
  contact.by = "planner";
  contact.pairs = std::move(pairs);
  return contact;
}

}  // namespace clearance::test
