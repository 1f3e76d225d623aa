// The distance of two objects that a person picks, against closed forms and the truth of posed
// spheres.
#include "monitor/visual/measured_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "monitor/wire/convert.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kMeasuredMs = 1'000'000;

class MeasuredDistanceTest : public testing::Test {
 protected:
  // A report in whose tick the hand had this pose, with this stamp.
  void use(const Pose& hand, std::int64_t stamp_ns, std::int64_t now_ns) {
    PoseBatch batch{SourceName("arm"), ++number_, scene.revision, {}};
    batch.samples.push_back(sample(0, hand, stamp_ns));
    poses.take(std::move(batch), ObjectPoses::Numbers::kOfSender);
    Sample<clearance_msg_Distances> wire = make_distances(scene);
    Report report;
    report.now_ns = now_ns;
    report.newest_pose_ns = stamp_ns;
    const SourceUse used{SourceName("arm"), number_};
    to_wire(report, {&used, 1U}, 0, *wire);
    poses.use(*wire);
  }

  // The hand is watched beside the post only; post and shelf are two fixed objects.
  Scene scene =
      cell_of({moving("hand", {ball(0.1), ball(0.05, at(0.3, 0, 0))}),
               fixed("post", {ball(0.2)}, at(2, 0, 0)), fixed("shelf", {ball(0.25)}, at(0, 3, 0))});
  ObjectPoses poses{scene};
  MeasuredDistances measured{scene};

 private:
  std::uint64_t number_ = 0;
};

TEST_F(MeasuredDistanceTest, HoldsTheTruthForAnyTwoObjectsAndBothOrders) {
  std::mt19937 random(33);
  std::uniform_real_distribution<double> coordinate(-4.0, 4.0);
  for (int i = 1; i <= 200; ++i) {
    const auto next = [&] { return coordinate(random); };
    const Pose hand{Vec3(next(), next(), next()),
                    Eigen::Quaterniond(next(), next(), next(), next()).normalized()};
    use(hand, i * kMeasuredMs, i * kMeasuredMs);
    const Vec3 far = transform(hand, Vec3(0.3, 0, 0));
    const auto truth = [&](const Vec3& centre, double radius) {
      return std::min((centre - hand.position).norm() - 0.1, (centre - far).norm() - 0.05) - radius;
    };
    for (const auto& [object, centre, radius] :
         {std::tuple(1U, Vec3(2, 0, 0), 0.2), std::tuple(2U, Vec3(0, 3, 0), 0.25)}) {
      const MeasuredDistance one = measured.between(0, object, poses);
      const MeasuredDistance other = measured.between(object, 0, poses);
      const double expected = truth(centre, radius);
      for (const MeasuredDistance& found : {one, other}) {
        EXPECT_LE(found.lower, expected + 1e-12);
        EXPECT_GE(found.upper, expected - 1e-12);
        EXPECT_NEAR(found.distance, expected, 1e-9);
        EXPECT_LE(found.upper - found.lower, 1e-9);
      }
      if (expected > 0.0) {
        EXPECT_NEAR((one.witness_b - one.witness_a).norm(), expected, 1e-6);
        EXPECT_LT((one.witness_a - other.witness_b).norm(), 1e-6);
      }
    }
  }
}

TEST_F(MeasuredDistanceTest, TwoFixedObjectsHaveOne) {
  const MeasuredDistance found = measured.between(1, 2, poses);
  EXPECT_NEAR(found.distance, std::sqrt(13.0) - 0.45, 1e-12);
  EXPECT_EQ(found.status, PairStatus::kConverged);
}

TEST_F(MeasuredDistanceTest, IsUnknownWithoutAPoseAndWithALateOne) {
  const auto expect_unknown = [&](std::uint32_t a, std::uint32_t b) {
    const MeasuredDistance found = measured.between(a, b, poses);
    EXPECT_EQ(found.status, PairStatus::kUnknown);
    EXPECT_EQ(found.lower, -kInfinity);
    EXPECT_EQ(found.upper, kInfinity);
    EXPECT_TRUE(std::isnan(found.distance));
  };
  expect_unknown(0, 1);
  const std::int64_t limit = scene.objects[0].age_limit_ns;
  use(at(0, 0, 1), kMeasuredMs, kMeasuredMs + limit);
  EXPECT_NE(measured.between(0, 1, poses).status, PairStatus::kUnknown);
  use(at(0, 0, 1), 2 * kMeasuredMs, 2 * kMeasuredMs + limit + 1);
  expect_unknown(0, 1);
  expect_unknown(1, 1);
  expect_unknown(1, 3);
}

TEST_F(MeasuredDistanceTest, OfWhatASensorSeesIsUnknown) {
  use(at(1, 0, 0), kMeasuredMs, kMeasuredMs);
  ASSERT_NE(measured.between(0, 1, poses).status, PairStatus::kUnknown);
  scene.objects[1].sensor = 0;
  EXPECT_EQ(measured.between(0, 1, poses).status, PairStatus::kUnknown);
  EXPECT_EQ(measured.between(1, 0, poses).lower, -kInfinity);
}

}  // namespace
}  // namespace clearance::test
