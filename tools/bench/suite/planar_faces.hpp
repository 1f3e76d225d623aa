// Faces of a mesh that lie in one plane within rounding, as one face.
//
// The core decides in exact arithmetic, so a quadrilateral whose corners were rounded is two
// triangles. Rivals that use planes of faces (V-Clip) fail on such pairs.
#pragma once

#include <vector>

#include "tools/bench/suite/rival.hpp"

namespace clearance::bench {

// Faces are counter-clockwise when viewed from outside, before and after.
[[nodiscard]] std::vector<std::vector<int>> planar_faces(
    const std::vector<Numbers3>& points, const std::vector<std::vector<int>>& faces);

}  // namespace clearance::bench
