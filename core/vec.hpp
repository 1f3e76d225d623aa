// The few linear-algebra names that the rooms share. Lengths in metres, angles in radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace clearance {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

}  // namespace clearance
