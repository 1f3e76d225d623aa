// The sensors' frames for the page, without their points.
#pragma once

#include <span>
#include <string>

#include "monitor/visual/seen_frames.hpp"

namespace clearance::view {

// [{"object", "stamp_ns", "elements", "frames", "refused": [{"cause", "count"}], "pose": [x, y, z,
// qx, qy, qz, qw] or null, "shells": {"3": 0.02}}]: shells by link, m. An entry a sensor.
[[nodiscard]] std::string sensors_json(std::span<const SeenState> states);

}  // namespace clearance::view
