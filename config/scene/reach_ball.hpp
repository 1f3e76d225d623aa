// A ball that the links of robots on one base do not leave (robot_reach.hpp).
#pragma once

#include <cstdint>

#include "core/vec.hpp"

namespace clearance {

// Around a place of the world if the robots' base stands still. Else around the origin of a link:
// the base, which moves.
struct ReachBall {
  bool is_carried = false;
  Vec3 centre = Vec3::Zero();         // in the world, m; if the base stands still
  std::uint32_t robot = 0, link = 0;  // indices into Scene::robots and its links; if it moves
  double radius = 0.0;                // m

  bool operator==(const ReachBall&) const = default;
};

}  // namespace clearance
