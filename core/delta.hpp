// The 'delta' step: the closest points of two features' affine hulls, the ten cases of Table 3.1
// (§3.4.2).
#pragma once

#include "core/active_side.hpp"

namespace clearance {

struct Delta {
  Vec3 a, b;  // where x of A and of B should go, common frame
};

// Where many pairs are closest (parallel features) the smallest move is chosen: halfway each
// (§3.4.2.1).
[[nodiscard]] Delta delta(const ActiveSide& a, const ActiveSide& b) noexcept;

}  // namespace clearance
