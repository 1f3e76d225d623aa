// When a scene came into force in a running daemon.
#pragma once

#include <cstdint>

namespace clearance {

// Both are 0 for the scene that the daemon began with.
struct SceneInForce {
  // The cycle after which its monitor took over what the monitor before it knew. From then on, both
  // monitors ran the same ticks.
  std::uint64_t began_after = 0;
  // The first cycle whose report is of this scene.
  std::uint64_t from = 0;

  bool operator==(const SceneInForce&) const = default;
};

}  // namespace clearance
