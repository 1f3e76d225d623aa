// Bodies and poses as rivals are given them.
#pragma once

#include "core/convex_body.hpp"
#include "core/pose.hpp"
#include "tools/bench/suite/rival.hpp"

namespace clearance::bench {

// Turns a bounded body into a sphere around the origin, a capsule along z and around the origin, a
// cylinder, a cone, an ellipsoid, a box, or else the hull of its welded vertices. Body and pose
// outlive the results.
[[nodiscard]] PlainBody plain_body(const ConvexBody& body);
[[nodiscard]] PlainPose plain_pose(const Pose& pose);

}  // namespace clearance::bench
