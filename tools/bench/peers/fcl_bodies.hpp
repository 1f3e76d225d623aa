// Our bodies as FCL has them.
#pragma once

#include <fcl/geometry/shape/convex.h>

#include <memory>

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

using FclHull = fcl::Convex<double>;

// Vertices closer than rounding are welded.
[[nodiscard]] std::shared_ptr<FclHull> fcl_hull(const ConvexPolyhedron& body);

[[nodiscard]] fcl::Transform3d fcl_transform(const Pose& pose);

}  // namespace clearance::bench
