// Oracle: the rows themselves, as rationals.
#include "core/construction/strictly_inside.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance::exact {
namespace {

// The sign of n.x - d at a homogeneous point.
int height(const HalfSpace& row, const Integer4& point) {
  mpq_class sum = -mpq_class(row.offset) * mpq_class(point[3]);
  for (int i = 0; i < 3; ++i)
    sum += mpq_class(row.normal[i]) * mpq_class(point[static_cast<std::size_t>(i)]);
  return sgn(sum);
}

std::vector<HalfSpace> chosen(const std::vector<HalfSpace>& rows, const std::vector<int>& which) {
  std::vector<HalfSpace> result;
  for (const int row : which) result.push_back(rows[static_cast<std::size_t>(row)]);
  return result;
}

// An interior point is strictly inside every row. A proof of an empty interior must hold with its
// rows alone, and must need each of them.
void expect_right(const std::vector<HalfSpace>& rows, int& inside, int& none) {
  const auto answer = interior_point(rows);
  if (const Integer4* point = std::get_if<Integer4>(&answer)) {
    ++inside;
    EXPECT_GT(sgn((*point)[3]), 0);
    for (const HalfSpace& row : rows) EXPECT_LT(height(row, *point), 0);
    return;
  }
  ++none;
  const NoInterior& proof = std::get<NoInterior>(answer);
  ASSERT_GE(proof.rows.size(), 2U);
  ASSERT_LE(proof.rows.size(), 4U);
  const auto again = interior_point(chosen(rows, proof.rows));
  ASSERT_TRUE(std::holds_alternative<NoInterior>(again));
  EXPECT_EQ(std::get<NoInterior>(again).flat, proof.flat);
  for (std::size_t i = 0; i < proof.rows.size(); ++i) {
    std::vector<int> fewer = proof.rows;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_TRUE(std::holds_alternative<Integer4>(interior_point(chosen(rows, fewer))));
  }
}

TEST(InteriorPoint, IsRightWhenAllPlanesPassWithinAFewUlpsOfOnePoint) {
  Random random(31);
  int inside = 0;
  int none = 0;
  for (int round = 0; round < 400; ++round) {
    const Vec3 centre = random.in_box(4.0);
    std::vector<HalfSpace> rows;
    const int count = random.integer(4, 12);
    for (int i = 0; i < count; ++i) {
      const Vec3 normal = random.direction();
      rows.push_back({normal, normal.dot(centre) + 0x1p-52 * random.integer(-2, 3)});
    }
    expect_right(rows, inside, none);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(none, 100);
}

TEST(InteriorPoint, IsRightOnALatticeWithTies) {
  Random random(37);
  int inside = 0;
  int none = 0;
  for (int round = 0; round < 600; ++round) {
    std::vector<HalfSpace> rows;
    const int count = random.integer(1, 9);
    while (static_cast<int>(rows.size()) < count) {
      const Vec3 normal(random.integer(-1, 1), random.integer(-1, 1), random.integer(-1, 1));
      if (!normal.isZero(0.0)) {
        rows.push_back({normal, static_cast<double>(random.integer(-1, 2))});
      }
    }
    expect_right(rows, inside, none);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(none, 100);
}

TEST(InteriorPoint, IsRightOverEveryOrderOfMagnitude) {
  Random random(41);
  int inside = 0;
  int none = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<HalfSpace> rows;
    for (int i = 0; i < 7; ++i) {
      const double length = random.log_uniform(1e-250, 1e250);
      const double offset = random.sign() * random.log_uniform(1e-40, 1e40);
      rows.push_back({random.direction() * length, offset * length});
    }
    expect_right(rows, inside, none);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(inside, 20);
  EXPECT_GT(none, 20);
}

TEST(InteriorPoint, FindsTheWedgeThatOpensFarAway) {
  for (const double tilt : {1e-3, 1e-9, 1e-15, 1e-100, 1e-300}) {
    int inside = 0;
    int none = 0;
    expect_right({{{-tilt, 1, 0}, 0}, {{0, -1, 0}, -1}}, inside, none);
    EXPECT_EQ(inside, 1) << tilt;
  }
}

TEST(NormalSpan, CountsIndependentNormals) {
  EXPECT_EQ(normal_span(std::vector<HalfSpace>{{{1, 2, 3}, 0}, {{-0.5, -1, -1.5}, 2}}).rank, 1);
  const NormalSpan two =
      normal_span(std::vector<HalfSpace>{{{1, 0, 0}, 0}, {{1, 1, 0}, 0}, {{-3, 7, 0}, 0}});
  EXPECT_EQ(two.rank, 2);
  EXPECT_EQ(two.direction, (Integer3{0, 0, 1}));
  EXPECT_EQ(
      normal_span(std::vector<HalfSpace>{{{1, 0, 0}, 0}, {{1, 1, 0}, 0}, {{1, 1, 1e-300}, 0}}).rank,
      3);
}

}  // namespace
}  // namespace clearance::exact
