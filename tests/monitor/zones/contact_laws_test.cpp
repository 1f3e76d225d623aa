// An allowed contact changes the status of its pairs, and no figure of the tick.
//
// Oracles: the closed form for balls, now and at instants between ticks; the same motion without
// the allowance.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/zones/lift.hpp"

namespace clearance {
namespace {

using test::kDepth;
using test::kStart;
using test::kTick;
using test::kTouching;
using test::lift;

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
TEST(ContactLaws, AnAllowanceChangesNoBoundAndOnlyTheZonesOfItsPairs) {
  std::int64_t now = kStart;
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
