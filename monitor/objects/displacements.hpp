// Stage 2 of a tick: how far each object has come since the last one, and what is known of all of
// them together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/objects/ingest.hpp"

namespace clearance {

struct Displacements {
  // Objects of which this tick knows something else than the last one did: pose, lateness, or how
  // far it may have moved unseen. In the first tick all.
  std::vector<std::uint32_t> changed;
  bool any_lost = false;  // an object is not known, or has made a discontinuity
  // Of any two known objects together, m: how far they may have moved unseen (U), and how far they
  // may have been from where they are now at any instant since the last tick.
  double most_unseen = 0.0, most_displaced = 0.0;
  // Stamps of the moving objects' poses in use; 0: none.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
};

// The objects that are not fixed.
[[nodiscard]] std::vector<std::uint32_t> moving_objects(const Scene& scene);

// Advances the `moving` objects, whose reach is set, to this tick. Allocates nothing where
// `changed` has room for all objects.
void displace(const Scene& scene, std::span<const std::uint32_t> moving, Inputs& inputs,
              Displacements& displaced) noexcept;

}  // namespace clearance
