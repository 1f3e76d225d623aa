// The bound that a separating direction gives after both parts have moved, compared with a new
// query.
#include "monitor/pairs/carried_gap.hpp"

#include <gtest/gtest.h>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

// Two parts whose distance has been queried once, and which then move.
class AskedOnce {
 public:
  AskedOnce(Part a, Part b, const Pose& pose_a, const Pose& pose_b)
      : scene_(
            test::cell_of({test::moving("a", {std::move(a)}), test::moving("b", {std::move(b)})})),
        parts_(parts_of(scene_)),
        poses_{pose_a, pose_b} {
    for (std::size_t i = 0; i < 2; ++i) place_at(poses_[i], parts_[i]);
    const DistanceResult found = ask();
    normal_ = parts_[0].world_from_part_rotation * found.normal;
    kept_ = kept_gap(bounds(found).lower, normal_, parts_[0], parts_[1]);
  }

  void move(std::size_t object, const Pose& to) {
    turned_[object] = rounded_up(turned_[object] + motion_between(poses_[object], to).turn);
    parts_[object].turning = swept(turned_[object], parts_[object].sphere_in_part.radius);
    poses_[object] = to;
    place_at(to, parts_[object]);
  }
  [[nodiscard]] Pose pose(std::size_t object) const { return poses_[object]; }
  [[nodiscard]] double told() const { return lower_along(normal_, kept_, parts_[0], parts_[1]); }
  [[nodiscard]] double truth() const { return bounds(ask()).upper; }

 private:
  [[nodiscard]] DistanceResult ask() const {
    TrackingState cold;
    return distance(*parts_[0].shape, *parts_[1].shape,
                    relative_pose(parts_[0].world_from_part, parts_[1].world_from_part), cold);
  }
  [[nodiscard]] DistanceBounds bounds(const DistanceResult& found) const {
    return for_exact_poses(found, parts_[0], parts_[1]);
  }

  Scene scene_;
  std::vector<PosedPart> parts_;
  std::array<Pose, 2> poses_;
  std::array<double, 2> turned_{};
  Vec3 normal_;
  double kept_ = 0.0;
};

TEST(CarriedGap, IsNeverAboveTheTruthHoweverBothMove) {
  Random random(81);
  int apart = 0;
  for (int i = 0; i < 400; ++i) {
    const Part floor_or_block =
        i % 4 == 0 ? test::floor() : test::block({0.2, 0.1, 0.3}, random.pose(0.3));
    AskedOnce pair(floor_or_block, test::capsule(0.4, 0.02, random.pose(0.3)), random.pose(1.0),
                   random.pose(1.0));
    const double scale = std::pow(10.0, random.uniform(-6.0, 0.0));
    for (int k = 0; k < 20; ++k) {
      for (std::size_t object = 0; object < 2; ++object) {
        Pose to = pair.pose(object);
        to.position += random.in_box(scale);
        const Vec3 axis = random.in_box(1.0).normalized();
        if (i % 3 == 0) to.orientation = Eigen::AngleAxisd(scale, axis) * to.orientation;
        pair.move(object, to);
      }
      ASSERT_LE(pair.told(), pair.truth()) << "case " << i << " step " << k;
      apart += pair.told() > 0.0;
    }
  }
  EXPECT_GT(apart, 2000) << "and tells something";
}

TEST(CarriedGap, MotionAcrossItCostsNothingAndMotionApartGains) {
  AskedOnce pair(test::floor(), test::ball(0.1), {}, test::at(0, 0, 0.3));
  pair.move(1, test::at(5.0, -3.0, 0.3));
  EXPECT_NEAR(pair.told(), 0.2, 1e-12);
  pair.move(1, test::at(5.0, -3.0, 1.3));
  EXPECT_NEAR(pair.told(), 1.2, 1e-12);
  pair.move(0, test::at(0, 7.0, 0.1));
  EXPECT_NEAR(pair.told(), 1.1, 1e-12);
}

TEST(CarriedGap, TurningCostsNoMoreThanTheSphereAroundThePart) {
  const Part off_its_origin = test::ball(0.1, test::at(2.0, 0, 0));
  AskedOnce pair(test::floor(), off_its_origin, {}, test::at(0, 0, 0.3));
  Pose turned = pair.pose(1);
  turned.orientation = Eigen::AngleAxisd(0.1, Vec3::UnitZ());
  pair.move(1, turned);
  EXPECT_NEAR(pair.told(), 0.2 - 0.01, 1e-4) << "though its middle has moved by 20 cm";
}

TEST(CarriedGap, AnUnboundedBodyThatTurnsLeavesNothing) {
  AskedOnce pair(test::floor(), test::ball(0.1), {}, test::at(0, 0, 0.3));
  Pose turned;
  turned.orientation = Eigen::AngleAxisd(1e-3, Vec3::UnitX());
  pair.move(0, turned);
  EXPECT_EQ(pair.told(), -kInfinity);
}

TEST(CarriedGap, IsKeptOnlyIfBothPartsKeepTheDirectionAndThereIsOne) {
  test::EveryChoice choice;
  while (choice.next()) {
    PosedPart a, b;
    a.keeps_direction = choice.flag();
    b.keeps_direction = choice.flag();
    const bool has_normal = choice.flag();
    const Vec3 normal = has_normal ? Vec3(Vec3::UnitX()) : Vec3(Vec3::Zero());
    b.sphere_in_world.centre = {3.0, 0.0, 0.0};
    const double gap = kept_gap(2.0, normal, a, b);
    if (a.keeps_direction && b.keeps_direction && has_normal) {
      EXPECT_NEAR(gap, -1.0, 1e-12);
    } else {
      EXPECT_EQ(gap, -kInfinity);
    }
  }
  EXPECT_EQ(choice.runs(), 8u);
}

}  // namespace
}  // namespace clearance
