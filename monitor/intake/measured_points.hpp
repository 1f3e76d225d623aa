// The points of a message as balls that contain what was measured.
#pragma once

#include <vector>

#include "config/scene/sensor.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/intake/camera_messages.hpp"

namespace clearance {

// Half of the diagonal of a square whose sides are 1, and of the roundings of a radius.
inline constexpr double kHalfDiagonal = 0.70710678118654757 * (1.0 + 0x1p-40);

// Replaces the content of `points`. A point that is out of the range is missing: its coordinates
// are NaN. With Sensor::by_neighbours its radius is NaN instead, since OrganisedPoints needs its
// ray. Returns kCannotBuild if a point is more than 60 degrees off the axis along which the depth
// is measured: its ball may lie outside of Sensor::extent(). Returns kTooNear for a coordinate of
// -infinity (REP 117).
[[nodiscard]] FrameFault measured_points(const PointsView& view, const Sensor& sensor,
                                         std::vector<MeasuredPoint>& points);

}  // namespace clearance
