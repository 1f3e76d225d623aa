// What a tick knows of all its inputs together.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/objects/tracked_object.hpp"
#include "monitor/report.hpp"

namespace clearance {

struct InputSummary {
  bool any_lost = false;  // an object is not known, or has leapt
  // Of any two known objects together: how far they may have moved unseen, and may have been from
  // where they are now since the last tick, m.
  double most_unseen = 0.0, most_strayed = 0.0;
};

// `moving`: the objects that are not fixed. The report's newest and oldest stamps are those of the
// poses in use.
[[nodiscard]] InputSummary look_at_inputs(std::span<const TrackedObject> objects,
                                          std::span<const std::uint32_t> moving,
                                          Report& report) noexcept;

}  // namespace clearance
