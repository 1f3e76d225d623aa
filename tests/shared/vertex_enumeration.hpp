// Enumerates vertices, extreme rays and facets of an intersection of half-spaces by trying every
// triple and pair of rows.
//
// This is an oracle for core/shapes.hpp. It shares no code or idea with it, and is too slow for
// more than about 30 rows.
#pragma once

#include <set>
#include <span>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

struct Enumeration {
  std::set<RationalVec> vertices;
  std::set<IntegerVec> rays;              // primitive integer vectors
  std::set<std::vector<Integer>> facets;  // the primitive (n, d) of each half-space with a facet
};

// The rows must have a common interior and at least one vertex.
[[nodiscard]] Enumeration enumerate(std::span<const HalfSpace> rows);

// The half-spaces with a facet of the hull of points, and the points that are its vertices. The
// points must not lie in one plane, and there should be at most about 20.
struct HullEnumeration {
  std::set<std::vector<Integer>> facets;
  std::set<RationalVec> vertices;
};
[[nodiscard]] HullEnumeration enumerate_hull(std::span<const Vec3> points);

// Returns true if no other double is nearer to `exact` than `rounded`.
[[nodiscard]] bool is_nearest(double rounded, const Rational& exact);
[[nodiscard]] bool is_nearest(const Vec3& rounded, const RationalVec& exact);

}  // namespace clearance::oracle
