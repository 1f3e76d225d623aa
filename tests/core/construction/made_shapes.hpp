// Shapes that are made or refused, compared with an exact enumeration of all triples of rows or
// points.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/polyhedron_invariants.hpp"
#include "tests/shared/vertex_enumeration.hpp"

namespace clearance::test {

inline std::string refusal(const ShapeResult& result) {
  const ShapeError* error = std::get_if<ShapeError>(&result);
  return error == nullptr ? "accepted" : error->reason;
}

inline std::vector<HalfSpace> box_rows(const Vec3& low, const Vec3& high) {
  return {{{1, 0, 0}, high.x()},  {{0, 1, 0}, high.y()},  {{0, 0, 1}, high.z()},
          {{-1, 0, 0}, -low.x()}, {{0, -1, 0}, -low.y()}, {{0, 0, -1}, -low.z()}};
}

inline bool points_along(const Vec3& direction, const oracle::IntegerVec& ray, bool exact) {
  if (exact) {
    const oracle::IntegerVec found = oracle::primitive(oracle::exact(direction));
    return found == ray;
  }
  const Vec3 wanted(ray[0].get_d(), ray[1].get_d(), ray[2].get_d());
  return (direction - wanted.normalized()).norm() <= 0x1p-51;
}

using oracle::Rational;

// The function x |x| increases with x, and turns square roots into fractions.
inline Rational signed_square(const Rational& x) { return x * abs(x); }

// Returns true if the square root of |square|, with the sign of `square`, is within `error` of
// `rounded`.
inline bool is_root_within(double rounded, double error, const Rational& square) {
  return signed_square(Rational(rounded) - Rational(error)) <= square &&
         square <= signed_square(Rational(rounded) + Rational(error));
}

inline Rational squared_distance(const oracle::RationalVec& a, const oracle::RationalVec& b) {
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// position_error bounds the rounding of vertices, offsets and edge ends.
inline void expect_error_is_bounded(const ConvexBody& body, const oracle::Enumeration& truth) {
  const Rational allowed = Rational(body.position_error) * Rational(body.position_error);
  std::vector<oracle::RationalVec> exact;
  for (const Vertex& vertex : body.vertices) {
    for (const oracle::RationalVec& candidate : truth.vertices) {
      if (!oracle::is_nearest(vertex.position, candidate)) continue;
      EXPECT_LE(squared_distance(oracle::exact(vertex.position), candidate), allowed);
      exact.push_back(candidate);
    }
  }
  for (const Facet& facet : body.facets) {
    EXPECT_TRUE(std::any_of(truth.facets.begin(), truth.facets.end(), [&](const auto& plane) {
      const oracle::IntegerVec normal = {plane[0], plane[1], plane[2]};
      Rational square(plane[3] * abs(plane[3]),
                      normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
      square.canonicalize();
      return points_along(facet.normal, normal, false) &&
             is_root_within(facet.offset, body.position_error, square);
    })) << "no half-space has a facet's normal and offset";
  }
  if (exact.size() != body.vertices.size()) return;  // two vertices round to one point
  for (const Edge& edge : body.edges) {
    if (edge.vertex[1] == kNone) continue;
    const Rational square = squared_distance(exact[static_cast<std::size_t>(edge.vertex[0])],
                                             exact[static_cast<std::size_t>(edge.vertex[1])]);
    EXPECT_TRUE(is_root_within(edge.end, body.position_error, square));
  }
}

// The body has the same vertices (each rounded once), the same rays and the same number of facets.
inline void expect_as_enumerated(const ConvexBody& body, std::span<const HalfSpace> rows) {
  const oracle::Enumeration truth = oracle::enumerate(rows);
  EXPECT_EQ(body.vertices.size(), truth.vertices.size());
  EXPECT_EQ(body.rays.size(), truth.rays.size());
  EXPECT_EQ(body.facets.size(), truth.facets.size());
  for (const oracle::RationalVec& vertex : truth.vertices) {
    EXPECT_TRUE(
        std::any_of(body.vertices.begin(), body.vertices.end(),
                    [&](const Vertex& v) { return oracle::is_nearest(v.position, vertex); }))
        << "no vertex near " << vertex[0].get_d() << ' ' << vertex[1].get_d() << ' '
        << vertex[2].get_d();
  }
  for (const oracle::IntegerVec& ray : truth.rays) {
    EXPECT_TRUE(std::any_of(body.rays.begin(), body.rays.end(),
                            [&](const Ray& r) { return points_along(r.direction, ray, r.exact); }));
  }
  expect_error_is_bounded(body, truth);
  EXPECT_THAT(broken_invariants(body), ::testing::IsEmpty());
}

}  // namespace clearance::test
