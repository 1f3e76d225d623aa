// The simplex of GJK, in doubles and in double-double. Oracles: closed forms and the optimality
// condition. The point v of a convex set is closest to the origin where v.(p - v) >= 0 for all
// points p of the set.
#include "core/gjk/simplex.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

template <class T>
class ClosestToOrigin : public testing::Test {
 public:
  using Points = std::array<Vec3, 4>;
  static ClosestPoint<T> of(const Points& points, std::size_t size) {
    std::array<Vector<T>, 4> p;
    for (std::size_t i = 0; i < size; ++i) p[i] = vector_of<T>(points[i]);
    return closest_to_origin(p, size);
  }
};
using Numbers = testing::Types<double, DoubleDouble>;
TYPED_TEST_SUITE(ClosestToOrigin, Numbers);

TYPED_TEST(ClosestToOrigin, IsOnTheVertexEdgeOrTriangleThatClosedFormsSay) {
  using OfType = ClosestToOrigin<TypeParam>;
  const auto point = [](const ClosestPoint<TypeParam>& c) { return rounded(c.point); };
  EXPECT_EQ(point(OfType::of({Vec3(1, 2, 3)}, 1)), Vec3(1, 2, 3));
  EXPECT_EQ(point(OfType::of({Vec3(-1, 1, 0), Vec3(3, 1, 0)}, 2)), Vec3(0, 1, 0));
  EXPECT_EQ(point(OfType::of({Vec3(1, 1, 0), Vec3(3, 1, 0)}, 2)), Vec3(1, 1, 0));
  EXPECT_EQ(point(OfType::of({Vec3(-1, -1, 2), Vec3(3, -1, 2), Vec3(-1, 3, 2)}, 3)), Vec3(0, 0, 2));
  const auto inside =
      OfType::of({Vec3(-1, -1, -1), Vec3(3, -1, -1), Vec3(-1, 3, -1), Vec3(-1, -1, 3)}, 4);
  EXPECT_EQ(point(inside), Vec3(0, 0, 0));
  for (const TypeParam& w : inside.weights) EXPECT_GT(leading(w), 0.0);
}

// After a reduction, the subsets of the points that it kept are left out.
TYPED_TEST(ClosestToOrigin, IsTheSameToTheBitWithoutTheSubsetsOfAReducedSimplex) {
  Random random(2);
  int whole = 0;
  for (int k = 0; k < 20'000; ++k) {
    const double flat = random.chance(0.3) ? random.log_uniform(1e-14, 1.0) : 1.0;
    const Vec3 middle = random.uniform(0.0, 2.0) * random.direction();
    const auto point = [&] {
      const Vec3 p = middle + random.in_box(1.0).cwiseProduct(Vec3(1, flat, 1));
      return vector_of<TypeParam>(random.chance(0.1) ? Vec3(p.array().round()) : p);
    };
    std::array<Vector<TypeParam>, 4> points;
    std::size_t size = 0;
    for (int round = 0; round < 8; ++round) {
      const std::size_t reduced = size;
      points[size++] = point();
      const auto all = closest_to_origin(points, size);
      const auto found = closest_to_origin(points, size, reduced);
      ASSERT_EQ(rounded(found.point), rounded(all.point)) << k;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_EQ(leading(found.weights[i]), leading(all.weights[i])) << k;
        if (leading(all.weights[i]) > 0.0) points[kept++] = points[i];
      }
      size = kept;
      if (size == 4) break;  // the origin is inside
      whole += size == 3;
    }
  }
  EXPECT_GT(whole, 10'000);
}

TYPED_TEST(ClosestToOrigin, NoPointOfTheSimplexIsCloser) {
  Random random(1);
  for (int k = 0; k < 4000; ++k) {
    const auto size = static_cast<std::size_t>(random.integer(1, 4));
    const double scale = random.log_uniform(1e-6, 1e6), flat = random.log_uniform(1e-9, 1.0);
    std::array<Vec3, 4> points;
    const Vec3 middle = scale * random.in_box(1.0);
    for (Vec3& p : points) p = middle + scale * random.in_box(1.0).cwiseProduct(Vec3(1, flat, 1));
    const auto found = ClosestToOrigin<TypeParam>::of(points, size);
    const Vec3 v = rounded(found.point);
    double sum = 0.0;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < size; ++i) {
      const double weight = leading(found.weights[i]);
      EXPECT_GE(weight, 0.0);
      sum += weight;
      mean += weight * points[i];
      EXPECT_GE(v.dot(points[i] - v), -1e-6 * scale * scale * flat - 1e-9 * scale * scale) << k;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LE((mean - v).norm(), 1e-12 * scale);
  }
}

TYPED_TEST(ClosestToOrigin, IsFoundOnDegenerateSimplicesToo) {
  using OfType = ClosestToOrigin<TypeParam>;
  const Vec3 p(1, 2, 3), q(3, 2, 1);
  EXPECT_EQ(rounded(OfType::of({p, p, p, p}, 4).point), p);
  const Vec3 middle = rounded(OfType::of({p, q, p, Vec3(2, 2, 2)}, 4).point);
  EXPECT_NEAR((middle - Vec3(2, 2, 2)).norm(), 0.0, 1e-15);
}

TEST(ClosestToOriginInTwiceThePrecision, KeepsDigitsThatDoublesLose) {
  // The triangle is 1e-9 wide and passes the origin at 1e-12. In doubles, squares of 1e-9 lose that
  // distance.
  const Vec3 a(-1.0, 1e-12, 0.0), b(1.0, 1e-12, 1e-9), c(1.0, 1e-12, -1e-9);
  const auto found = ClosestToOrigin<DoubleDouble>::of({a, b, c}, 3);
  EXPECT_NEAR(rounded(found.point).y(), 1e-12, 1e-27);
  EXPECT_LE(std::abs(rounded(found.point).x()), 1e-24);
}

struct TestPoint {
  Vector<double> difference;
  int id = 0;
  bool operator==(const TestPoint& other) const { return id == other.id; }
};

TEST(GjkSimplex, KeepsWhatTheClosestPointNeedsAndTakesNoPointTwice) {
  Simplex<TestPoint, double> simplex;
  EXPECT_TRUE(simplex.add({{-1.0, 1.0, 0.0}, 1}));
  EXPECT_TRUE(simplex.add({{3.0, 1.0, 0.0}, 2}));
  EXPECT_TRUE(simplex.add({{0.0, 5.0, 0.0}, 3}));
  EXPECT_FALSE(simplex.add({{3.0, 1.0, 0.0}, 2}));
  EXPECT_EQ(rounded(simplex.reduce().point), Vec3(0, 1, 0));
  ASSERT_EQ(simplex.size(), 2u);
  EXPECT_EQ(simplex.point(0).id, 1);
  EXPECT_EQ(simplex.point(1).id, 2);
  EXPECT_FALSE(simplex.holds_origin());
  const Vec3 mean = simplex.mean([](const TestPoint& p) { return rounded(p.difference); });
  EXPECT_EQ(mean, Vec3(0, 1, 0));
}

TEST(GjkSimplex, HoldsTheOriginWhereFourPointsAreNeeded) {
  Simplex<TestPoint, double> simplex;
  const Vec3 points[] = {{-1, -1, -1}, {3, -1, -1}, {-1, 3, -1}, {-1, -1, 3}};
  int id = 0;
  for (const Vec3& p : points) EXPECT_TRUE(simplex.add({vector_of<double>(p), ++id}));
  (void)simplex.reduce();
  EXPECT_TRUE(simplex.holds_origin());
}

}  // namespace
}  // namespace clearance
