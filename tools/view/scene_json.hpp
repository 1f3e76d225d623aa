// The cell as the page draws it: objects, meshes of their parts, pairs and zones, as JSON.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "config/cell/cell.hpp"
#include "core/pose.hpp"

namespace clearance::view {

// Equal meshes occur once. A pose is [x, y, z, qx, qy, qz, qw]; lengths are in m. Zones have
// shells: the parts of one of their groups, enlarged by the zone's entry distance. `zone_causes`
// has the texts of monitor/interface/zone_cause.hpp by the number of the cause, with {} for the
// object's name. `colours` are those of objects that have one, sRGB from 0 to 1.
[[nodiscard]] std::string scene_json(const Cell& cell, const std::map<std::size_t, Vec3>& colours);

}  // namespace clearance::view
