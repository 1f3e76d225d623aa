// The bounds for the time between two ticks, compared with the interpolated motion in small steps.
//
// Oracle: cold queries of the core at many instants. Eigen interpolates positions and orientations.
#include "monitor/schedule/swept_search.hpp"

#include <gtest/gtest.h>

#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/schedule/zone_crossings.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

struct Motion2 {
  std::array<Pose, 2> from, to;
};

// Two objects of one part each, and their motion from one tick to the next.
class TwoInMotion {
 public:
  TwoInMotion(Part a, Part b, const Motion2& motion)
      : scene_(
            test::cell_of({test::moving("a", {std::move(a)}), test::moving("b", {std::move(b)})})),
        motion_(motion),
        parts_(parts_of(scene_)),
        table_(scene_, parts_) {
    for (std::uint32_t i = 0; i < 2; ++i) {
      TrackedObject& state = objects_.emplace_back();
      for (const Pose& pose : {motion.from[i], motion.to[i]}) {
        const std::int64_t now = kStart + (&pose == &motion.from[i] ? 0 : kTick);
        EXPECT_FALSE(take(scene_.objects[i], test::sample(i, pose, now), now, {now, 0}, state));
        advance(scene_.objects[i], now, state);
        displace(parts_[i].bounding_radius, state);
      }
      place(state, parts_[i]);
    }
  }

  SweptBounds decide(double level, std::uint32_t queries = 1000) {
    const TickView view{objects_, parts_, 2, table_};
    Budget budget(queries);
    const SweptBounds bounds = SweptSearch(0, view).decide(level, budget);
    queries_ = queries - budget.left();
    return bounds;
  }
  // Bounds without a query, of a pair that no tick has updated since B had `moved_before`, m, left
  // to go until the start of this motion. Its bound was `lower_before` then.
  SweptBounds from_old_bound(double lower_before, double moved_before) {
    table_.lower[0] = lower_before;
    objects_[1].accumulated += moved_before;
    Budget none(0);
    return swept_bounds_of(0, 0.0, TickView{objects_, parts_, 2, table_}, none);
  }
  [[nodiscard]] std::uint32_t queries() const { return queries_; }
  // The bounds at the end of the motion, as the search has them.
  [[nodiscard]] DistanceBounds at_end() const {
    return for_exact_poses(truth(1.0), parts_[0], parts_[1]);
  }

  [[nodiscard]] DistanceResult truth(double s) const {
    std::array<Pose, 2> world_from_part;
    for (std::size_t i = 0; i < 2; ++i) {
      world_from_part[i] = compose(test::between(motion_.from[i], motion_.to[i], s),
                                   scene_.objects[i].parts[0].object_from_part);
    }
    TrackingState cold;
    return distance(scene_.objects[0].parts[0].shape, scene_.objects[1].parts[0].shape,
                    relative_pose(world_from_part[0], world_from_part[1]), cold);
  }

 private:
  Scene scene_;
  Motion2 motion_;
  std::vector<PosedPart> parts_;
  PairTable table_;
  std::vector<TrackedObject> objects_;
  std::uint32_t queries_ = 0;
};

Part any_part(Random& random) {
  const Pose offset = random.uniform(0, 1) < 0.5 ? Pose{} : random.pose(0.5);
  const double kind = random.uniform(0, 4);
  if (kind < 1) return test::capsule(random.uniform(0.2, 1.0), 0.02, offset);
  if (kind < 2) return test::block({0.4, 0.005, 0.005}, offset);
  if (kind < 3) return test::block({0.3, 0.2, 0.003}, offset);
  return test::block(
      {random.uniform(0.01, 0.3), random.uniform(0.01, 0.3), random.uniform(0.01, 0.3)}, offset);
}

Motion2 any_motion(Random& random) {
  Motion2 motion;
  const double scale = std::pow(10.0, random.uniform(-4.0, 0.3));
  const Eigen::Quaterniond common(Eigen::AngleAxisd(scale * random.uniform(-1, 1), Vec3::UnitZ()));
  for (std::size_t i = 0; i < 2; ++i) {
    motion.from[i] = random.pose(0.6);
    motion.to[i] = motion.from[i];
    motion.to[i].position += random.in_box(scale);
    const Vec3 axis = random.in_box(1.0).normalized();
    const double kind = random.uniform(0, 3);
    const Eigen::Quaterniond own(Eigen::AngleAxisd(scale * random.uniform(-1, 1), axis));
    if (kind < 1) motion.to[i].orientation = own * motion.from[i].orientation;
    if (kind > 2) motion.to[i].orientation = common * motion.from[i].orientation;
  }
  return motion;
}

TEST(SweptSearch, NoInstantIsNearerThanTheBoundAndSomeInstantIsAsNearAsTheOther) {
  Random random(91);
  int outside = 0, inside = 0;
  for (int i = 0; i < 1500; ++i) {
    TwoInMotion pair(any_part(random), any_part(random), any_motion(random));
    const double level = random.uniform(-0.05, 0.6);
    const SweptBounds bounds = pair.decide(level);
    double least = kInfinity;
    for (int k = 0; k <= 50; ++k) {
      const DistanceResult truth = pair.truth(0.02 * k);
      ASSERT_LE(bounds.lower, truth.upper + 1e-12) << "case " << i << " at " << 0.02 * k;
      least = std::min(least, truth.upper);
    }
    outside += bounds.lower >= level;
    inside += bounds.upper < level;
    ASSERT_GE(bounds.upper, bounds.lower) << "case " << i;
  }
  EXPECT_GT(outside, 300);
  EXPECT_GT(inside, 300);
  EXPECT_GT(outside + inside, 1490) << "the rest is as near to the level as no query tells";
}

TEST(SweptSearch, BothEndsTellAllOfAStraightPath) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(-1.0, 0, 0.2)};
  motion.to = {test::at(0, 0, 0), test::at(1.0, 0, 0.2)};
  TwoInMotion pair(test::block({0.4, 0.4, 0.1}), test::block({0.05, 0.05, 0.05}), motion);
  const SweptBounds bounds = pair.decide(0.04);
  EXPECT_GE(bounds.lower, 0.04) << "it passes 5 cm above";
  EXPECT_LE(bounds.lower, 0.05);
  EXPECT_LE(pair.queries(), 6u);
}

TEST(SweptSearch, ApproachingIsNearestAtTheEndAndTellsSoByTwoQueries) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(0.1, 0.03, 1.2)};
  motion.to = {test::at(0, 0, 0), test::at(0, 0, 0.3)};
  TwoInMotion pair(test::block({0.4, 0.4, 0.1}), test::block({0.05, 0.05, 0.05}), motion);
  EXPECT_NEAR(pair.decide(0.15 - 1e-9).lower, 0.15, 1e-9);
  EXPECT_EQ(pair.queries(), 2u);
}

TEST(SweptSearch, AThrownNeedleIsFoundInThePlateThatItFliesThrough) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(0.01, 0.02, -0.5)};
  motion.to = {test::at(0, 0, 0), test::at(0.0, 0.0, 0.7)};
  motion.to[1].orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Vec3::UnitY()));
  TwoInMotion pair(test::block({1.0, 1.0, 0.001}), test::block({0.002, 0.002, 0.02}), motion);
  EXPECT_GT(pair.truth(0.0).lower, 0.4);
  EXPECT_GT(pair.truth(1.0).lower, 0.6);
  const SweptBounds bounds = pair.decide(0.0);
  EXPECT_LT(bounds.upper, 0.0) << "was in the plate";
  EXPECT_LT(bounds.lower, 0.0);
}

TEST(SweptSearch, BodiesThatMoveTogetherDoNotMove) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(0, 0, 0.301)};
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.05, Vec3::UnitX()));
  for (std::size_t i = 0; i < 2; ++i) {
    motion.to[i].position = turn * motion.from[i].position + Vec3(0.5, 0, 0);
    motion.to[i].orientation = turn;
  }
  TwoInMotion pair(test::block({0.4, 0.4, 0.1}), test::block({0.2, 0.2, 0.2}), motion);
  EXPECT_GT(pair.decide(0.0005).lower, 0.0005) << "one millimetre between them";
  EXPECT_LE(pair.queries(), 4u);
}

TEST(SweptSearch, AFloorThatTurnsIsBoundedAsSeenFromTheFloor) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(0.3, 0, 0.5)};
  motion.to = {test::at(0, 0, 0), test::at(0.3, 0, 0.5)};
  motion.to[0].orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  TwoInMotion pair(test::floor(), test::ball(0.1), motion);
  const SweptBounds bounds = pair.decide(0.3);
  EXPECT_GE(bounds.lower, 0.3);
  EXPECT_LE(bounds.lower, 0.4);
}

// A pose between two ticks is rounded, and the bounds of that instant allow for it: per metre of
// both positions.
TEST(SweptSearch, BoundsOfAnInstantBetweenAllowForTheRoundingOfItsPose) {
  constexpr double kFar = 0x1p20;
  const Motion2 past{{test::at(kFar, -1, 0), test::at(kFar + 0.5, 0, 0)},
                     {test::at(kFar, 1, 0), test::at(kFar + 0.5, 0, 0)}};
  TwoInMotion balls(test::ball(0.1), test::ball(0.1), past);
  const SweptBounds bounds = balls.decide(0.31);
  EXPECT_LT(bounds.upper, 0.31);
  EXPECT_GE(bounds.upper, balls.truth(0.5).upper + 0.9 * kInterpolationError * (4.0 * kFar));
}

// A long arm turns about its end. The error of its orientation counts at the other end.
TEST(SweptSearch, BoundsOfAnInstantBetweenAllowForTheRoundingOfItsOrientation) {
  constexpr double kLong = 0x1p10;
  const Part tip{"tip", test::made(point(Vec3(kLong, 0, 0), 0.1)), {}};
  const auto turned = [](double angle) {
    return Pose{Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))};
  };
  const Pose post = test::at(kLong + 0.5, 0, 0);
  TwoInMotion arm(tip, test::ball(0.1), {{turned(-1e-3), post}, {turned(1e-3), post}});
  const SweptBounds bounds = arm.decide(0.301);
  EXPECT_LT(bounds.upper, 0.301);
  const double of_place = kInterpolationError * 2.0 * (kLong + 0.5);
  EXPECT_GE(bounds.upper, arm.truth(0.5).upper + of_place + 0.9 * kInterpolationError * kLong);
}

// Between two instants the sums of their bounds are rounded, too.
TEST(SweptSearch, TheBoundBetweenTwoInstantsAllowsForTheRoundingOfItsSums) {
  for (const double apart : {0.5, 3.0, 1e4}) {
    const std::array resting{test::at(0, 0, 0), test::at(0, 0, apart)};
    TwoInMotion pair(test::ball(0.1), test::ball(0.1), {resting, resting});
    const double lower = pair.at_end().lower;
    EXPECT_LE(pair.decide(0.1).lower, lower * (1.0 - 0.9 * 0x1p-47)) << apart;
    EXPECT_GE(pair.decide(0.1).lower, lower * (1.0 - 0x1p-44)) << apart;
  }
}

// The direction that separates two parts is rounded at every instant: per metre of both positions
// at both ends, and of the two centres. Halfway the two ends share the error.
TEST(SweptSearch, ABoundAlongADirectionAllowsForTheRoundingOfTheDirection) {
  constexpr double kFar = 0x1p20;
  Motion2 past;
  past.from = {test::at(kFar, 0, 0), test::at(kFar, -1.0, 1.0)};
  past.to = {test::at(kFar, 0, 0), test::at(kFar, 1.0, 1.0)};
  TwoInMotion pair(test::block({0.1, 4.0, 0.1}), test::block({0.1, 0.1, 0.1}), past);
  const double error = 0x1p-44 * 6.0 * kFar;
  const double lower = pair.decide(0.5).lower;
  EXPECT_LE(lower, pair.at_end().lower - 0.45 * error);
  EXPECT_GE(lower, pair.at_end().lower - 2.0 * error);
  EXPECT_EQ(pair.queries(), 2u);
}

// A ball comes from 1.3 m away, passes 0.8 m in a tick that leaves the pair as it is, and arrives
// at 0.3 m in the next one. Oracle: the distance at its end.
TEST(SweptSearch, AnOldBoundIsReducedByAllMotionSinceThenAndByThatOfThisTick) {
  Motion2 motion;
  motion.from = {test::at(0, 0, 0), test::at(1.0, 0, 0)};
  motion.to = {test::at(0, 0, 0), test::at(0.5, 0, 0)};
  TwoInMotion balls(test::ball(0.1), test::ball(0.1), motion);
  const double lower = balls.from_old_bound(1.3, 0.5).lower;
  EXPECT_LE(lower, balls.truth(1.0).upper);
  EXPECT_NEAR(lower, 1.3 - 0.5 - 0.5 - 0.5, 1e-12) << "before this tick, in it, and back again";
}

TEST(SweptSearch, WithoutQueriesNothingIsTold) {
  Random random(92);
  TwoInMotion pair(any_part(random), any_part(random), any_motion(random));
  EXPECT_EQ(pair.decide(0.1, 1).lower, -kInfinity);
  EXPECT_EQ(pair.queries(), 0u);
}

// A plate, an object that flies past it, and one zone.
class FlyBy : public testing::Test {
 protected:
  explicit FlyBy(std::uint32_t budget = 100) {
    scene_ = test::cell_of({test::fixed("plate", {test::block({0.5, 0.5, 0.001})}, {}),
                            test::moving("dart", {test::capsule(0.05, 0.002)}),
                            test::moving("other", {test::ball(0.1)})});
    scene_.zones = {test::zone_over(scene_, 0.05, 0.06)};
    scene_.budget = budget;
    for (ObjectPair& pair : scene_.pairs) pair.publish = true;
  }
  const Report& tick(Monitor& monitor, const Pose& dart) {
    now_ += kTick;
    const std::array samples{test::sample(1, dart, now_), test::sample(2, test::at(5, 5, 5), now_)};
    return monitor.tick(samples, now_);
  }
  Scene scene_;
  std::int64_t now_ = kStart;
};

TEST_F(FlyBy, AZoneIsEnteredByWhatFliesThroughBetweenTwoTicks) {
  for (const std::uint32_t budget : {0u, 2u, 100u}) {
    scene_.budget = budget;
    Monitor monitor(scene_);
    EXPECT_FALSE(tick(monitor, test::at(0.1, 0.1, 0.6)).zones[0].active && budget == 100);
    tick(monitor, test::at(0.1, 0.1, 0.6));
    const Report& report = tick(monitor, test::at(0.1, 0.15, -0.6));
    EXPECT_TRUE(report.zones[0].active) << budget;
    EXPECT_EQ(report.zones[0].pair, 0u);
    EXPECT_LT(report.zones[0].swept_clearance, 0.05);
    EXPECT_LE(report.swept_lower_all, 0.05);
    if (budget < 100) continue;
    EXPECT_GT(report.zones[0].clearance, 0.5) << "gone again";
    EXPECT_TRUE(report.zones[0].certified);
    EXPECT_LT(report.pairs[0].swept_lower, 0.05);
    EXPECT_FALSE(tick(monitor, test::at(0.1, 0.15, -0.6)).zones[0].active);
  }
}

TEST_F(FlyBy, AZoneIsNotEnteredByWhatFliesPastOutside) {
  Monitor monitor(scene_);
  tick(monitor, test::at(0.3, 1.0, 0.0));
  const Report& report = tick(monitor, test::at(1.0, 0.3, 0.0));  // 0.1 m from the vertex
  EXPECT_FALSE(report.zones[0].active);
  EXPECT_TRUE(report.zones[0].certified);
  EXPECT_GE(report.zones[0].swept_clearance, 0.05);
  EXPECT_GE(report.pairs[0].swept_lower, 0.05);
}

TEST_F(FlyBy, FirstPosesAndThoseAfterAGapHaveNoPathBehindThem) {
  Monitor monitor(scene_);
  const Report& first = tick(monitor, test::at(0, 0, 1.0));
  EXPECT_FALSE(first.zones[0].active);
  EXPECT_EQ(first.pairs[0].swept_lower, first.pairs[0].lower);
  now_ += 100 * kTick;
  EXPECT_TRUE(monitor.tick({}, now_).zones[0].active) << "late, and nobody said how fast it is";
  const Report& back = tick(monitor, test::at(0, 0, -1.0));
  EXPECT_FALSE(back.zones[0].active);
  EXPECT_EQ(back.pairs[0].swept_lower, back.pairs[0].lower);
}

TEST_F(FlyBy, ADiscontinuityOfTenKilometresEntersEveryZoneOfTheObject) {
  Monitor monitor(scene_);
  tick(monitor, test::at(0, 0, 1.0));
  const Report& report = tick(monitor, test::at(2e4, 0, 0));
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_FALSE(report.zones[0].certified);
  EXPECT_EQ(report.pairs[0].swept_lower, -kInfinity);
  EXPECT_EQ(report.swept_lower_all, -kInfinity);
  EXPECT_GT(report.lower_all, 1.0);
  EXPECT_FALSE(tick(monitor, test::at(2e4, 0, 0)).zones[0].active);
}

}  // namespace
}  // namespace clearance
