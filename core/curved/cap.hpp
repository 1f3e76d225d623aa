// A cap of a truncated cone: along its axis the whole disc is the support set, which is where the
// support function of a disc has no derivative.
#pragma once

#include <array>
#include <cstddef>

#include "core/curved/curved_pair.hpp"

namespace clearance {

struct CapTest {
  bool closest = false;   // the other body's support set lies over the cap: the bounds say so
  SupportPair support{};  // else where a search from the axis begins
  Vec3 normal = Vec3::Zero();
  std::array<PiecePair, 3> pieces{};  // those that its nearest point lies on
  std::size_t count = 0;
};

// The cap of A (or of B) that faces along n. Sets the rim's azimuth towards the other body.
[[nodiscard]] CapTest test_cap(CurvedPair& pair, bool of_a, const Vec3& n) noexcept;

}  // namespace clearance
