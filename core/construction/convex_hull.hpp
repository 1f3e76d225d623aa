// The convex hull of homogeneous points, with exact decisions.
//
// Randomised incremental construction (Clarkson and Shor 1989) over triangles. Each point that is
// still outside remembers one triangle that it sees (Barber, Dobkin and Huhdanpaa 1996). Points in
// a triangle's plane do not see it, so degenerate input (coplanar, collinear, repeated) needs no
// perturbation. The expected time is O(n log n). Afterwards coplanar triangles become faces, and
// points within a face or a straight edge are dropped.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/construction/integer_vector.hpp"
#include "core/construction/orientation_predicate.hpp"

namespace clearance::exact {

struct HullTriangle {
  std::array<int, 3> vertex;    // counter-clockwise as seen from outside
  std::array<int, 3> neighbor;  // the triangle across vertex[i] -> vertex[(i + 1) % 3]
};

// The boundary of the hull, triangulated. Empty when all points lie in one plane. The same input
// gives the same triangles.
[[nodiscard]] std::vector<HullTriangle> convex_hull(const PointSet& points);

// A face of the hull and its true vertices, counter-clockwise as seen from outside.
struct HullFace {
  Integer4 plane;             // plane_through() of vertices: h.p <= 0 for every point p of the hull
  std::vector<int> vertex;    // at least three; each belongs to three faces or more
  std::vector<int> neighbor;  // the face across vertex[i] -> vertex[i + 1]
};

[[nodiscard]] std::vector<HullFace> hull_faces(const PointSet& points,
                                               std::span<const HullTriangle> triangles);

}  // namespace clearance::exact
