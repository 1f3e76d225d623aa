// §5.5.1, which the thesis describes and did not build: DQP3's analogue for a polyhedron and an
// ellipsoid. The active set is the polyhedron's. 'Delta' is the point nearest to the ellipsoid on a
// facet's plane or an edge's line, or a vertex. Alpha and lambda are the same as for two polyhedra.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

struct Line {
  Vec3 point, direction;  // unit
};

// Returns the closest points of a line and an ellipsoid around the origin; on_a is on the line. The
// normal at the closest point is perpendicular to the line. All surface points with such normals
// lie on one ellipse (5.5.1 to 5.5.4). Projected along the line, it is an ellipse around the
// origin, and the line is a point. If the line passes through the ellipsoid, both results are the
// same point inside.
[[nodiscard]] ClosestPoints line_to_ellipsoid(const Line& line, const Vec3& axes);

// The same for a plane n.x = offset, with n of unit length.
[[nodiscard]] ClosestPoints plane_to_ellipsoid(const Vec3& normal, double offset, const Vec3& axes);

// The polyhedron's frame is A's; the ellipsoid's axes are parallel to it, its centre is `apart`.
// Starts inside; the bodies must not touch.
[[nodiscard]] ClosestPoints polyhedron_to_ellipsoid(const ConvexBody& a, const Vec3& axes,
                                                    const Vec3& apart);

}  // namespace clearance::bench
