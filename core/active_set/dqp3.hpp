// DQP3: the primal active-set QP for two convex bodies (§3.3.2, §3.4), base release rule (§4.1).
#pragma once

#include <cstdint>

#include "core/active_set/active_feature.hpp"

namespace clearance {

enum class Dqp3End : std::uint8_t {
  kCertified,  // KKT satisfied: every release would increase the distance by more than rounding
  kOptimal,    // no release brings the bodies closer, as far as rounding can tell
  kContact,    // the two points coincide to within `contact`
  kStalled,    // a release did not bring them closer: rounding decides from here on
  kLimit,      // iterations used up
};

struct Dqp3Outcome {
  Dqp3End end = Dqp3End::kLimit;
  std::uint16_t iterations = 0;
  // Frame A, from A to B; its length is the distance of the active features, m.
  Vec3 separating_direction = Vec3::Zero();
};

// Moves both points from their present places to the closest points. It ends because the distance
// falls strictly between two releases, so no active set comes twice. `contact`: points within this
// of each other (m) coincide.
[[nodiscard]] Dqp3Outcome dqp3(ActiveFeature& a, ActiveFeature& b, double contact) noexcept;

}  // namespace clearance
