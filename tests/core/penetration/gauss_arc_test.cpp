// Depths of bodies with many vertices that lie deep in each other. Thousands of directions need
// translations almost as short as the shortest. Oracle: every facet's normal and every pair of
// edges, evaluated at every vertex in plain doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "core/penetration/gauss_arc.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using test::cold;
using test::made;

// The translation of B along n after which it is clear of A. The vertices are in one frame.
double depth_along(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Vec3& n) {
  double top = -kInfinity, bottom = kInfinity;
  for (const Vec3& p : a) top = std::max(top, p.dot(n));
  for (const Vec3& p : b) bottom = std::min(bottom, p.dot(n));
  return top - bottom;
}

double depth_by_trying_all(const ConvexBody& a, const ConvexBody& b, const RelativePose& pose) {
  std::vector<Vec3> placed;
  for (const Vec3& p : b.anchors) placed.push_back(pose.rotation * p + pose.translation);
  double least = kInfinity;
  const auto look = [&](const Vec3& n) {
    least = std::min(least, depth_along(a.anchors, placed, n.normalized()));
  };
  for (const Facet& facet : a.facets) look(facet.normal);
  for (const Facet& facet : b.facets) look(-(pose.rotation * facet.normal));
  for (const Edge& e : a.edges) {
    for (const Edge& f : b.edges) {
      const Vec3 across = e.direction.cross(pose.rotation * f.direction);
      if (across.norm() < 1e-9) continue;
      look(across);
      look(-across);
    }
  }
  return least;
}

void expect_depth_of_all(const DistanceResult& r, double depth) {
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
  EXPECT_LE(r.lower, -depth + 1e-14);
  EXPECT_GE(r.upper, -depth - 1e-14);
  EXPECT_LE(r.upper - r.lower, 5e-14);
}

struct TurnedPair {
  ConvexBody a, b;
};

// Balls of facets and balls of vertices, of equal size or with a small one inside the other. The
// other pairs are hulls of scattered points, and a body with few vertices against one with many.
std::vector<TurnedPair> pairs_of_many_corners(Random& random) {
  const ConvexBody ball = made(hard::facet_ball(6)), dual = made(hard::dual_ball(6));
  const ConvexBody small = made(hard::scaled(hard::facet_ball(6), 0.4));
  const ConvexBody rough = made(hard::random_hull(random, 60));
  return {{ball, ball},  {dual, ball},  {dual, dual},   {ball, small},
          {small, dual}, {rough, ball}, {rough, rough}, {ball, test::cube()}};
}

TEST(DeepOverlap, HasNoShorterPathOutThanAllThatThereAre) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    for (const auto& [a, b] : pairs_of_many_corners(random)) {
      for (const double apart : {0.0, 1e-12, 1e-6, 1e-3, 0.03, 0.3}) {
        const Pose pose_b{apart * random.direction(), random.rotation()};
        const RelativePose pose = relative_pose(Pose{}, pose_b);
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(a.facets.size()) +
                     " and " + std::to_string(b.facets.size()) + " facets, apart by " +
                     std::to_string(apart));
        expect_depth_of_all(cold(a, b, pose), depth_by_trying_all(a, b, pose));
      }
    }
  }
}

TEST(DeepOverlap, IsAsDeepTrackedAsItIs) {
  Random random(7);
  for (const auto& [a, b] : pairs_of_many_corners(random)) {
    TrackingState state;
    const Vec3 direction = random.direction();
    for (int k = -6; k <= 6; ++k) {
      const Pose pose_b{0.01 * k * direction,
                        Eigen::Quaterniond(Eigen::AngleAxisd(0.02 * k, direction))};
      const RelativePose pose = relative_pose(Pose{}, pose_b);
      expect_depth_of_all(distance(a, b, pose, state), depth_by_trying_all(a, b, pose));
    }
  }
}

TEST(DeepOverlap, OfBodiesOfThousandsOfFacetsIsThatOfTheSwappedPair) {
  const ConvexBody ball = made(hard::facet_ball(24)), dual = made(hard::dual_ball(30));
  Random random(11);
  for (const double apart : {0.0, 1e-3, 0.1, 1.0}) {
    const Pose pose_b{apart * random.direction(), random.rotation()};
    const DistanceResult r = cold(ball, dual, relative_pose(Pose{}, pose_b));
    const DistanceResult s = cold(dual, ball, relative_pose(pose_b, Pose{}));
    EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
    EXPECT_LE(r.upper - r.lower, 5e-14);
    EXPECT_LE(s.upper - s.lower, 5e-14);
    EXPECT_LE(r.lower, s.upper);
    EXPECT_LE(s.lower, r.upper);
  }
}

// An almost flat plate, and a pillar that stands through its plane.
struct PlateAndPillar {
  int rim;  // number of vertices
  ConvexBody plate, pillar;

  PlateAndPillar(int corners_of_rim, int sides, double thickness) : rim(corners_of_rim) {
    std::vector<Vec3> corners = {{0.0, 0.0, thickness}, {0.0, 0.0, -thickness}};
    for (int i = 0; i < rim; ++i) corners.push_back(of_rim(i));
    plate = made(polyhedron_from_vertices(corners));
    corners.clear();
    for (int i = 0; i < sides; ++i) {
      const Vec3 at = on_circle(1.0 * i / sides);
      corners.push_back({at.x(), at.y(), 1.25});
      corners.push_back({at.x(), at.y(), -1.25});
    }
    pillar = made(polyhedron_from_vertices(corners));
  }
  // The coordinates have so few digits that opposite facets of the plate have the same ones.
  static Vec3 on_circle(double part) {
    const double angle = 2.0 * std::numbers::pi * part;
    return {0x1p-20 * std::round(0x1p20 * std::cos(angle)),
            0x1p-20 * std::round(0x1p20 * std::sin(angle)), 0.0};
  }
  [[nodiscard]] Vec3 of_rim(int i) const { return on_circle((i + 0.5) / rim); }
  // The shortest translation that moves the pillar past an edge of the rim.
  [[nodiscard]] double path_past_the_rim(const RelativePose& pose) const {
    std::vector<Vec3> placed;
    for (const Vec3& p : pillar.anchors) placed.push_back(pose.rotation * p + pose.translation);
    double least = kInfinity;
    for (int i = 0; i < rim; ++i) {
      const Vec3 out = (of_rim(i + 1) - of_rim(i)).cross(Vec3::UnitZ()).normalized();
      least = std::min(least, depth_along(plate.anchors, placed, out));
    }
    return least;
  }
};

// At an edge of the rim, rounding cannot always tell that the pillar's centre is outside both
// facets, although it is far outside the edge. For plates of 1e-16 m and less, depths were once up
// to 6 mm too large.
TEST(DeepOverlap, WithAPlateAllButFlatIsNoDeeperThanThePathPastItsRim) {
  Random random(2);
  for (int k = 0; k < 32; ++k) {
    const PlateAndPillar pair(20 + 2 * k, 120 + k, std::ldexp(1.0, -24 - k % 15));
    for (int i = 0; i < 20; ++i) {
      const Vec3 beside = random.uniform(1.0, 1.9) * PlateAndPillar::on_circle(random.unit());
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(i % 2 * random.unit(), Vec3::UnitZ()));
      const RelativePose pose = relative_pose(Pose{}, {beside, turn});
      const DistanceResult r = cold(pair.plate, pair.pillar, pose);
      EXPECT_LE(-r.upper, pair.path_past_the_rim(pose) + 1e-14) << "plate " << k << ", pose " << i;
    }
  }
}

// Two unit directions at an angle of less than half a turn, points, and a ball.
struct ArcCase {
  Vec3 l, r, first, last, middle;
  double radius;
};

ArcCase random_arc(Random& random) {
  const Vec3 l = random.direction();
  const Vec3 r = (l + random.log_uniform(1e-3, 3.0) * random.direction()).normalized();
  return {l,
          r,
          l + random.in_box(0.3),
          r + random.in_box(0.3),
          random.in_box(0.2) + 0.5 * (l + r),
          random.uniform(0.0, 0.6)};
}

TEST(ArcBounds, AreNoHigherThanWhatIsKnownAnywhereOnTheArc) {
  Random random(5);
  int useful = 0;
  for (int k = 0; k < 20000; ++k) {
    const ArcCase c = random_arc(random);
    const auto on = [&](const Vec3& p) { return OnArc{p.dot(c.l), p.dot(c.r)}; };
    const double apart = (c.l - c.r).squaredNorm(), enough = random.uniform(0.5, 1.2);
    const double two = least_of_two(on(c.first), on(c.last));
    const double three =
        least_with_sphere(on(c.first), on(c.middle), c.radius, on(c.last), apart, enough);
    double least_two = kInfinity, least_three = kInfinity;
    for (int i = 0; i <= 200; ++i) {
      const Vec3 n = (c.l + i / 200.0 * (c.r - c.l)).normalized();
      const double points = std::max(c.first.dot(n), c.last.dot(n));
      least_two = std::min(least_two, points);
      least_three = std::min(least_three, std::max(points, c.middle.dot(n) + c.radius));
    }
    ASSERT_TRUE(two <= 0.0 || two <= least_two + 1e-15) << k;
    ASSERT_TRUE(three <= 0.0 || three <= least_three + 1e-15) << k;
    useful += three > two;
  }
  EXPECT_GT(useful, 1000);
}

}  // namespace
}  // namespace clearance
