// Convex bodies that are hard for floating point: slivers, plates, many facets at one vertex,
// repeated and almost equal half-spaces, and unbounded bodies. Their size is about one, around the
// origin of their frame.
#pragma once

#include "tests/shared/exact_body.hpp"
#include "tests/shared/random.hpp"

namespace clearance::hard {

using oracle::Body;

[[nodiscard]] Body box(const Vec3& half_extents);
// Facets in random directions, tangent to spheres of radius 0.5 to 1 around the origin. The body is
// bounded.
[[nodiscard]] Body random_polytope(Random& random, int facets);
// The hull of random points on a sphere or in a box.
[[nodiscard]] Body random_hull(Random& random, int points);
// Facets distributed evenly over the unit sphere as in §3.5: `order` rings from pole to pole, 2 *
// order facets at the equator. Numbers of facets: 6, 22, 46, 82, 128, 288, 510, 1148, 2042 for
// orders 2, 4, 6, 8, 10, 15, 20, 30, 40. These are half of the thesis's N1 + N2.
[[nodiscard]] Body facet_ball(int order);
// The hull of the normals of facet_ball(order), which is its polar dual.
[[nodiscard]] Body dual_ball(int order);
// A pyramid with its tip at (0, 0, height), where `sides` facets meet.
[[nodiscard]] Body cone(int sides, double half_angle, double height);
// A blade along y with its edge at x = 0. The edge points towards +x and has the given opening
// angle.
[[nodiscard]] Body wedge(double angle, double half_length);
// A long thin prism along z whose length is `aspect` times its width.
[[nodiscard]] Body needle(Random& random, double aspect);
// A tetrahedron whose four vertices lie within `flatness` of a plane.
[[nodiscard]] Body sliver(Random& random, double flatness);
[[nodiscard]] Body plate(Random& random, double thickness);
// A plate with half-round ends of `sides` narrow facets each, like a robot link.
[[nodiscard]] Body link(int sides, double length, double thickness);
// A body with integer vertices, which give exact ties.
[[nodiscard]] Body lattice(Random& random);
// An unbounded corner, slab, wedge, prism, cone or half-space.
[[nodiscard]] Body unbounded(Random& random);
// A point or a segment with a radius.
[[nodiscard]] Body rounded(Random& random);
// Any bounded body of the above kinds.
[[nodiscard]] Body any_bounded(Random& random);

// The same body with repeated or almost equal half-spaces. Only for bodies given by rows.
[[nodiscard]] Body with_duplicate_rows(Body body, Random& random);
// Adds rows that touch the body in one vertex up to rounding, or that do not touch it.
[[nodiscard]] Body with_redundant_rows(Body body, Random& random);
// Replaces each facet by several whose normals differ by an angle of about `tilt`.
[[nodiscard]] Body with_split_facets(Body body, Random& random, double tilt);
// Multiplies each row by an individual factor.
[[nodiscard]] Body with_scaled_rows(Body body, Random& random);

[[nodiscard]] Body scaled(Body body, double factor);
[[nodiscard]] Body shifted(Body body, const Vec3& offset);
[[nodiscard]] Body rotated(Body body, const Eigen::Quaterniond& rotation);

// The largest coordinate of the body along the axes of its frame, with the radius. Directions in
// which the body is unbounded are left out.
[[nodiscard]] double extent(const Body& body);

}  // namespace clearance::hard
