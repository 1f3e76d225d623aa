// Points in one plane, and the plate that takes their place: a body needs volume.
#pragma once

#include <optional>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

// Returns the normal of the plane that all points lie in, up to single precision. Returns nothing
// if they do not, or lie on one line. A solid that is thicker than `plate` is not flat: a plate
// would not fill it.
[[nodiscard]] std::optional<Vec3> plane_of(const std::vector<Vec3>& points, double plate);

// Returns points in one plane twice, moved by half the thickness of the plate to either side. Other
// points stay as they are.
[[nodiscard]] std::vector<Vec3> with_volume(const std::vector<Vec3>& points, double plate);

}  // namespace clearance
