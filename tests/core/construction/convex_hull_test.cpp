// Oracle: exact determinants of the points themselves.
#include "core/construction/convex_hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "tests/shared/random.hpp"

namespace clearance::exact {
namespace {

std::vector<Integer4> homogeneous(const std::vector<Vec3>& points) {
  std::vector<Integer4> result;
  for (const Vec3& p : points) result.push_back(integer_multiple({p.x(), p.y(), p.z(), 1.0}));
  return result;
}

// Every point is below every face, and every vertex of a face is a point. Edges come in pairs, and
// Euler's formula holds.
void expect_hull(const std::vector<Integer4>& points) {
  const PointSet set(points);
  const std::vector<HullFace> faces = hull_faces(set, convex_hull(set));
  ASSERT_FALSE(faces.empty());
  std::set<int> vertices;
  std::set<std::pair<int, int>> edges;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const HullFace& face = faces[f];
    ASSERT_GE(face.vertex.size(), 3U);
    ASSERT_EQ(face.vertex.size(), face.neighbor.size());
    for (const Integer4& point : points) EXPECT_LE(sgn(dot(face.plane, point)), 0);
    for (std::size_t i = 0; i < face.vertex.size(); ++i) {
      const int from = face.vertex[i];
      const int to = face.vertex[(i + 1) % face.vertex.size()];
      EXPECT_EQ(sgn(dot(face.plane, points[static_cast<std::size_t>(from)])), 0);
      vertices.insert(from);
      EXPECT_TRUE(edges.insert({from, to}).second) << "an edge runs twice the same way";
      const HullFace& other = faces[static_cast<std::size_t>(face.neighbor[i])];
      bool found = false;
      for (std::size_t j = 0; j < other.vertex.size(); ++j) {
        found = found ||
                (other.vertex[j] == to && other.vertex[(j + 1) % other.vertex.size()] == from &&
                 other.neighbor[j] == static_cast<int>(f));
      }
      EXPECT_TRUE(found) << "the neighbour does not share the edge";
      // Some vertex is strictly below the neighbouring face: coplanar faces have been merged.
      EXPECT_TRUE(std::any_of(face.vertex.begin(), face.vertex.end(), [&](int vertex) {
        return sgn(dot(other.plane, points[static_cast<std::size_t>(vertex)])) < 0;
      }));
    }
  }
  EXPECT_EQ(vertices.size() + faces.size(), edges.size() / 2 + 2);
}

TEST(ExactHull, LatticeClustersWithTiesEverywhere) {
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int size = random.integer(1, 5);
    for (int i = 0; i < 60; ++i) {
      points.emplace_back(random.integer(0, size), random.integer(0, size),
                          random.integer(0, size));
    }
    expect_hull(homogeneous(points));
    if (HasFailure()) FAIL() << "round " << round;
  }
}

TEST(ExactHull, PointsOnASphereAreAllCorners) {
  Random random(5);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) points.push_back(random.direction());
  expect_hull(homogeneous(points));
}

TEST(ExactHull, PointsOfVeryDifferentWeightsNeedNoScaling) {
  Random random(9);
  std::vector<Integer4> points = {{0, 0, 0, 1}};
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = random.direction();
    points.push_back(integer_multiple({p.x(), p.y(), p.z(), random.log_uniform(1e-300, 1e300)}));
  }
  expect_hull(points);
}

TEST(ExactHull, PointsInOnePlaneHaveNone) {
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i) points.emplace_back(i % 5, i / 5, 2 * (i % 5) - 3 * (i / 5));
  EXPECT_TRUE(convex_hull(PointSet(homogeneous(points))).empty());
  EXPECT_TRUE(convex_hull(PointSet(homogeneous({}))).empty());
  EXPECT_TRUE(convex_hull(PointSet(homogeneous({{1, 2, 3}}))).empty());
  points.emplace_back(0.0, 0.0, 0x1p-1000);
  const std::vector<Integer4> lifted = homogeneous(points);
  EXPECT_FALSE(convex_hull(PointSet(lifted)).empty());
}

TEST(ExactHull, GridOnACubeLeavesSixFacesOfFourCorners) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      for (const double s : {0.0, 0.8}) {
        points.emplace_back(0.1 * i, 0.1 * j, s);
        points.emplace_back(0.1 * i, s, 0.1 * j);
        points.emplace_back(s, 0.1 * i, 0.1 * j);
      }
    }
  }
  const std::vector<Integer4> exact = homogeneous(points);
  const PointSet set(exact);
  const std::vector<HullFace> faces = hull_faces(set, convex_hull(set));
  EXPECT_EQ(faces.size(), 6U);
  for (const HullFace& face : faces) EXPECT_EQ(face.vertex.size(), 4U);
}

TEST(FilteredPlane, AgreesWithTheExactDeterminantNextToThePlane) {
  Random random(15);
  int on_plane = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<Vec3> p = {random.in_box(1), random.in_box(1), random.in_box(1)};
    if (round % 3 == 0) {
      for (Vec3& v : p) v = (v * 8.0).array().round().matrix();
    }
    const double s = 0.25 * random.integer(-4, 4);
    Vec3 q = p[0] + s * (p[1] - p[0]) + (0.5 - s) * (p[2] - p[0]);
    q[round % 2] += 0x1p-53 * random.integer(-2, 2);
    p.push_back(q);
    const std::vector<Integer4> exact = homogeneous(p);
    const PointSet set(exact);
    FilteredPlane plane(set, {0, 1, 2});
    const int expected = sgn(dot(plane_through(exact[0], exact[1], exact[2]), exact[3]));
    EXPECT_EQ(plane.side(set, 3), expected);
    on_plane += expected == 0 ? 1 : 0;
  }
  EXPECT_GT(on_plane, 100);
}

}  // namespace
}  // namespace clearance::exact
