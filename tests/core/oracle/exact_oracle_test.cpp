// The oracle itself: closed forms, bodies of every kind, and the same answers from rows and from
// vertices.
#include "tests/shared/exact_oracle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/shared/exact_depth.hpp"
#include "tests/shared/exact_features.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::at;

using oracle::Body;
using oracle::exact_distance;
using oracle::ExactDistance;

Body corners(const Body& box) {
  const Vec3 h(box.rows[0].offset, box.rows[2].offset, box.rows[4].offset);
  Body out;
  for (int k = 0; k < 8; ++k) {
    out.points.emplace_back(k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z());
  }
  return out;
}

TEST(ExactOracle, GivesTheClosedFormsOfCubes) {
  const Body cube = hard::box(Vec3::Constant(0.5));
  EXPECT_EQ(exact_distance(cube, at(0, 0, 0), cube, at(1.5, 0.25, 0)).squared, 0.25);
  EXPECT_EQ(exact_distance(cube, at(0, 0, 0), cube, at(4, 5, 1)).squared, 9 + 16);
  EXPECT_EQ(exact_distance(cube, at(0, 0, 0), cube, at(2, 3, 3)).squared, 1 + 4 + 4);
  EXPECT_TRUE(exact_distance(cube, at(0, 0, 0), cube, at(1, 1, 1)).cores_meet());
  EXPECT_TRUE(exact_distance(cube, at(0, 0, 0), cube, at(0.1, 0, 0)).cores_meet());
}

TEST(ExactOracle, TakesAQuaternionAsItsExactDirection) {
  const Body cube = hard::box(Vec3::Constant(0.5));
  const Body point{{}, {Vec3::Zero()}, 0.0};
  // A rotation by atan(3/4) * 2 about z. (4, 0, 0, 3) / 5 is exact, whatever the length of the
  // quaternion.
  const Pose turned{{0, 0, 0}, {4, 0, 0, 3}};
  // The cube's face x = 0.5 now has the normal (7, 24) / 25.
  EXPECT_EQ(exact_distance(cube, turned, point, at(7, 24, 0)).squared, 24.5 * 24.5);
}

TEST(ExactOracle, EnclosesTheSquareRootInNeighbouringDoubles) {
  const Body a{{}, {Vec3(0, 0, 0)}, 0.0};
  const Body b{{}, {Vec3(1, 1, 0)}, 0.25};
  const ExactDistance d = exact_distance(a, at(0, 0, 0), b, at(0, 0, 0));
  EXPECT_EQ(d.squared, 2);
  EXPECT_EQ(std::nextafter(d.lower, 9.0), d.upper);
  EXPECT_NEAR(d.lower, std::sqrt(2.0) - 0.25, 1e-15);
  EXPECT_GT(d.compare(d.lower), 0);
  EXPECT_LT(d.compare(d.upper), 0);
}

TEST(ExactOracle, RadiiMayGoDeeperThanZero) {
  const Body ball{{}, {Vec3::Zero()}, 1.0};
  const ExactDistance d = exact_distance(ball, at(0, 0, 0), ball, at(0.5, 0, 0));
  EXPECT_EQ(d.lower, -1.5);
  EXPECT_EQ(d.upper, -1.5);
}

TEST(ExactOracle, KnowsUnboundedBodies) {
  Body floor, ceiling, bar = hard::box(Vec3::Constant(1.0));
  floor.rows = {{Vec3(0, 0, 2), 0.0}};
  ceiling.rows = {{Vec3(0, 0, -1), -3.0}};
  bar.rows.resize(4);  // along z, without ends
  const Body cube = hard::box(Vec3::Constant(0.5));
  EXPECT_EQ(exact_distance(floor, at(0, 0, 0), ceiling, at(7, 8, 0)).squared, 9);
  EXPECT_EQ(exact_distance(floor, at(0, 0, 0), cube, at(1e6, 0, 2)).squared, 2.25);
  EXPECT_EQ(exact_distance(bar, at(0, 0, 0), cube, at(4, 0, 1e9)).squared, 6.25);
  EXPECT_TRUE(exact_distance(bar, at(0, 0, 0), floor, at(9, 9, -1e9)).cores_meet());
  // Planes that are parallel except for the last bit do meet.
  Body tilted = ceiling;
  tilted.rows[0].normal.x() = 0x1p-52;
  EXPECT_TRUE(exact_distance(floor, at(0, 0, 0), tilted, at(0, 0, 0)).cores_meet());
}

TEST(ExactOracle, RefusesABodyWithoutPoints) {
  Body empty = hard::box(Vec3::Constant(1.0));
  empty.rows[1].offset = -1.5;
  EXPECT_THROW(oracle::ExactBody{empty}, std::invalid_argument);
}

TEST(ExactOracle, RowsAndCornersOfTheSameBodyGiveTheSameNumber) {
  Random random(11);
  for (int k = 0; k < 40; ++k) {
    const Vec3 half_a = Vec3::Constant(0.1) + random.in_box(1.0).cwiseAbs();
    const Vec3 half_b = Vec3::Constant(0.1) + random.in_box(1.0).cwiseAbs();
    const Body a = hard::box(half_a), b = hard::box(half_b);
    const Pose pose_a{random.in_box(1.0), random.rotation()};
    const Pose pose_b{random.in_box(3.0), random.rotation()};
    const auto by_rows = exact_distance(a, pose_a, b, pose_b).squared;
    EXPECT_EQ(exact_distance(corners(a), pose_a, b, pose_b).squared, by_rows);
    EXPECT_EQ(exact_distance(corners(a), pose_a, corners(b), pose_b).squared, by_rows);
    EXPECT_EQ(exact_distance(b, pose_b, a, pose_a).squared, by_rows);
  }
}

// The same body with its axis along x, which makes its features not plain.
Body lying(Body body) {
  for (HalfSpace& row : body.rows)
    row.normal = Vec3(row.normal.z(), row.normal.x(), row.normal.y());
  for (Vec3& point : body.points) point = Vec3(point.z(), point.x(), point.y());
  return body;
}

// Six vertices of a ring and two tips, and the ring at two heights, both as points; and the prism
// by its sides.
std::array<Body, 3> plain_bodies(Random& random) {
  std::array<Body, 3> out;
  auto& [lens, prism, by_rows] = out;
  const double height = random.uniform(0.1, 0.5);
  const Vec3 up = height * Vec3::UnitZ();
  lens.points = {up, -0.5 * up};
  for (int k = 0; k < 6; ++k) {
    const double azimuth = 1.0 * k + random.uniform(0.0, 0.8);
    const Vec3 at(std::cos(azimuth), std::sin(azimuth), 0.0);
    lens.points.push_back(at);
    prism.points.insert(prism.points.end(), {at + up, at - up});
    by_rows.rows.push_back({at, 0.7});
  }
  by_rows.rows.push_back({Vec3::UnitZ(), height});
  by_rows.rows.push_back({-Vec3::UnitZ(), 0.3});
  return out;
}

TEST(ExactOracle, KnowsPrismsAndLensesByTheirOutlineAsByAllThatThereMayBe) {
  Random random(5);
  const Eigen::Quaterniond upright(1, -1, -1, -1);  // maps x to z
  // with small integers, so that products are exact
  const auto turn = [&] {
    const int x = random.integer(-9, 9), y = random.integer(-9, 9), z = random.integer(-9, 9);
    return Eigen::Quaterniond(1, x, y, z);
  };
  for (int k = 0; k < 4; ++k) {
    const auto bodies_a = plain_bodies(random), bodies_b = plain_bodies(random);
    for (const Body& a : bodies_a) {
      const Body& b = bodies_b[static_cast<std::size_t>(random.integer(0, 2))];
      const Pose pose_a{Vec3::Zero(), turn()}, pose_b{random.in_box(0.2), turn()};
      const Pose lying_a{pose_a.position, pose_a.orientation * upright};
      const Pose lying_b{pose_b.position, pose_b.orientation * upright};
      ASSERT_TRUE(oracle::features_are_plain(a) && !oracle::features_are_plain(lying(a)));
      const auto depth = oracle::exact_squared_depth(a, pose_a, b, pose_b);
      ASSERT_TRUE(depth.has_value());
      EXPECT_GT(*depth, 0);
      EXPECT_EQ(oracle::exact_squared_depth(lying(a), lying_a, lying(b), lying_b), depth);
    }
  }
}

TEST(HardCases, FacetBallsHaveTheThesisFacetCounts) {
  const int counts[][2] = {{2, 12},   {4, 44},    {6, 92},    {8, 164},  {10, 256},
                           {15, 576}, {20, 1020}, {30, 2296}, {40, 4084}};
  for (const auto& [order, facets_of_both] : counts) {
    EXPECT_EQ(2 * hard::facet_ball(order).rows.size(), static_cast<std::size_t>(facets_of_both));
  }
}

TEST(HardCases, AreTheSameForTheSameSeed) {
  for (const hard::CaseFamily& family : hard::case_families()) {
    Random first(3), second(3), other(4);
    const std::string line = hard::json_line("x", family.name, family.make(first));
    EXPECT_EQ(line, hard::json_line("x", family.name, family.make(second)));
    EXPECT_NE(line, hard::json_line("x", family.name, family.make(other)));
  }
}

}  // namespace
}  // namespace clearance
