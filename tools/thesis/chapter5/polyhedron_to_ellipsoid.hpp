// §5.5.1, which the thesis describes and did not build: DQP3's analogue for a polyhedron and an
// ellipsoid. The active set is the polyhedron's; 'delta' is the point of a facet's plane, an edge's
// line or a vertex nearest to the ellipsoid; alpha and lambda are as they are among polyhedra.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

struct Line {
  Vec3 point, direction;  // unit
};

// The closest points of a line and an ellipsoid around the origin, on_a that of the line: normals
// across the line belong to an ellipse of the surface (5.5.1 to 5.5.4), which the plane across the
// line shows as an ellipse around the origin and the line as a point. Where the line passes through
// the ellipsoid, both are the same point in it.
[[nodiscard]] ClosestPoints line_to_ellipsoid(const Line& line, const Vec3& axes);

// The same of a plane n.x = offset, n of unit length.
[[nodiscard]] ClosestPoints plane_to_ellipsoid(const Vec3& normal, double offset, const Vec3& axes);

// The polyhedron's frame is A's; the ellipsoid's axes are parallel to it, its centre is `apart`.
// Starts inside; the bodies must be apart.
[[nodiscard]] ClosestPoints polyhedron_to_ellipsoid(const ConvexBody& a, const Vec3& axes,
                                                    const Vec3& apart);

}  // namespace clearance::bench
