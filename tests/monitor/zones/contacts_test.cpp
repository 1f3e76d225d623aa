// Contact that is meant, in the tick.
//
// Oracles: the closed form for balls, now and at instants between ticks; the same motion without
// the allowance; a model of the zone by what the scene allows.
#include <gtest/gtest.h>

#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/zones/lift.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

using test::kDepth;
using test::kTouching;
using test::lift;

constexpr std::uint32_t kPart = 0;  // the object that moves

// The part may touch the table at the origin, not the wall 1 m along x. Both pairs are in the zone.
Scene part_on_table() {
  std::vector<Object> objects{test::moving("part", {test::ball(0.1)}),
                              test::fixed("table", {test::ball(0.1)}, test::at(0, 0, 0)),
                              test::fixed("wall", {test::ball(0.1)}, test::at(1, 0, 0))};
  Scene scene = test::cell_of(std::move(objects));
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.05, 0.06));
  scene.contacts.push_back(lift({0}));
  return scene;
}

class AllowedContacts : public testing::Test {
 protected:
  AllowedContacts() { begin(part_on_table()); }
  void begin(const Scene& scene) {
    scenes.push_back(scene);
    monitor = std::make_unique<Monitor>(scenes.back());
  }
  void begin_with(const ContactEnd& end) {
    Scene scene = part_on_table();
    scene.contacts[0].end = end;
    begin(scene);
  }
  void change(const Scene& scene) {
    scenes.push_back(scene);
    const Scene& before = *std::next(scenes.rbegin());
    auto changed = std::make_unique<Monitor>(scenes.back(), monitor.get());
    const SceneMap map = scene_map(before, scenes.back());
    SourceNumbers numbers(scenes.back());
    const std::uint64_t allocations_before = allocations();
    EXPECT_TRUE(changed->take_over(*monitor, map, numbers));
    EXPECT_EQ(allocations(), allocations_before);
    monitor = std::move(changed);
  }
  // Runs a tick with the part's centre here.
  const Report& tick(const Vec3& centre) {
    now += kTick;
    const PoseSample moved = test::sample(kPart, {.position = centre}, now);
    return monitor->tick(std::span(&moved, 1), now);
  }
  const Report& tick(double x) { return tick(Vec3(x, 0, 0)); }
  const Report& tick_without_pose() { return monitor->tick({}, now += kTick); }
  const Report& rest(double x) {
    tick(x);
    return tick(x);
  }

  std::list<Scene> scenes;
  std::unique_ptr<Monitor> monitor;
  std::int64_t now = kStart;
};

TEST_F(AllowedContacts, AnAllowedContactMakesNoZoneActiveAndIsReportedAsWhatItIs) {
  const Report& report = tick(kTouching - 0.001);
  EXPECT_FALSE(report.zones[0].active);
  EXPECT_TRUE(report.zones[0].certified);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kOverlapping);
  EXPECT_NEAR(report.pairs[0].distance, -0.001, 1e-12);
  ASSERT_EQ(report.contacts.size(), 1u);
  const ContactReport& contact = report.contacts[0];
  EXPECT_EQ(contact.contact, 0u);
  EXPECT_EQ(contact.pair, 0u);
  EXPECT_EQ(contact.status, ContactStatus::kAllowed);
  EXPECT_EQ(contact.ended, ContactEnded::kNot);
  EXPECT_NEAR(contact.depth, 0.001, 1e-12);
  EXPECT_GE(contact.depth, -report.pairs[0].distance);
  EXPECT_EQ(contact.since_cycle, 1u);
  EXPECT_EQ(contact.since_ns, now);
  EXPECT_EQ(contact.ended_cycle, 0u);
}

TEST_F(AllowedContacts, TheMinimumAndTheBoundOfAllPairsIncludeAnAllowedContact) {
  const Report& report = rest(kTouching - 0.001);
  EXPECT_EQ(report.minimum.pair, 0u);
  EXPECT_NEAR(report.minimum.distance, -0.001, 1e-12);
  EXPECT_TRUE(report.minimum_certified);
  EXPECT_LE(report.lower_all, report.minimum.distance);
  EXPECT_EQ(report.contacts[0].pair, report.minimum.pair) << "so a client sees that it is allowed";
}

TEST_F(AllowedContacts, APairThatIsNearWithoutTouchingIsAllowedToo) {
  EXPECT_FALSE(rest(kTouching + 0.01).zones[0].active);
  EXPECT_EQ(rest(kTouching + 0.01).contacts[0].depth, 0.0);
}

TEST_F(AllowedContacts, OtherPairsOfTheZoneStillMakeItActive) {
  const Report& report = rest(1.0 - kTouching - 0.001);
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kNear);
  EXPECT_EQ(report.zones[0].pair, 1u);
}

// The margin is a thousand times the rounding of the distance.
TEST_F(AllowedContacts, DeeperThanAllowedByATrifleIsAViolation) {
  constexpr double kTrifle = 1e-12;
  EXPECT_FALSE(rest(kTouching - kDepth + kTrifle).zones[0].active);
  const Report& report = rest(kTouching - kDepth - kTrifle);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kTooDeep);
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContactTooDeep);
  EXPECT_EQ(report.zones[0].pair, 0u);
  EXPECT_FALSE(rest(kTouching - kDepth + kTrifle).zones[0].active);
}

// At both ticks the depth is 1 mm. In between one ball goes through the other.
TEST_F(AllowedContacts, DeeperThanAllowedBetweenTwoTicksIsAViolation) {
  rest(kTouching - 0.001);
  const Report& report = tick(-kTouching + 0.001);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kTooDeep);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContactTooDeep);
  EXPECT_GE(report.contacts[0].depth, 0.199);
  EXPECT_FALSE(tick(-kTouching + 0.001).zones[0].active);
}

// The bound by both ends, without queries between the ticks, would be 10.8 mm deep.
TEST_F(AllowedContacts, AFastSlideThatStaysWithinTheDepthIsNoViolation) {
  tick(Vec3(kTouching - 0.001, -0.01, 0));
  const Report& report = tick(Vec3(kTouching - 0.001, 0.01, 0));
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kAllowed);
  EXPECT_GE(report.contacts[0].depth, 0.001);
  EXPECT_FALSE(report.zones[0].active);
}

TEST_F(AllowedContacts, ALowerBoundOfMinusInfinityIsAViolation) {
  Scene scene = test::cell_of({test::moving("plate", {test::floor()}),
                               test::fixed("ground", {test::floor()}, test::at(0, 0, 0))});
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.05, 0.06));
  scene.contacts.push_back(lift({0}));
  begin(scene);
  const Report& report = rest(0.0);
  ASSERT_EQ(report.pairs[0].lower, -kInfinity);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kTooDeep);
  EXPECT_EQ(report.contacts[0].depth, kInfinity);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContactTooDeep);
}

TEST_F(AllowedContacts, APoseThatFreezesDuringAnAllowedContactMakesTheZoneActive) {
  for (const double max_speed : {kInfinity, 1e-9}) {
    Scene scene = part_on_table();
    scene.objects[kPart].max_speed = max_speed;
    begin(scene);
    rest(kTouching - 0.001);
    Report report;
    for (int i = 0; i < 20; ++i) report = tick_without_pose();
    EXPECT_FALSE(report.zones[0].active) << "20 ms are the limit";
    report = tick_without_pose();
    EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
    EXPECT_TRUE(report.zones[0].active) << "however slow the object is";
    EXPECT_EQ(report.zones[0].cause, ZoneCause::kLate);
    EXPECT_EQ(report.zones[0].cause_object, kPart);
    EXPECT_FALSE(rest(kTouching - 0.001).zones[0].active);
  }
}

// After 25 ms without a pose, the part at 1 m/s may have been 25 mm deep, and no pose tells. Where
// its poses themselves lead through the table, that is too deep.
TEST_F(AllowedContacts, OfAPartThatWasLateAreUnknownAsFarAsItMayHaveMovedUnseen) {
  Scene scene = part_on_table();
  scene.objects[kPart].max_speed = 1.0;
  for (const bool goes_through : {false, true}) {
    begin(scene);
    rest(kTouching - 0.001);
    for (int i = 0; i < 25; ++i) tick_without_pose();
    const Report& report = tick(goes_through ? 0.001 - kTouching : kTouching - 0.001);
    EXPECT_EQ(report.contacts[0].status,
              goes_through ? ContactStatus::kTooDeep : ContactStatus::kUnknown);
    EXPECT_TRUE(report.zones[0].active);
    EXPECT_EQ(report.zones[0].cause, goes_through ? ZoneCause::kContactTooDeep : ZoneCause::kLate);
  }
}

TEST_F(AllowedContacts, APoseThatWasNeverHeardMakesTheZoneActive) {
  const Report& report = tick_without_pose();
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.contacts[0].depth, kInfinity);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kUnknown);
}

TEST_F(AllowedContacts, AContradictedPoseMakesTheZoneActive) {
  Scene scene = part_on_table();
  scene.objects[kPart].may_jump = false;
  scene.objects[kPart].max_speed = 1.0;
  begin(scene);
  rest(kTouching - 0.001);
  const Report& report = tick(0.5);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContradicted);
}

TEST_F(AllowedContacts, ADiscontinuityMakesTheZoneActive) {
  rest(kTouching - 0.001);
  tick(5e4);
  const Report& report = tick(kTouching - 0.001);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kDiscontinuous);
  EXPECT_FALSE(tick(kTouching - 0.001).zones[0].active);
}

TEST_F(AllowedContacts, AnAbsentObjectHasNoContact) {
  rest(kTouching - 0.001);
  ASSERT_TRUE(monitor->set_absent(kPart, true));
  const Report& report = tick_without_pose();
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kAbsent);
  EXPECT_FALSE(report.zones[0].active);
  ASSERT_TRUE(monitor->set_absent(kPart, false));
  EXPECT_TRUE(tick_without_pose().zones[0].active);
  EXPECT_EQ(tick(kTouching - 0.001).contacts[0].status, ContactStatus::kAllowed);
}

TEST_F(AllowedContacts, APartThatComesSecondIsLateOrAbsentLikeOneThatComesFirst) {
  for (const std::uint32_t part : {0U, 1U}) {
    std::vector<Object> objects{test::moving("part", {test::ball(0.1)}),
                                test::fixed("table", {test::ball(0.1)}, test::at(0, 0, 0))};
    if (part == 1) std::swap(objects[0], objects[1]);
    Scene scene = test::cell_of(std::move(objects));
    scene.pairs[0].publish = true;
    scene.zones.push_back(test::zone_over(scene, 0.05, 0.06));
    scene.contacts.push_back(lift({0}));
    const auto tick_part = [&](double x) -> const Report& {
      const PoseSample moved = test::sample(part, test::at(x, 0, 0), now += kTick);
      return monitor->tick(std::span(&moved, 1), now);
    };
    for (const bool has_ended : {false, true}) {
      scene.contacts[0].end.distance = has_ended ? 0.01 : kInfinity;
      begin(scene);
      if (has_ended) tick_part(kTouching + 0.02);
      tick_part(kTouching + 0.001);
      EXPECT_EQ(tick_part(kTouching + 0.001).contacts[0].status,
                has_ended ? ContactStatus::kEnded : ContactStatus::kAllowed);
      now += 30'000'000;
      const Report& late = tick_without_pose();
      EXPECT_EQ(late.contacts[0].status, ContactStatus::kUnknown);
      EXPECT_TRUE(late.zones[0].active);
      ASSERT_TRUE(monitor->set_absent(part, true));
      EXPECT_EQ(tick_without_pose().contacts[0].status, ContactStatus::kAbsent);
    }
  }
}

// The tick in which the pair is far enough is the last of the allowance.
TEST_F(AllowedContacts, TheContactEndsAfterTheTickInWhichThePairIsCertifiedToBeFarEnough) {
  begin_with({.distance = 0.01});
  rest(kTouching - 0.001);
  EXPECT_EQ(rest(kTouching + 0.01 - 1e-12).contacts[0].ended, ContactEnded::kNot);
  const Report& far = tick(kTouching + 0.01 + 1e-12);
  EXPECT_EQ(far.contacts[0].ended, ContactEnded::kNot);
  EXPECT_FALSE(far.zones[0].active);
  const Report& after = tick(kTouching + 0.01 + 1e-12);
  EXPECT_EQ(after.contacts[0].ended, ContactEnded::kByDistance);
  EXPECT_EQ(after.contacts[0].ended_cycle, after.cycle);
  EXPECT_EQ(after.contacts[0].ended_ns, now);
  EXPECT_EQ(after.contacts[0].status, ContactStatus::kEnded);
  EXPECT_EQ(after.zones[0].cause, ZoneCause::kNear) << "10 mm are in the zone";
  const Report& again = tick(kTouching - 0.001);
  EXPECT_EQ(again.contacts[0].status, ContactStatus::kTooLate);
  EXPECT_EQ(again.zones[0].cause, ZoneCause::kContactTooLate);
}

TEST_F(AllowedContacts, AZoneBelowTheDistanceThatEndsTheContactStaysClear) {
  begin_with({.distance = 0.1});
  for (const double gap : {-0.001, 0.02, 0.07, 0.11, 0.12})
    EXPECT_FALSE(tick(kTouching + gap).zones[0].active) << gap;
  EXPECT_EQ(tick(kTouching + 0.12).contacts[0].status, ContactStatus::kEnded);
  EXPECT_TRUE(tick(kTouching + 0.02).zones[0].active);
}

TEST_F(AllowedContacts, LaterThanAllowedIsAViolation) {
  const std::int64_t first = now + kTick;
  for (const auto& [end, ended] : std::initializer_list<std::pair<ContactEnd, ContactEnded>>{
           {{.duration_ns = 4 * kTick}, ContactEnded::kByTime},
           {{.time_ns = first + 4 * kTick}, ContactEnded::kByTime},
           {{.last_cycle = 5}, ContactEnded::kByCycle}}) {
    begin_with(end);
    now = first - kTick;
    for (int i = 0; i < 5; ++i) {
      const Report& report = tick(kTouching - 0.001);
      EXPECT_EQ(report.contacts[0].status, ContactStatus::kAllowed) << report.cycle;
      EXPECT_FALSE(report.zones[0].active) << report.cycle;
    }
    const Report& report = tick(kTouching - 0.001);
    EXPECT_EQ(report.contacts[0].status, ContactStatus::kTooLate);
    EXPECT_EQ(report.contacts[0].ended, ended);
    EXPECT_EQ(report.contacts[0].ended_cycle, 6u);
    EXPECT_TRUE(report.zones[0].active);
    EXPECT_EQ(report.zones[0].cause, ZoneCause::kContactTooLate);
    EXPECT_EQ(rest(kTouching + 0.01).contacts[0].status, ContactStatus::kEnded);
    EXPECT_EQ(rest(kTouching + 0.01).zones[0].cause, ZoneCause::kNear);
  }
}

TEST_F(AllowedContacts, TheFirstOfSeveralEndsCounts) {
  begin_with({.distance = 0.01, .duration_ns = 50 * kTick, .last_cycle = 100});
  tick(kTouching + 0.02);
  EXPECT_EQ(tick(kTouching).contacts[0].ended, ContactEnded::kByDistance);
  begin_with({.distance = 0.01, .duration_ns = 50 * kTick, .last_cycle = 2});
  rest(kTouching);
  EXPECT_EQ(tick(kTouching).contacts[0].ended, ContactEnded::kByCycle);
}

TEST_F(AllowedContacts, AnAllowanceGoesOnAcrossAChangeOfTheScene) {
  begin_with({.distance = 0.01});
  rest(kTouching - 0.001);
  const ContactReport before = tick(kTouching - 0.001).contacts[0];
  Scene changed = scenes.back();
  changed.objects[kPart].margin = 0.001;
  change(changed);
  const Report& report = tick(kTouching - 0.001);
  EXPECT_EQ(report.contacts[0].since_cycle, before.since_cycle);
  EXPECT_EQ(report.contacts[0].since_ns, before.since_ns);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kAllowed);
  EXPECT_FALSE(report.zones[0].active) << "the change itself is no violation";
  tick(kTouching + 0.02);  // far enough in the last tick before the second change
  change(part_on_table());
  EXPECT_EQ(tick(kTouching - 0.001).contacts[0].ended, ContactEnded::kNot)
      << "without the end it is another allowance";
}

TEST_F(AllowedContacts, WhatHasEndedStaysSoAcrossAChangeOfTheScene) {
  begin_with({.distance = 0.01});
  const Scene scene = scenes.back();
  rest(kTouching - 0.001);
  tick(kTouching + 0.02);
  change(scene);
  const Report& report = tick(kTouching - 0.001);
  EXPECT_EQ(report.contacts[0].ended, ContactEnded::kByDistance);
  EXPECT_EQ(report.contacts[0].ended_cycle, report.cycle);
  change(scene);
  EXPECT_EQ(tick(kTouching - 0.001).contacts[0].status, ContactStatus::kTooLate);
  Scene renewed = scene;
  renewed.contacts[0].depth = 0.003;
  change(renewed);
  EXPECT_EQ(tick(kTouching - 0.0025).contacts[0].status, ContactStatus::kAllowed)
      << "other terms begin anew";
}

TEST_F(AllowedContacts, ATickWithContactsAllocatesNothing) {
  begin_with({.distance = 0.1});
  rest(kTouching - 0.001);
  const std::uint64_t before = allocations();
  for (int i = 0; i < 200; ++i) tick(Vec3(kTouching - 0.003 + 1e-3 * i, 1e-3 * (i % 7), 0));
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace clearance
