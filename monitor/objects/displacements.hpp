// Stage 2 of a tick: how far each object has moved since the last tick, and bounds over all
// objects.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/objects/ingest.hpp"

namespace clearance {

struct Displacements {
  // Objects whose pose, lateness or bound of unobserved motion differs from the last tick. In the
  // first tick these are all objects.
  std::vector<std::uint32_t> changed;
  bool any_lost = false;  // an object is not known, or has made a discontinuity
  // Bounds for any two known objects together, m. `most_unobserved` (U) bounds their unobserved
  // motion. `most_displaced` bounds how far they were, at any instant since the last tick, from
  // where they are now.
  double most_unobserved = 0.0, most_displaced = 0.0;
  // Newest and oldest stamp of the moving objects' poses in use; 0: none is in use.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
};

// The objects that are not fixed.
[[nodiscard]] std::vector<std::uint32_t> moving_objects(const Scene& scene);

// Advances the `moving` objects to this tick; their `bounding_radius` must be set. Does not
// allocate if the capacity of `changed` covers all objects.
void displace(const Scene& scene, std::span<const std::uint32_t> moving, Inputs& inputs,
              Displacements& displaced) noexcept;

}  // namespace clearance
