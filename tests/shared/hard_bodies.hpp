// Convex bodies that are hard for floating point: slivers, plates, many facets in one vertex,
// repeated and almost equal half-spaces, bodies without end. Of about unit size, around the origin
// of their frame.
#pragma once

#include "tests/shared/exact_body.hpp"
#include "tests/shared/random.hpp"

namespace clearance::hard {

using oracle::Body;

[[nodiscard]] Body box(const Vec3& half_extents);
// Facets tangent to spheres of 0.5 to 1 around the origin, in random directions; bounded.
[[nodiscard]] Body random_polytope(Random& random, int facets);
// The hull of random points on a sphere or in a box.
[[nodiscard]] Body random_hull(Random& random, int points);
// Facets evenly over the unit sphere as in §3.5: `order` rings from pole to pole, 2 * order facets
// at the equator. Orders 2, 4, 6, 8, 10, 15, 20, 30, 40 have 6, 22, 46, 82, 128, 288, 510, 1148,
// 2042 facets, half of the thesis's N1 + N2.
[[nodiscard]] Body facet_ball(int order);
// The hull of the facet-ball's normals: its polar dual.
[[nodiscard]] Body dual_ball(int order);
// A pyramid with its tip at (0, 0, height): `sides` facets meet there.
[[nodiscard]] Body cone(int sides, double half_angle, double height);
// A blade along y with its edge at x = 0, pointing to +x, of the given opening angle.
[[nodiscard]] Body wedge(double angle, double half_length);
// A long thin prism along z, one by `aspect`.
[[nodiscard]] Body needle(Random& random, double aspect);
// A tetrahedron whose four corners are within `flatness` of a plane.
[[nodiscard]] Body sliver(Random& random, double flatness);
[[nodiscard]] Body plate(Random& random, double thickness);
// A plate with half-round ends made of `sides` narrow facets each, as robot links are.
[[nodiscard]] Body link(int sides, double length, double thickness);
// Integer corners: exact ties everywhere.
[[nodiscard]] Body lattice(Random& random);
// A corner, slab, wedge, prism, cone or half-space without end.
[[nodiscard]] Body unbounded(Random& random);
// A point or segment with a radius.
[[nodiscard]] Body rounded(Random& random);
// Any bounded one of the above.
[[nodiscard]] Body any_bounded(Random& random);

// The same body described worse. Only for bodies given by rows.
[[nodiscard]] Body with_duplicate_rows(Body body, Random& random);
// Adds rows that touch the body in one vertex, up to rounding, or not at all.
[[nodiscard]] Body with_redundant_rows(Body body, Random& random);
// Each facet becomes several that differ by an angle of about `tilt`.
[[nodiscard]] Body with_split_facets(Body body, Random& random, double tilt);
// Multiplies each row by a factor of its own.
[[nodiscard]] Body with_scaled_rows(Body body, Random& random);

[[nodiscard]] Body scaled(Body body, double factor);
[[nodiscard]] Body shifted(Body body, const Vec3& offset);
[[nodiscard]] Body rotated(Body body, const Eigen::Quaterniond& rotation);

// The largest coordinate that the body reaches along the axes of its frame, radius included;
// directions in which it does not end are left out.
[[nodiscard]] double extent(const Body& body);

}  // namespace clearance::hard
