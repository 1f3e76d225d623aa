// Our bodies as FCL has them.
#pragma once

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>

#include <memory>
#include <variant>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

using FclHull = fcl::Convex<double>;

// Vertices closer than rounding are welded.
[[nodiscard]] std::shared_ptr<FclHull> fcl_hull(const ConvexBody& body);

// Curved bodies keep their shapes: ellipsoid, cylinder, cone, a capsule along z, a sphere around
// the origin. So do boxes around the origin along the axes. Others become hulls.
using FclShape = std::variant<std::shared_ptr<FclHull>, std::shared_ptr<fcl::Ellipsoidd>,
                              std::shared_ptr<fcl::Cylinderd>, std::shared_ptr<fcl::Coned>,
                              std::shared_ptr<fcl::Capsuled>, std::shared_ptr<fcl::Sphered>,
                              std::shared_ptr<fcl::Boxd>>;
[[nodiscard]] FclShape fcl_shape(const ConvexBody& body);

[[nodiscard]] fcl::Transform3d fcl_transform(const Pose& pose);

}  // namespace clearance::bench
