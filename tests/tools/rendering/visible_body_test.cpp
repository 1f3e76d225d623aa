// Rays meet bodies where core's distance is zero, and first there; they miss where it is not.
//
// Oracle: the certified distance of a point of the ray to the body. It is a convex function along
// the ray, so that one that is positive shortly before a point is positive everywhere before it.
#include "tools/rendering/visible_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::rendering {
namespace {

struct Named {
  std::string name;
  ConvexBody body;
};

std::vector<Named> bodies() {
  Random random(7);
  std::vector<Vec3> cloud;
  for (int i = 0; i < 40; ++i) cloud.push_back(random.in_box(0.3));
  std::vector<Named> all;
  const auto add = [&](const char* name, ShapeResult result) {
    all.push_back({name, test::made(std::move(result))});
  };
  add("sphere", point({0.1, 0.0, 0.05}, 0.3));
  add("capsule", segment({0, 0, -0.3}, {0.1, 0.2, 0.4}, 0.12));
  add("box", box({0.2, 0.3, 0.1}));
  add("hull", polyhedron_from_vertices(cloud));
  add("wedge",
      polyhedron_from_halfspaces(std::vector<HalfSpace>{{{0, 0, 1}, 0.1}, {{0.5, 0.0, -1}, 0.2}}));
  add("half-space", polyhedron_from_halfspaces(std::vector<HalfSpace>{{{0.1, 0.2, 1}, -0.2}}));
  add("cylinder", cylinder(0.2, 0.35));
  add("cone", cone(0.3, 0.2));
  add("truncated cone", truncated_cone(0.1, 0.35, 0.25));
  add("ellipsoid", ellipsoid({0.1, 0.25, 0.4}));
  add("rounded box", rounded_by(0.08, test::made(box({0.2, 0.1, 0.15}))));
  add("rounded hull", rounded_by(0.05, test::made(polyhedron_from_vertices(cloud))));
  add("rounded cylinder", cylinder(0.2, 0.3, 0.05));
  add("rounded ellipsoid", ellipsoid({0.2, 0.1, 0.3}, 0.04));
  add("rounded half-space",
      rounded_by(
          0.1, test::made(polyhedron_from_halfspaces(std::vector<HalfSpace>{{{0, 0, 1}, -0.2}}))));
  return all;
}

double distance_at(const ConvexBody& body, const Pose& camera_from_body, const Vec3& at) {
  static const ConvexBody kPoint = test::made(point(Vec3::Zero(), 0.0));
  return test::cold(body, kPoint, relative_pose(camera_from_body, {at, {1, 0, 0, 0}})).distance;
}

// The least distance along the ray, up to t = 40.
double least_along(const ConvexBody& body, const Pose& pose, const Vec3& direction) {
  double low = 0.0, high = 40.0;
  for (int i = 0; i < 90; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    const bool falls =
        distance_at(body, pose, a * direction) > distance_at(body, pose, b * direction);
    (falls ? low : high) = falls ? a : b;
  }
  return distance_at(body, pose, low * direction);
}

TEST(VisibleBody, IsMetWhereTheDistanceIsFirstZeroAndMissedWhereItIsNowhere) {
  Random random(1);
  for (const Named& each : bodies()) {
    SCOPED_TRACE(each.name);
    int hits = 0, misses = 0;
    for (int i = 0; i < 150; ++i) {
      const Pose pose = random.pose(1.2);
      if (distance_at(each.body, pose, Vec3::Zero()) < 1e-6) continue;
      const VisibleBody body(each.body, pose);
      // Half of the rays lead near to the body.
      const Vec3 aim = i % 2 == 0 ? Vec3(pose.position + random.in_box(0.4)) : random.direction();
      const Vec3 direction = aim * random.log_uniform(0.1, 10.0);
      const double t = body.first_hit(direction);
      if (std::isfinite(t)) {
        ++hits;
        const double step = 1e-6 / direction.norm();
        EXPECT_NEAR(distance_at(each.body, pose, t * direction), 0.0, 2e-9);
        EXPECT_GT(distance_at(each.body, pose, (t - step) * direction), 0.0);
      } else {
        ++misses;
        EXPECT_GT(least_along(each.body, pose, direction), -1e-8);
      }
    }
    EXPECT_GT(hits, 15);
    EXPECT_GT(misses, 15);
  }
}

TEST(VisibleBody, IsMetAtZeroFromWithin) {
  Random random(2);
  for (const Named& each : bodies()) {
    SCOPED_TRACE(each.name);
    Pose pose = random.pose(0.0);
    pose.position = -(pose.orientation * (each.body.interior));
    EXPECT_EQ(VisibleBody(each.body, pose).first_hit(random.direction()), 0.0);
  }
}

TEST(VisibleBody, HasARangeThatContainsEveryRayThatMeetsIt) {
  Random random(3);
  int bounded = 0;
  for (const Named& each : bodies()) {
    SCOPED_TRACE(each.name);
    for (int i = 0; i < 200; ++i) {
      Pose pose = random.pose(1.0);
      pose.position.z() += 1.0;
      const VisibleBody body(each.body, pose);
      const ViewRange range = body.range();
      bounded += std::isfinite(range.left) && !range.is_empty();
      const Vec3 direction(random.uniform(-2, 2), random.uniform(-2, 2), 1.0);
      if (!std::isfinite(body.first_hit(direction))) continue;
      EXPECT_GE(direction.x(), range.left - 1e-12);
      EXPECT_LE(direction.x(), range.right + 1e-12);
      EXPECT_GE(direction.y(), range.top - 1e-12);
      EXPECT_LE(direction.y(), range.bottom + 1e-12);
    }
  }
  EXPECT_GT(bounded, 1000);
}

}  // namespace
}  // namespace clearance::rendering
