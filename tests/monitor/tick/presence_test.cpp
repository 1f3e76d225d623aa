// Objects that are known to be absent.
//
// Oracles: the closed form for capsules. For the trust after an absence, a monitor that was created
// afterwards and has no earlier inputs.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kLeft = 0, kMiddle = 1, kRight = 2;

// Three balls of radius 0.1 on a line. All pairs are published and belong to one zone that ends at
// 0.3 m.
class Presence : public testing::Test {
 protected:
  Presence() {
    std::vector<Object> balls(3, test::moving("ball", {test::ball(0.1)}));
    scene = test::cell_of(std::move(balls));
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
    make();
  }
  void make() { monitor.emplace(scene); }

  // Runs a tick with poses of these balls at x.
  const Report& tick(const std::vector<std::pair<std::uint32_t, double>>& places) {
    now += test::kTick;
    std::vector<PoseSample> samples;
    for (const auto& [object, x] : places)
      samples.push_back(test::sample(object, test::at(x, 0, 0), now));
    return monitor->tick(samples, now);
  }
  // Runs a tick with all balls, at distances of 1 m.
  const Report& tick_all() { return tick({{kLeft, 0.0}, {kMiddle, 1.0}, {kRight, 2.0}}); }
  const Report& tick_outer() { return tick({{kLeft, 0.0}, {kRight, 2.0}}); }

  Scene scene;  // pairs: left-middle, left-right, middle-right
  std::optional<Monitor> monitor;
  std::int64_t now = test::kStart;
};

TEST_F(Presence, AnAbsentObjectsPairsAreAbsentWithoutFiguresAndWithBoundsThatSayNothing) {
  tick_all();
  EXPECT_TRUE(monitor->set_absent(kMiddle, true));
  const Report& report = tick_outer();
  for (const std::uint32_t pair : {0u, 2u}) {
    const PairReport& absent = report.pairs[pair];
    EXPECT_EQ(absent.status, PairStatus::kAbsent);
    EXPECT_STREQ(name(absent.status), "absent");
    EXPECT_EQ(absent.lower, -kInfinity);
    EXPECT_EQ(absent.swept_lower, -kInfinity);
    EXPECT_EQ(absent.upper, kInfinity);
    for (const double figure : {absent.distance, absent.closing_speed, absent.time_to_contact,
                                absent.normal.x(), absent.witness_a.x(), absent.witness_b.x()})
      EXPECT_TRUE(std::isnan(figure));
    EXPECT_EQ(absent.evaluated_cycle, 0u);
    EXPECT_EQ(monitor->pair(pair).status, PairStatus::kAbsent);
    EXPECT_EQ(monitor->sweep(pair, 1.0).lower, -kInfinity);
  }
  EXPECT_EQ(report.pairs[0].age_b_ns, -1) << "no pose of it is in use";
  EXPECT_EQ(report.pairs[1].status, PairStatus::kConverged);
  EXPECT_TRUE(monitor->input_age(kMiddle).absent);
}

TEST_F(Presence, AbsentPairsAreWhatTheOtherFourCountsLeaveOfTheTotal) {
  EXPECT_EQ(absent_pairs(tick_all()), 0u);
  monitor->set_absent(kMiddle, true);
  const Report& one = tick_outer();
  EXPECT_EQ(absent_pairs(one), 2u);
  EXPECT_EQ(one.evaluated + one.carried, 1u);
  EXPECT_EQ(one.stale + one.unknown, 0u);
  monitor->set_absent(kRight, true);
  EXPECT_EQ(absent_pairs(tick({{kLeft, 0.0}})), 3u) << "a pair of two absent objects counts once";
  monitor->set_absent(kMiddle, false);
  monitor->set_absent(kRight, false);
  const Report& back = tick({{kLeft, 0.0}});
  EXPECT_EQ(absent_pairs(back), 0u);
  EXPECT_EQ(back.unknown, 3u);
}

TEST_F(Presence, AnObjectThatWasNeverHeardOfMakesItsZoneActiveAndAnAbsentOneDoesNot) {
  tick_outer();
  ASSERT_TRUE(tick_outer().zones[0].active) << "the middle one may be anywhere";
  monitor->set_absent(kMiddle, true);
  const ZoneReport& zone = tick_outer().zones[0];
  EXPECT_FALSE(zone.active);
  EXPECT_TRUE(zone.certified);
  EXPECT_TRUE(zone.changed);
  EXPECT_NEAR(zone.clearance, 1.8, 1e-9) << "of the pair that is left";
  EXPECT_EQ(zone.pair, 1u);
}

TEST_F(Presence, AZoneIsLeftWhenTheObjectInItIsAbsent) {
  tick({{kLeft, 0.0}, {kMiddle, 0.3}, {kRight, 2.0}});
  ASSERT_EQ(tick({{kLeft, 0.0}, {kMiddle, 0.3}, {kRight, 2.0}}).zones[0].cause, ZoneCause::kNear);
  monitor->set_absent(kMiddle, true);
  EXPECT_FALSE(tick_outer().zones[0].active);
}

TEST_F(Presence, AZoneWhosePairsAreAllAbsentIsInactiveAndHasNoClearance) {
  monitor->set_absent(kMiddle, true);
  monitor->set_absent(kLeft, true);
  const ZoneReport& zone = tick({}).zones[0];
  EXPECT_FALSE(zone.active) << "though the right one was never heard of";
  EXPECT_TRUE(zone.certified);
  EXPECT_EQ(zone.clearance, kInfinity);
}

TEST_F(Presence, AnUnknownObjectKeepsAZoneActiveByItsPairsWithObjectsThatAreThere) {
  monitor->set_absent(kLeft, true);
  const ZoneReport& zone = tick({{kMiddle, 1.0}}).zones[0];
  EXPECT_TRUE(zone.active);
  EXPECT_EQ(zone.pair, 2u) << "middle and right";
  EXPECT_EQ(zone.cause, ZoneCause::kUnknown);
  EXPECT_EQ(zone.cause_object, kRight);
}

TEST_F(Presence, TheMinimumIsCertifiedWithoutAbsentObjects) {
  tick_outer();
  const Report& unknown = tick_outer();
  EXPECT_FALSE(unknown.minimum_certified);
  EXPECT_EQ(unknown.lower_all, -kInfinity);
  monitor->set_absent(kMiddle, true);
  const Report& report = tick_outer();
  EXPECT_TRUE(report.minimum_certified);
  EXPECT_EQ(report.minimum.pair, 1u);
  EXPECT_NEAR(report.lower_all, 1.8, 1e-9);
  EXPECT_NEAR(report.swept_lower_all, 1.8, 1e-9);
}

TEST_F(Presence, ThereIsNoMinimumWhileAllPairsAreAbsent) {
  tick_all();
  for (const std::uint32_t object : {kLeft, kMiddle, kRight}) monitor->set_absent(object, true);
  const Report& report = tick({});
  EXPECT_FALSE(report.minimum_known);
  EXPECT_FALSE(report.minimum_certified);
  EXPECT_EQ(report.lower_all, kInfinity);
  EXPECT_EQ(report.newest_pose_ns, 0);
}

TEST_F(Presence, PosesOfAnAbsentObjectAreRefusedAsThoseOfNoObject) {
  tick_all();
  monitor->set_absent(kMiddle, true);
  const Report& report = tick_all();
  EXPECT_EQ(report.pairs[0].status, PairStatus::kAbsent);
  EXPECT_EQ(report.rejected[static_cast<std::size_t>(Reject::kUnknownObject)], 1u);
  EXPECT_EQ(monitor->rejected(kMiddle)[static_cast<std::size_t>(Reject::kUnknownObject)], 1u);
  monitor->set_absent(kMiddle, false);
  EXPECT_EQ(monitor->rejected(kMiddle)[static_cast<std::size_t>(Reject::kUnknownObject)], 1u)
      << "counts go on";
}

TEST_F(Presence, AnObjectThatIsPresentAgainIsUnknownUntilItsNextPose) {
  tick_all();
  monitor->set_absent(kMiddle, true);
  tick_outer();
  monitor->set_absent(kMiddle, false);
  const Report& silent = tick_outer();
  EXPECT_EQ(silent.pairs[0].status, PairStatus::kUnknown);
  EXPECT_EQ(silent.unknown, 2u);
  EXPECT_TRUE(silent.zones[0].active);
  EXPECT_EQ(silent.lower_all, -kInfinity);
  const Report& heard = tick({{kLeft, 0.0}, {kMiddle, 0.7}, {kRight, 2.0}});
  EXPECT_EQ(heard.pairs[0].status, PairStatus::kConverged);
  EXPECT_NEAR(heard.pairs[0].distance, 0.5, 1e-9);
  EXPECT_EQ(heard.pairs[0].swept_lower, heard.pairs[0].lower) << "as of a pair that is new";
  EXPECT_TRUE(std::isnan(heard.pairs[0].closing_speed)) << "two poses make a velocity";
}

TEST_F(Presence, AnAbsenceBetweenTwoTicksIsOneToo) {
  tick_all();
  monitor->set_absent(kMiddle, true);
  monitor->set_absent(kMiddle, false);
  EXPECT_EQ(tick_outer().pairs[0].status, PairStatus::kUnknown);
}

TEST_F(Presence, WithoutABudgetNoEvaluationFromBeforeTheAbsenceIsShown) {
  scene.budget = 6;
  make();
  tick_all();
  ASSERT_GT(tick_all().pairs[0].evaluated_cycle, 0u);
  scene.budget = 0;  // the monitor reads the scene, which outlives it
  monitor->set_absent(kMiddle, true);
  tick_outer();
  monitor->set_absent(kMiddle, false);
  const Report& report = tick({{kLeft, 0.0}, {kMiddle, 0.7}, {kRight, 2.0}});
  EXPECT_EQ(report.pairs[0].status, PairStatus::kCarried);
  EXPECT_EQ(report.pairs[0].evaluated_cycle, 0u);
  EXPECT_TRUE(std::isnan(report.pairs[0].distance));
  EXPECT_LE(report.pairs[0].lower, 0.5);
  EXPECT_GE(report.pairs[0].upper, 0.5);
}

TEST_F(Presence, FixedObjectsAndThoseThatTheCellDoesNotHaveCannotBeAbsent) {
  scene.objects[kLeft].fixed = true;
  make();
  EXPECT_FALSE(monitor->set_absent(kLeft, true));
  EXPECT_FALSE(monitor->set_absent(3, true));
  EXPECT_EQ(absent_pairs(tick({{kMiddle, 1.0}, {kRight, 2.0}})), 0u);
}

TEST_F(Presence, SayingItTwiceIsSayingItOnce) {
  tick_all();
  monitor->set_absent(kMiddle, true);
  monitor->set_absent(kMiddle, true);
  EXPECT_EQ(absent_pairs(tick_outer()), 2u);
  monitor->set_absent(kMiddle, false);
  tick_all();
  monitor->set_absent(kMiddle, false);
  EXPECT_EQ(tick_all().evaluated, 3u) << "an object that is there stays known";
}

TEST_F(Presence, AllocatesNothing) {
  tick_all();
  tick_all();
  const std::uint64_t before = allocations();
  for (int i = 0; i < 3; ++i) {
    for (const bool absent : {true, false}) {
      for (const std::uint32_t object : {kLeft, kMiddle, kRight})
        monitor->set_absent(object, absent);
      monitor->tick({}, now += test::kTick);
    }
  }
  EXPECT_EQ(allocations(), before);
}

// Twelve bars that rotate, jump, leave and return. A budget of a few queries per tick evaluates
// hardly any of them. Bounds from before an absence would not hold.
class ComingAndGoing {
 public:
  ComingAndGoing(std::uint64_t seed, std::uint32_t budget) : random_(seed) {
    std::vector<Object> bars(12, test::moving("bar", {test::capsule(0.6, 0.05)}));
    scene_ = test::cell_of(std::move(bars));
    for (std::size_t p = 0; p < scene_.pairs.size(); p += 5) scene_.pairs[p].publish = true;
    scene_.zones.push_back(test::zone_over(scene_, 0.05, 0.1));
    scene_.budget = budget;
    monitor_.emplace(scene_);
    for (Bar& bar : bars_) bar.pose = anywhere();
  }

  void step() {
    now_ += test::kTick;
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < bars_.size(); ++i) {
      Bar& bar = bars_[i];
      if (random_.chance(0.02)) {
        bar.absent = !bar.absent;
        bar.heard = false;
        EXPECT_TRUE(monitor_->set_absent(i, bar.absent));
        bar.pose = anywhere();
      }
      if (random_.chance(0.5)) bar.pose.position += random_.in_box(0.01);
      const bool sent = !bar.absent && (bar.heard || random_.chance(0.2));
      if (sent) samples.push_back(test::sample(i, bar.pose, now_));
      bar.heard = bar.heard || sent;
    }
    judge(monitor_->tick(samples, now_));
  }
  int certified() const { return certified_; }

 private:
  struct Bar {
    Pose pose;
    bool absent = false, heard = false;
  };
  Pose anywhere() { return {random_.in_box(1.5), random_.rotation()}; }

  void judge(const Report& report) {
    std::uint32_t absent = 0, unknown = 0;
    double least = kInfinity;
    for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
      const Bar &a = bars_[scene_.pairs[p].first], &b = bars_[scene_.pairs[p].second];
      const PairReport pair = monitor_->pair(p);
      ASSERT_EQ(pair.status == PairStatus::kAbsent, a.absent || b.absent);
      absent += a.absent || b.absent;
      if (a.absent || b.absent) continue;
      ASSERT_EQ(pair.status == PairStatus::kUnknown, !a.heard || !b.heard);
      unknown += !a.heard || !b.heard;
      if (!a.heard || !b.heard) continue;
      const auto truth =
          static_cast<double>(test::true_distance(scene_.objects[scene_.pairs[p].first], a.pose,
                                                  scene_.objects[scene_.pairs[p].second], b.pose));
      least = std::min(least, truth);
      if (truth < 0.0) continue;  // the closed form gives no depth
      ASSERT_LE(pair.lower, truth + 1e-12) << "pair " << p;
      ASSERT_GE(pair.upper, truth - 1e-12) << "pair " << p;
      ASSERT_LE(pair.swept_lower, pair.lower);
      ASSERT_TRUE(truth >= 0.05 || report.zones[0].active);
    }
    ASSERT_EQ(absent_pairs(report), absent);
    ASSERT_EQ(report.unknown, unknown);
    ASSERT_TRUE(unknown == 0 || report.zones[0].active);
    ASSERT_TRUE(least <= 0.0 || report.lower_all <= least + 1e-12);
    if (!report.minimum_certified) return;
    ++certified_;
    ASSERT_EQ(unknown, 0u);
    if (least <= 0.0) return;
    ASSERT_LE(report.minimum.lower, least + 1e-12);
    ASSERT_GE(report.minimum.upper, least - 1e-12);
  }

  Random random_;
  Scene scene_;
  std::optional<Monitor> monitor_;
  std::array<Bar, 12> bars_;
  std::int64_t now_ = test::kStart;
  int certified_ = 0;
};

TEST(PresenceCampaign, BoundsHoldWhoeverComesAndGoesWhateverTheBudget) {
  int certified = 0;
  for (const std::uint32_t budget : {0u, 3u, 20u, 200u}) {
    ComingAndGoing cell(budget + 1, budget);
    for (int step = 0; step < 1500; ++step) {
      cell.step();
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << "budget " << budget << ", step " << step;
    }
    certified += cell.certified();
  }
  EXPECT_GT(certified, 200);
}

}  // namespace
}  // namespace clearance
