// Oracles: points of every triangle compared with every part's half-spaces. In the other direction,
// the distance of points on the parts' surface from every triangle, without a tree, by regions (C.
// Ericson, Real-Time Collision Detection, 5.1.5).
#include "config/decomposition/convex_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include "config/decomposition/surface_error.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

struct Drawn {
  std::string name;
  TriangleMesh mesh;
  std::size_t most_parts;  // parts expected within the tolerance
  double tolerance = 5e-3;
};
std::ostream& operator<<(std::ostream& out, const Drawn& drawn) { return out << drawn.name; }

class ConvexPartsOf : public testing::TestWithParam<Drawn> {};

ConvexParts parts_of_mesh(const TriangleMesh& mesh, const PartLimits& limits = {}) {
  return std::get<ConvexParts>(convex_parts(mesh, limits));
}

// The parts are made once, for all tests.
const ConvexParts& parts_of(const Drawn& drawn, std::size_t most = 24) {
  static std::map<std::pair<std::string, std::size_t>, ConvexParts> made;
  const auto [entry, is_new] = made.try_emplace({drawn.name, most});
  if (is_new)
    entry->second = parts_of_mesh(drawn.mesh, {.tolerance = drawn.tolerance, .max_parts = most});
  return entry->second;
}

std::vector<ConvexBody> bodies_of_parts(const ConvexParts& parts) {
  std::vector<ConvexBody> bodies;
  for (const auto& part : parts.parts) bodies.push_back(test::made(polyhedron_from_vertices(part)));
  return bodies;
}

// Returns the distance of a point outside the body; negative if it is inside.
double outside(const ConvexBody& body, const Vec3& point) {
  double most = -kInfinity;
  for (const Facet& facet : body.facets) {
    most = std::max(most, facet.normal.dot(point) - facet.offset);
  }
  return most;
}

Vec3 random_point(const Triangle& t, Random& random) {
  double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

double distance_by_regions(const Triangle& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0];
  const double d1 = ab.dot(p - t[0]), d2 = ac.dot(p - t[0]);
  if (d1 <= 0.0 && d2 <= 0.0) return (p - t[0]).norm();
  const double d3 = ab.dot(p - t[1]), d4 = ac.dot(p - t[1]);
  if (d3 >= 0.0 && d4 <= d3) return (p - t[1]).norm();
  const double d5 = ab.dot(p - t[2]), d6 = ac.dot(p - t[2]);
  if (d6 >= 0.0 && d5 <= d6) return (p - t[2]).norm();
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (p - t[0] - d1 / (d1 - d3) * ab).norm();
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (p - t[0] - d2 / (d2 - d6) * ac).norm();
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return (p - t[1] - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1])).norm();
  }
  return (p - t[0] - vb / (va + vb + vc) * ab - vc / (va + vb + vc) * ac).norm();
}

// Returns the largest distance from the mesh over sampled points on the surface of the union.
double sampled_error(const std::vector<ConvexBody>& bodies, const TriangleMesh& mesh, int samples) {
  Random random(7);
  double worst = 0.0;
  for (const ConvexBody& body : bodies) {
    for (const Facet& facet : body.facets) {
      const auto corner = [&](std::int32_t side) {
        const EdgeUse use = body.facet_edges[static_cast<std::size_t>(facet.first_side + side)];
        const Edge& edge = body.edges[static_cast<std::size_t>(use.edge)];
        return body.vertices[static_cast<std::size_t>(edge.vertex[use.side])].position;
      };
      for (int i = 0; i < samples; ++i) {
        const std::int32_t side = 1 + i % (facet.sides - 2);
        const Vec3 point = random_point({corner(0), corner(side), corner(side + 1)}, random);
        const bool covered = std::ranges::any_of(bodies, [&](const ConvexBody& other) {
          return &other != &body && outside(other, point) < 0.0;
        });
        if (covered) continue;
        double nearest = kInfinity;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
          const Triangle triangle = mesh.triangle(t);
          const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
          // a degenerate triangle: its points belong to its neighbours
          if (normal.norm() == 0.0) continue;
          nearest = std::min(nearest, distance_by_regions(triangle, point));
        }
        worst = std::max(worst, nearest);
      }
    }
  }
  return worst;
}

TEST_P(ConvexPartsOf, HoldEveryPointOfEveryTriangle) {
  const TriangleMesh& mesh = GetParam().mesh;
  const std::vector<ConvexBody> bodies = bodies_of_parts(parts_of(GetParam()));
  Random random(3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 60; ++i) {
      const Triangle triangle = mesh.triangle(t);
      const Vec3 point =
          i < 3 ? triangle[static_cast<std::size_t>(i)] : random_point(triangle, random);
      double least = kInfinity;
      for (const ConvexBody& body : bodies) least = std::min(least, outside(body, point));
      ASSERT_LE(least, 1e-15) << "triangle " << t;
    }
  }
}

TEST_P(ConvexPartsOf, AreWithinTheToleranceAndFew) {
  const ConvexParts parts = parts_of(GetParam());
  EXPECT_LE(parts.error, GetParam().tolerance);
  EXPECT_LE(parts.parts.size(), GetParam().most_parts);
}

TEST_P(ConvexPartsOf, AreNowhereFartherFromTheMeshThanTheirError) {
  for (const std::size_t most : {1, 24}) {
    const ConvexParts parts = parts_of(GetParam(), most);
    EXPECT_LE(parts.parts.size(), most);
    const double sampled = sampled_error(bodies_of_parts(parts), GetParam().mesh, 40);
    EXPECT_LE(sampled, parts.error) << most;
    EXPECT_GE(sampled, 0.5 * parts.error - 1e-6) << most;  // the bound is not much too large either
  }
}

INSTANTIATE_TEST_SUITE_P(
    Drawn, ConvexPartsOf,
    testing::Values(Drawn{"L", drawn::l_shape(), 2}, Drawn{"Torus", drawn::torus(), 12},
                    Drawn{"OpenBox", drawn::open_box(), 5}, Drawn{"Crate", drawn::crate(), 5},
                    Drawn{"CrateOfSolids", drawn::crate_of_solids(), 5},
                    Drawn{"Bracket", drawn::bracket(), 3}, Drawn{"Cup", drawn::cup(), 24},
                    Drawn{"NestedBoxes", drawn::nested_boxes(), 1},
                    Drawn{"DegenerateL", drawn::degenerate_l(), 2},
                    Drawn{"Slivers", drawn::slivers(), 6}),
    [](const auto& tested) { return tested.param.name; });

TEST(ConvexParts, AConvexMeshIsItsHullToTheBit) {
  const ConvexParts parts = parts_of_mesh(drawn::nested_boxes());
  EXPECT_TRUE(parts.is_hull);
  EXPECT_LE(parts.error, 1e-12);
  EXPECT_EQ(parts.parts.at(0).size(), 8u);
  for (const Vec3& v : parts.parts.at(0)) EXPECT_TRUE((v.array() == 0.0 || v.array() == 0.2).all());
}

TEST(ConvexParts, AreTheSameAtEveryStart) {
  EXPECT_EQ(parts_of_mesh(drawn::open_box()).parts, parts_of_mesh(drawn::open_box()).parts);
}

TEST(ConvexParts, OfALargerToleranceAreFewer) {
  const auto fine = parts_of_mesh(drawn::l_shape(), {.tolerance = 5e-3});
  const auto coarse = parts_of_mesh(drawn::l_shape(), {.tolerance = 0.15});
  EXPECT_LE(coarse.error, 0.15);
  EXPECT_LT(coarse.parts.size(), fine.parts.size());
}

TEST(ConvexParts, OfABoxOfFiveWallsAreTheseExactly) {
  for (const TriangleMesh& mesh :
       {drawn::crate_of_solids(), drawn::crate_of_overlapping_solids(), drawn::crate()}) {
    const ConvexParts parts = parts_of_mesh(mesh);
    EXPECT_EQ(5u, parts.parts.size());
    EXPECT_LE(parts.error, 1e-9);
    EXPECT_LE(sampled_error(bodies_of_parts(parts), mesh, 40), 1e-9);
  }
}

// Cut together with the rod, the bars would become more parts.
TEST(ConvexParts, KeepConvexShellsWholeWhereThatMakesFewer) {
  const std::array<Vec3, 4> bars = {Vec3(-0.1, -0.02, 0.1), Vec3(0.5, 0.02, 0.14),
                                    Vec3(-0.1, -0.2, 0.1), Vec3(-0.06, 0.2, 0.14)};
  const ConvexParts parts = parts_of_mesh(drawn::bent_rod_with_bars(bars));
  EXPECT_LE(parts.error, 5e-3);
  EXPECT_LE(parts.parts.size(), 7u);
  for (const std::size_t bar : {0, 2}) {
    const auto is_the_bar = [&](const std::vector<Vec3>& part) {
      return part.size() == 8 && std::ranges::all_of(part, [&](const Vec3& v) {
               return ((v.array() == bars[bar].array()) || (v.array() == bars[bar + 1].array()))
                   .all();
             });
    };
    EXPECT_EQ(1, std::ranges::count_if(parts.parts, is_the_bar)) << bar;
  }
}

TEST(ConvexParts, OfACrateAreNoWorseWhereMoreAreAllowed) {
  double before = kInfinity;
  for (const std::size_t most : {1, 4, 5, 6}) {
    const ConvexParts parts = parts_of_mesh(drawn::crate(), {.max_parts = most});
    EXPECT_LE(parts.error, before) << most;
    EXPECT_LE(parts.parts.size(), most);
    before = parts.error;
  }
}

TEST(ConvexParts, OfAFlatMeshAreAPlateOfTheStatedThickness) {
  TriangleMesh flat;
  drawn::add_quad({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, flat);
  const ConvexParts parts = parts_of_mesh(flat, {.plate = 0.002});
  ASSERT_EQ(1u, parts.parts.size());
  EXPECT_NEAR(0.001, parts.error, 1e-9);
  for (const Vec3& v : parts.parts[0]) EXPECT_NEAR(0.001, std::abs(v.z()), 1e-15);
}

// A plate that is thinner than the rounding of a file's coordinates is made once as well.
TEST(ConvexParts, OfAFlatMeshAreOnePlateHoweverThin) {
  TriangleMesh flat;
  drawn::add_quad({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, flat);
  const ConvexParts parts = parts_of_mesh(flat, {.plate = 4e-7});
  ASSERT_EQ(1u, parts.parts.size());
  EXPECT_GE(parts.error, 2e-7);
  EXPECT_LE(parts.error, 1e-6);
  for (const Vec3& v : parts.parts[0]) EXPECT_NEAR(2e-7, std::abs(v.z()), 1e-15);
}

TEST(ConvexParts, OfASolidThickerThanAPlateHoldItsInside) {
  TriangleMesh foil;
  drawn::add_box({0.0, 0.0, 0.0}, {1.0, 1.0, 9e-7}, foil);
  const ConvexParts parts = parts_of_mesh(foil, {.plate = 1e-8});
  ASSERT_EQ(1u, parts.parts.size());
  EXPECT_LE(outside(bodies_of_parts(parts)[0], {0.4, 0.3, 4.5e-7}), 0.0);
}

TEST(ConvexParts, OfAMeshOnOneLineAreNone) {
  TriangleMesh line;
  drawn::add_quad({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}, line);
  EXPECT_TRUE(std::holds_alternative<ShapeError>(convex_parts(line)));
}

}  // namespace
}  // namespace clearance
