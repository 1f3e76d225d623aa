// How deep two bodies overlap at least, where symmetry says it: there minima of the depth fill a
// circle or a sphere, which triangles of directions (depth.hpp) would have to be too small for.
#pragma once

#include "core/curved/curved_pair.hpp"

namespace clearance {

// m, as computed; -infinity: nothing is known. The greatest of
// - balls inside the bodies: their radii less how far their centres are apart;
// - ellipsoids around nearly one centre along nearly the same axes: the least sum of two semi-axes;
// - solids of revolution with nearly one axis: the least over directions in one half-plane.
// What is only nearly so is moved to where it is so, which changes no depth by more than the move.
[[nodiscard]] double least_symmetric_depth(const CurvedPair& pair) noexcept;

// Every point of the body's surface is on a ball of this radius that lies inside; 0: not known.
[[nodiscard]] double rolling_ball(const ConvexBody& body) noexcept;

}  // namespace clearance
