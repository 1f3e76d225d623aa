#include "monitor/bodies/closing_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

constexpr double kNoSpeed = std::numeric_limits<double>::quiet_NaN();

TEST(ClosingSpeed, SpinningPointMovesAcrossItsArm) {
  Pose pose = test::at(1.0, 0.0, 0.0);
  const Twist twist{.linear = Vec3(0.0, 0.0, 0.5), .angular = Vec3(0.0, 0.0, 2.0)};
  EXPECT_EQ(velocity_at(Vec3(1.3, 0.0, 0.0), pose, twist), Vec3(0.0, 2.0 * (1.3 - 1.0), 0.5));
}

TEST(ClosingSpeed, IsPositiveWhenAMovesTowardsB) {
  EXPECT_EQ(closing_speed(Vec3(2, 0, 0), Vec3(0.5, 0, 0), Vec3::UnitX()), 1.5);
  EXPECT_EQ(closing_speed(Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3::UnitX()), -0.5);
}

TEST(ClosingSpeed, TimeToContactCountsOnlyWhatApproaches) {
  EXPECT_EQ(time_to_contact(0.5, 2.0), 0.25);
  EXPECT_EQ(time_to_contact(0.5, 0.0), kInfinity);
  EXPECT_EQ(time_to_contact(0.5, -1.0), kInfinity);
  EXPECT_EQ(time_to_contact(-0.1, 1.0), 0.0);
  EXPECT_EQ(time_to_contact(0.0, kNoSpeed), 0.0);
  EXPECT_EQ(time_to_contact(0.0, -1.0), kInfinity);
  EXPECT_TRUE(std::isnan(time_to_contact(kNoSpeed, 1.0)));
  EXPECT_TRUE(std::isnan(time_to_contact(0.3, kNoSpeed)));
}

// Oracle: the distance shortly before and after, by closed form.
TEST(ClosingSpeed, ReportedSpeedIsTheRateAtWhichTheDistanceFalls) {
  Random random(21);
  const Scene scene = test::cell_of({
      test::moving("a", {test::capsule(1.0, 0.02, random.pose(0.2))}),
      test::moving("b", {test::capsule(0.7, 0.03)}),
  });
  for (int i = 0; i < 200; ++i) {
    Monitor monitor(scene);
    const std::array<Pose, 2> pose{random.pose(2.0), random.pose(2.0)};
    std::array<Twist, 2> twist;
    std::vector<PoseSample> samples;
    for (std::uint32_t k = 0; k < 2; ++k) {
      twist[k] = {.linear = random.in_box(1.0), .angular = random.in_box(2.0)};
      samples.push_back(test::sample(k, pose[k], test::kStart));
      samples.back().twist = twist[k];
      samples.back().has_twist = true;
    }
    const PairReport& found = monitor.tick(samples, test::kStart).minimum;

    const auto distance_after = [&](double seconds) {
      std::array<Pose, 2> moved = pose;
      for (std::size_t k = 0; k < 2; ++k) {
        moved[k].position += seconds * twist[k].linear;
        const double angle = seconds * twist[k].angular.norm();
        moved[k].orientation =
            Eigen::AngleAxisd(angle, twist[k].angular.normalized()) * pose[k].orientation;
      }
      return test::true_distance(scene.objects[0], moved[0], scene.objects[1], moved[1]);
    };
    const double h = 1e-5;
    const double falls = static_cast<double>(distance_after(-h) - distance_after(h)) / (2.0 * h);
    EXPECT_NEAR(found.closing_speed, falls, 1e-3) << "case " << i;
  }
}

}  // namespace
}  // namespace clearance
