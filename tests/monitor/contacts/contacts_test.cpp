// Contact that is meant, in the tick.
//
// Oracles: the closed form for balls, now and at instants between ticks; the same motion without
// the allowance; a model of the zone by what the scene allows.
#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <memory>
#include <numbers>
#include <optional>

#include "tests/monitor/scara_cell.hpp"
#include "tests/monitor/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

constexpr double kDepth = 0.002;    // m, allowed
constexpr double kTouching = 0.2;   // distance of the centres at which two balls touch, m
constexpr std::uint32_t kPart = 0;  // the object that moves

AllowedContact lift(std::vector<std::uint32_t> pairs) {
  AllowedContact contact;
  contact.name = "lift";
  contact.depth = kDepth;
  contact.by = "planner";
  contact.pairs = std::move(pairs);
  return contact;
}

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

class Contacts : public testing::Test {
 protected:
  Contacts() { begin(part_on_table()); }
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

TEST_F(Contacts, AnAllowedContactMakesNoZoneActiveAndIsReportedAsWhatItIs) {
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

TEST_F(Contacts, TheMinimumAndTheBoundOfAllPairsIncludeAnAllowedContact) {
  const Report& report = rest(kTouching - 0.001);
  EXPECT_EQ(report.minimum.pair, 0u);
  EXPECT_NEAR(report.minimum.distance, -0.001, 1e-12);
  EXPECT_TRUE(report.minimum_certified);
  EXPECT_LE(report.lower_all, report.minimum.distance);
  EXPECT_EQ(report.contacts[0].pair, report.minimum.pair) << "so a client sees that it is allowed";
}

TEST_F(Contacts, APairThatIsNearWithoutTouchingIsAllowedToo) {
  EXPECT_FALSE(rest(kTouching + 0.01).zones[0].active);
  EXPECT_EQ(rest(kTouching + 0.01).contacts[0].depth, 0.0);
}

TEST_F(Contacts, OtherPairsOfTheZoneStillMakeItActive) {
  const Report& report = rest(1.0 - kTouching - 0.001);
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kNear);
  EXPECT_EQ(report.zones[0].pair, 1u);
}

// The margin is a thousand times the rounding of the distance.
TEST_F(Contacts, DeeperThanAllowedByATrifleIsAViolation) {
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
TEST_F(Contacts, DeeperThanAllowedBetweenTwoTicksIsAViolation) {
  rest(kTouching - 0.001);
  const Report& report = tick(-kTouching + 0.001);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kTooDeep);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContactTooDeep);
  EXPECT_GE(report.contacts[0].depth, 0.199);
  EXPECT_FALSE(tick(-kTouching + 0.001).zones[0].active);
}

// The bound by both ends, without queries between the ticks, would be 10.8 mm deep.
TEST_F(Contacts, AFastSlideThatStaysWithinTheDepthIsNoViolation) {
  tick(Vec3(kTouching - 0.001, -0.01, 0));
  const Report& report = tick(Vec3(kTouching - 0.001, 0.01, 0));
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kAllowed);
  EXPECT_GE(report.contacts[0].depth, 0.001);
  EXPECT_FALSE(report.zones[0].active);
}

TEST_F(Contacts, ALowerBoundOfMinusInfinityIsAViolation) {
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

TEST_F(Contacts, APoseThatFreezesDuringAnAllowedContactMakesTheZoneActive) {
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

TEST_F(Contacts, APoseThatWasNeverHeardMakesTheZoneActive) {
  const Report& report = tick_without_pose();
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.contacts[0].depth, kInfinity);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kUnknown);
}

TEST_F(Contacts, AContradictedPoseMakesTheZoneActive) {
  Scene scene = part_on_table();
  scene.objects[kPart].may_jump = false;
  scene.objects[kPart].max_speed = 1.0;
  begin(scene);
  rest(kTouching - 0.001);
  const Report& report = tick(0.5);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kContradicted);
}

TEST_F(Contacts, ADiscontinuityMakesTheZoneActive) {
  rest(kTouching - 0.001);
  tick(5e4);
  const Report& report = tick(kTouching - 0.001);
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kUnknown);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kDiscontinuous);
  EXPECT_FALSE(tick(kTouching - 0.001).zones[0].active);
}

TEST_F(Contacts, AnAbsentObjectHasNoContact) {
  rest(kTouching - 0.001);
  ASSERT_TRUE(monitor->set_absent(kPart, true));
  const Report& report = tick_without_pose();
  EXPECT_EQ(report.contacts[0].status, ContactStatus::kAbsent);
  EXPECT_FALSE(report.zones[0].active);
  ASSERT_TRUE(monitor->set_absent(kPart, false));
  EXPECT_TRUE(tick_without_pose().zones[0].active);
  EXPECT_EQ(tick(kTouching - 0.001).contacts[0].status, ContactStatus::kAllowed);
}

// The tick in which the pair is far enough is the last of the allowance.
TEST_F(Contacts, TheContactEndsAfterTheTickInWhichThePairIsCertifiedToBeFarEnough) {
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

TEST_F(Contacts, AZoneBelowTheDistanceThatEndsTheContactStaysClear) {
  begin_with({.distance = 0.1});
  for (const double gap : {-0.001, 0.02, 0.07, 0.11, 0.12})
    EXPECT_FALSE(tick(kTouching + gap).zones[0].active) << gap;
  EXPECT_EQ(tick(kTouching + 0.12).contacts[0].status, ContactStatus::kEnded);
  EXPECT_TRUE(tick(kTouching + 0.02).zones[0].active);
}

TEST_F(Contacts, LaterThanAllowedIsAViolation) {
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

TEST_F(Contacts, TheFirstOfSeveralEndsCounts) {
  begin_with({.distance = 0.01, .duration_ns = 50 * kTick, .last_cycle = 100});
  tick(kTouching + 0.02);
  EXPECT_EQ(tick(kTouching).contacts[0].ended, ContactEnded::kByDistance);
  begin_with({.distance = 0.01, .duration_ns = 50 * kTick, .last_cycle = 2});
  rest(kTouching);
  EXPECT_EQ(tick(kTouching).contacts[0].ended, ContactEnded::kByCycle);
}

TEST_F(Contacts, AnAllowanceGoesOnAcrossAChangeOfTheScene) {
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

TEST_F(Contacts, WhatHasEndedStaysSoAcrossAChangeOfTheScene) {
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

TEST_F(Contacts, ATickWithContactsAllocatesNothing) {
  begin_with({.distance = 0.1});
  rest(kTouching - 0.001);
  const std::uint64_t before = allocations();
  for (int i = 0; i < 200; ++i) tick(Vec3(kTouching - 0.003 + 1e-3 * i, 1e-3 * (i % 7), 0));
  EXPECT_EQ(allocations(), before);
}

// Two balls may touch a third and each other; the fourth may not touch any.
struct RandomContacts {
  explicit RandomContacts(std::uint32_t budget) {
    std::vector<Object> objects;
    for (const char* name : {"a", "b", "c", "d"})
      objects.push_back(test::moving(name, {test::ball(0.1)}));
    scene = test::cell_of(std::move(objects));
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.budget = budget;
    scene.refresh_s = 1.0;
    for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair)
      scene.zones.push_back({"zone", "", "", 0.05, 0.06, {pair}});
    plain = scene;
    scene.contacts.push_back(lift({0, 1, 3}));
    scene.contacts[0].end.distance = 0.15;
  }
  // Balls that swing about places in each other's surfaces.
  static Vec3 centre(std::uint32_t object, double t) {
    const double phase = 1.3 * object, swing = 0.003 * std::sin(3.0 * t + phase);
    const double leave = object == 1 ? 0.3 * std::max(0.0, std::sin(0.7 * t)) : 0.0;
    const std::array<Vec3, 4> rest{Vec3(0, 0, 0), Vec3(kTouching, 0, 0),
                                   Vec3(0.5 * kTouching, 0.5 * std::sqrt(3.0) * kTouching, 0),
                                   Vec3(0, -0.26, 0)};
    return rest[object] + Vec3(swing + leave, 0.5 * swing, 0.02 * std::cos(2.0 * t + phase));
  }
  // The true distance at any instant of the last tick, in 33 steps, m.
  double least_distance(const ObjectPair& pair, double before, double now) const {
    double least = kInfinity;
    for (int i = 0; i <= 32; ++i) {
      const double s = i / 32.0;
      const auto at = [&](std::uint32_t object) {
        return Vec3((1.0 - s) * centre(object, before) + s * centre(object, now));
      };
      least = std::min(least, (at(pair.first) - at(pair.second)).norm() - kTouching);
    }
    return least;
  }

  Scene scene, plain;
};

// Zones differ from those without the allowance only where the pair is allowed. Whatever the budget
// is, a pair is allowed only if it is truly as deep as that at most.
TEST_F(Contacts, AnAllowanceChangesNoBoundAndOnlyTheZonesOfItsPairs) {
  for (const std::uint32_t budget : {2000u, 12u, 3u}) {
    const RandomContacts cell(budget);
    Monitor allowing(cell.scene), plain(cell.plain);
    int allowed = 0, too_deep = 0, too_late = 0, cleared = 0;
    double before = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
      now += kTick;
      const double t = 1e-3 * tick;
      std::vector<PoseSample> samples;
      for (std::uint32_t i = 0; i < 4; ++i)
        samples.push_back(test::sample(i, {.position = RandomContacts::centre(i, t)}, now));
      const Report& with = allowing.tick(samples, now);
      const Report& without = plain.tick(samples, now);
      ASSERT_EQ(with.lower_all <= with.minimum.lower, true);
      for (std::uint32_t pair = 0; pair < with.pairs.size(); ++pair) {
        const double truth = cell.least_distance(cell.scene.pairs[pair], tick == 0 ? t : before, t);
        ASSERT_LE(with.pairs[pair].swept_lower, truth + 1e-12);
        if (budget == 2000) {
          ASSERT_EQ(with.pairs[pair].lower, without.pairs[pair].lower) << tick;
          ASSERT_EQ(with.pairs[pair].upper, without.pairs[pair].upper) << tick;
          ASSERT_EQ(with.pairs[pair].witness_a, without.pairs[pair].witness_a) << tick;
        }
        const auto contact = std::ranges::find(with.contacts, pair, &ContactReport::pair);
        const bool is_allowed =
            contact != with.contacts.end() && contact->status == ContactStatus::kAllowed;
        if (contact != with.contacts.end()) {
          too_deep += contact->status == ContactStatus::kTooDeep;
          too_late += contact->status == ContactStatus::kTooLate;
        }
        if (is_allowed) {
          ++allowed;
          cleared += without.zones[pair].active;
          ASSERT_GE(truth, -kDepth - 1e-12) << tick;
          ASSERT_FALSE(with.zones[pair].active) << tick;
        } else if (contact == with.contacts.end() && budget == 2000) {
          ASSERT_EQ(with.zones[pair].active, without.zones[pair].active) << tick;
        } else if (truth < 0.05 - 1e-12) {
          ASSERT_TRUE(with.zones[pair].active) << tick;
        }
        // With all queries, the bounds are as narrow as rounding and the motion of a tick.
        const bool is_clearly_within = contact != with.contacts.end() &&
                                       contact->ended == ContactEnded::kNot &&
                                       truth > -kDepth + 1e-4;
        if (budget == 2000) {
          ASSERT_TRUE(is_allowed || !is_clearly_within) << tick;
        }
      }
      before = t;
    }
    EXPECT_GT(allowed, 100) << budget;
    EXPECT_GT(cleared, 100) << budget;
    EXPECT_GT(too_deep, 100) << budget;
    EXPECT_GT(too_late, 100) << budget;
  }
}

// A box on the finger stands 1 mm deep in its support and is drawn away by the prismatic joint.
TEST(AttachedContacts, APayloadIsLiftedFromItsSupport) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
      "  - {name: support, fixed: true, pose: {xyz: [1.851, 0, 0]}, box: {size: [0.1, 1, 1]}}\n"
      "  - {name: payload, attached: {to: finger, touch: [lower]}, box: {size: [0.2, 0.2, 0.2]}}\n"
      "pairs: [{between: [arm, arm]}, {between: [arm, support]}]\n"
      "allowed_collisions: [{between: [lower, support], reason: test}, "
      "{between: [finger, support], reason: test}]\n"
      "zones: [{name: near, between: [payload, support], enter_below: 0.02, leave_above: 0.02}]\n"
      "contacts: [{name: lift, between: [payload, support], depth: 0.002, until: {distance: 0.03}, "
      "by: test, reason: it stands there}]\n",
      folder / "cell.yaml");
  Monitor monitor(scene);
  std::vector<ContactStatus> seen;
  for (int tick = 0; tick < 1100; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    // Out by 0.1 m, back to a depth of 1 mm.
    const double push = 0.1 * std::sin(tick * std::numbers::pi / 1000.0);
    const std::array joints{test::joint(0, 0.0, now), test::joint(1, 0.0, now),
                            test::joint(2, std::max(0.0, push), now)};
    const Report& report = monitor.tick({}, joints, now);
    ASSERT_EQ(report.contacts.size(), 1u);
    const ContactStatus status = report.contacts[0].status;
    if (seen.empty() || seen.back() != status) seen.push_back(status);
    const ZoneCause cause = report.zones[0].cause;
    ASSERT_EQ(status == ContactStatus::kTooLate, cause == ZoneCause::kContactTooLate) << tick;
    ASSERT_FALSE(status == ContactStatus::kAllowed && report.zones[0].active) << tick;
  }
  EXPECT_EQ(seen,
            (std::vector{ContactStatus::kAllowed, ContactStatus::kEnded, ContactStatus::kTooLate}));
}

}  // namespace
}  // namespace clearance
