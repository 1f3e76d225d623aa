// Curved bodies of every hard family. Oracle: the ellipsoid method in 50 digits
// (tests/shared/curved_oracle.hpp). Laws relate the answers to each other.
#include <gtest/gtest.h>

#include <cmath>

#include "core/distance.hpp"
#include "tests/shared/curved_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using hard::CurvedCase;
using hard::CurvedFamily;
using test::made;

constexpr int kJudgedCases = 8, kLawfulCases = 200;

struct AskedCase {
  explicit AskedCase(const CurvedCase& c)
      : asked(c), a(made(hard::curved_model(c.a))), b(made(hard::curved_model(c.b))) {}

  [[nodiscard]] DistanceResult cold() const { return cold(asked.pose_a, asked.pose_b); }
  [[nodiscard]] DistanceResult cold(const Pose& pose_a, const Pose& pose_b) const {
    return test::cold(a, b, relative_pose(pose_a, pose_b));
  }
  [[nodiscard]] double size() const {
    return a.bounding_radius + a.radius + b.bounding_radius + b.radius +
           2.0 * (asked.pose_a.position - asked.pose_b.position).norm();
  }

  CurvedCase asked;
  ConvexBody a, b;
};

class CurvedFamilies : public testing::TestWithParam<CurvedFamily> {
 protected:
  template <class Check>
  static void for_each(int count, const Check& check) {
    for (int seed = 0; seed < count; ++seed) {
      Random random(static_cast<std::uint64_t>(seed) * 100000);
      SCOPED_TRACE("seed " + std::to_string(seed));
      check(AskedCase(GetParam().make(random)), random);
      if (testing::Test::HasFailure()) return;
    }
  }
};

void expect_common_truth(const DistanceResult& r, const DistanceResult& s, double slack) {
  EXPECT_LE(r.lower, s.upper + slack);
  EXPECT_LE(s.lower, r.upper + slack);
}

TEST_P(CurvedFamilies, HaveBoundsThatHoldIn50Digits) {
  for_each(kJudgedCases, [](const AskedCase& e, Random&) {
    const CurvedJudge judge(e.asked);
    for (const std::string& fault : judge.faults(e.cold())) ADD_FAILURE() << fault;
  });
}

TEST_P(CurvedFamilies, HaveNoOtherTruthWhenTracked) {
  for_each(kLawfulCases, [](const AskedCase& e, Random& random) {
    TrackingState state;
    Pose pose_b = e.asked.pose_b;
    const Vec3 step = random.log_uniform(1e-9, 0.05) * random.direction();
    for (int k = 0; k < 5; ++k) {
      pose_b.position += step;
      const DistanceResult tracked = distance(e.a, e.b, e.asked.pose_a, pose_b, state);
      expect_common_truth(tracked, e.cold(e.asked.pose_a, pose_b), 0.0);
    }
  });
}

TEST_P(CurvedFamilies, AreAsFarApartWhenSwapped) {
  for_each(kLawfulCases, [](const AskedCase& e, Random&) {
    const RelativePose b_from_a = relative_pose(e.asked.pose_b, e.asked.pose_a);
    expect_common_truth(e.cold(), test::cold(e.b, e.a, b_from_a), 0.0);
  });
}

TEST_P(CurvedFamilies, AreAsFarApartWhereverTheyAreMovedTogether) {
  for_each(kLawfulCases, [](const AskedCase& e, Random& random) {
    const Pose world = random.pose(5.0);
    const DistanceResult moved =
        e.cold(compose(world, e.asked.pose_a), compose(world, e.asked.pose_b));
    expect_common_truth(e.cold(), moved, 8.0 * kPlacingError * (e.size() + 20.0));
  });
}

TEST_P(CurvedFamilies, AreEightTimesAsFarApartWhenEightTimesAsLarge) {
  for_each(kLawfulCases, [](const AskedCase& e, Random&) {
    CurvedCase large = e.asked;
    for (oracle::CurvedBody* body : {&large.a, &large.b}) {
      for (Vec3& p : body->points) p *= 8.0;
      body->shape.semi_axes *= 8.0;
      for (Disc& disc : body->shape.discs) disc = {8.0 * disc.height, 8.0 * disc.radius};
      body->radius *= 8.0;
    }
    large.pose_a.position *= 8.0;
    large.pose_b.position *= 8.0;
    DistanceResult s = AskedCase(large).cold();
    s.lower /= 8.0;
    s.upper /= 8.0;
    expect_common_truth(e.cold(), s, 0.0);
  });
}

TEST_P(CurvedFamilies, TouchWhenMovedByTheDistance) {
  for_each(kLawfulCases, [](const AskedCase& e, Random&) {
    RelativePose pose = relative_pose(e.asked.pose_a, e.asked.pose_b);
    const DistanceResult r = test::cold(e.a, e.b, pose);
    // The translation makes the closest points coincide. Overlapping bodies are separated along a
    // direction that proves the separation.
    pose.translation -= r.lower > 0.0 ? Vec3(r.point_on_b - r.point_on_a) : r.distance * r.normal;
    const DistanceResult s = test::cold(e.a, e.b, pose);
    EXPECT_GE(s.upper, -1e-13 * e.size());
    if (r.lower > 0.0) {
      EXPECT_LE(s.lower, r.upper - r.lower + 1e-13 * e.size());
    }
  });
}

TEST_P(CurvedFamilies, AreNearerByARadiusAroundOne) {
  for_each(kLawfulCases, [](const AskedCase& e, Random& random) {
    const DistanceResult r = e.cold();
    const double more = random.log_uniform(1e-3, 1.0);
    AskedCase rounded = e;
    (random.chance(0.5) ? rounded.a : rounded.b).radius += more;
    DistanceResult s = rounded.cold();
    s.lower += more;
    s.upper += more;
    expect_common_truth(r, s, 1e-15 * (more + e.size()));
  });
}

// A body shrinks to one of its points. Its distance never falls below that of the whole body, and
// finally equals that of the point.
TEST_P(CurvedFamilies, AreAsFarAsAPointInTheEndWhenTheyShrinkToIt) {
  for_each(kLawfulCases / 4, [](const AskedCase& e, Random&) {
    if (!e.asked.b.points.empty()) return;
    const ConvexBody at_origin = made(point(Vec3::Zero(), 0.0));
    const DistanceResult of_point =
        test::cold(e.a, at_origin, relative_pose(e.asked.pose_a, e.asked.pose_b));
    double before = e.cold().lower;
    for (double scale : {0.25, 0.0078125, 0x1p-20}) {
      CurvedCase small = e.asked;
      small.b.shape.semi_axes *= scale;
      for (Disc& disc : small.b.shape.discs) {
        disc = {scale * disc.height, scale * disc.radius};
      }
      small.b.radius *= scale;
      // The body shrinks around its origin, which lies inside it. The smaller body is therefore a
      // part of the larger one.
      const AskedCase shrunk(small);
      const DistanceResult s = shrunk.cold();
      EXPECT_GE(s.upper, before);
      before = s.lower;
      EXPECT_LE(s.lower, of_point.upper);
      EXPECT_GE(s.upper, of_point.lower - shrunk.b.bounding_radius - shrunk.b.radius);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Of, CurvedFamilies, testing::ValuesIn(hard::curved_families()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace clearance
