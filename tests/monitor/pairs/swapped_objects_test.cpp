// Law: whatever a tick says of two objects does not depend on which of them the cell has first. The
// same world is told to two monitors, of which one has all objects in the opposite order. Inputs
// are lost, leap, contradict each other, go away and come back.
//
// Bounds since the last tick depend on the order in which parts are queried: both hold, and one may
// be tighter. Zones are compared where these are the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/zones/lift.hpp"

namespace clearance {
namespace {

using test::kTick;

struct Kind {
  bool has_errors;  // the cell states errors of places
  bool has_speeds;  // it states largest speeds, and the ball may not jump
  bool is_wide;     // the budget is enough for all pairs
};

std::uint32_t index_of(const Scene& scene, const std::string& name) {
  return static_cast<std::uint32_t>(std::ranges::find(scene.objects, name, &Object::name) -
                                    scene.objects.begin());
}
std::uint32_t pair_of(const Scene& scene, const std::string& a, const std::string& b) {
  const std::uint32_t first = index_of(scene, a), second = index_of(scene, b);
  const auto found = std::ranges::find_if(scene.pairs, [&](const ObjectPair& pair) {
    return std::minmax(pair.first, pair.second) == std::minmax(first, second);
  });
  return static_cast<std::uint32_t>(found - scene.pairs.begin());
}

// A person of two parts, a robot of two, a ball, a slab that stands, and what a sensor sees.
Scene world(const Kind& kind, bool is_reversed) {
  std::vector<Object> objects{
      test::moving("person", {test::capsule(0.3, 0.05),
                              test::block({0.05, 0.06, 0.07}, test::at(0, 0, 0.2))}),
      test::moving("robot", {test::block({0.3, 0.05, 0.04}), test::ball(0.1, test::at(0.4, 0, 0))}),
      test::moving("ball", {test::ball(0.1)}),
      test::fixed("slab", {test::block({1, 1, 0.1})}, test::at(0, 0, -0.8)),
      test::moving("seen", {test::ball(2.0)})};
  objects.back().sensor = 0;
  for (Object& object : objects) {
    if (kind.has_speeds) object.max_speed = 2.0;
    if (kind.has_errors) object.place_error = {.translation = 0.001, .rotation = 0.002};
  }
  if (kind.has_speeds) objects[2].may_jump = false;
  if (is_reversed) std::ranges::reverse(objects);
  Scene scene = test::cell_of(std::move(objects));
  scene.sensors.resize(1);
  scene.sensors[0].object = index_of(scene, "seen");
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.evaluate_all = kind.is_wide;
  scene.budget = kind.is_wide ? 100'000 : 4;
  scene.zones = {test::zone_over(scene, 0.1, 0.15), test::zone_over(scene, 0.4, 0.5)};
  scene.zones[1].pairs = {pair_of(scene, "person", "robot")};
  Separation terms;
  terms.reaction_time_ns = 100'000'000;
  terms.stopping_time_ns = 250'000'000;
  terms.stopping_distance = 0.125;
  terms.stopping_speed = 1.0;
  terms.human_is_first = {!is_reversed};
  scene.zones[1].separation = terms;
  scene.contacts.push_back(test::lift({pair_of(scene, "ball", "robot")}));
  return scene;
}

SeenCloud drawn_cloud(Random& random) {
  SeenCloud cloud = SeenCloud::of_points(40);
  std::vector<MeasuredPoint> points;
  for (int i = 0; i < 40; ++i) {
    const Vec3 at = random.in_box(0.9);
    points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                      static_cast<float>(at.z()), 0.01F});
  }
  EXPECT_EQ(cloud.points()->build(points, {Vec3::Zero(), 2.0}), CloudBuild::kBuilt);
  return cloud;
}

bool are_same(double one, double other, double tolerance) {
  if (std::isfinite(one) && std::isfinite(other)) return std::abs(one - other) <= tolerance;
  return one == other || (std::isnan(one) && std::isnan(other));
}

class SwappedObjects : public testing::TestWithParam<Kind> {
 protected:
  SwappedObjects() {
    scenes.reserve(2);
    for (const bool is_reversed : {false, true}) {
      scenes.push_back(world(GetParam(), is_reversed));
      monitors.push_back(std::make_unique<Monitor>(scenes.back()));
    }
    for (const Object& object : scenes[0].objects) poses[object.name] = random.pose(0.5);
    for (int i = 0; i < 4; ++i) clouds.push_back(drawn_cloud(random));
  }

  // The pose of an object that moves, in both monitors.
  void tell(const std::string& name, std::vector<std::vector<PoseSample>>& samples) {
    Pose& pose = poses[name];
    const double step = random.log_uniform(1e-5, 0.02);
    const Vec3 before = pose.position;
    pose.position = (pose.position + random.in_box(step)).cwiseMax(-0.7).cwiseMin(0.7);
    pose.orientation = Eigen::AngleAxisd(step, random.direction()) * pose.orientation;
    PoseSample sample = test::sample(0, pose, now);
    sample.has_twist = random.chance(0.5);
    sample.twist.linear = (pose.position - before) / 1e-3;
    if (random.chance(0.01)) sample.world_from_object.position.x() += 5e4;
    for (std::size_t m = 0; m < 2; ++m) {
      sample.object = index_of(scenes[m], name);
      samples[m].push_back(sample);
    }
  }
  void tick() {
    now += random.chance(0.1) ? 15 * kTick : kTick;
    std::vector<std::vector<PoseSample>> samples(2);
    for (const std::string name : {"person", "robot", "ball"}) {
      if (random.chance(0.02)) is_silent[name] = !is_silent[name];
      if (random.chance(0.02)) {
        is_absent[name] = !is_absent[name];
        for (std::size_t m = 0; m < 2; ++m)
          ASSERT_TRUE(monitors[m]->set_absent(index_of(scenes[m], name), is_absent[name]));
      }
      if (!is_silent[name] && random.chance(0.9)) tell(name, samples);
    }
    const bool is_shown = random.chance(0.1);
    const SeenCloud& cloud = clouds[random.next() % clouds.size()];
    for (std::size_t m = 0; m < 2; ++m) {
      if (is_shown) {
        ASSERT_TRUE(monitors[m]->show(
            0, {.cloud = &cloud, .stamp_ns = now, .world_from_sensor = poses["seen"]}));
      }
      reports[m] = &monitors[m]->tick(samples[m], now);
    }
  }

  void compare_pairs() {
    for (std::uint32_t p = 0; p < scenes[0].pairs.size(); ++p) {
      const ObjectPair& of = scenes[0].pairs[p];
      const std::string &a = scenes[0].objects[of.first].name,
                        &b = scenes[0].objects[of.second].name;
      SCOPED_TRACE(a + ", " + b);
      const PairReport one = monitors[0]->pair(p);
      const PairReport other = monitors[1]->pair(pair_of(scenes[1], a, b));
      ++statuses[one.status];
      EXPECT_EQ(one.age_a_ns, other.age_b_ns);
      EXPECT_EQ(one.age_b_ns, other.age_a_ns);
      EXPECT_EQ(is_known(one.status), is_known(other.status));
      EXPECT_LE(one.lower, other.upper + same);
      EXPECT_LE(other.lower, one.upper + same);
      if (!GetParam().is_wide) continue;
      EXPECT_EQ(one.status, other.status);
      expect_same(one.lower, other.lower, "lower");
      expect_same(one.upper, other.upper, "upper");
      expect_same(one.distance, other.distance, "distance");
      expect_same(one.model_error, other.model_error, "model_error");
      EXPECT_EQ(one.swept_lower == -kInfinity, other.swept_lower == -kInfinity);
      EXPECT_EQ(std::isnan(one.closing_speed), std::isnan(other.closing_speed));
    }
  }
  void compare_zones() {
    for (std::size_t z = 0; z < 2; ++z) {
      const ZoneReport &one = reports[0]->zones[z], &other = reports[1]->zones[z];
      expect_same(one.clearance, other.clearance, "clearance");
      if (!are_same(one.swept_clearance, other.swept_clearance, same)) continue;
      ++compared;
      EXPECT_EQ(one.active, other.active);
      if (z == 1) {
        EXPECT_EQ(one.cause, other.cause);
        EXPECT_EQ(one.certified, other.certified);
      }
    }
    const ContactReport &one = reports[0]->contacts[0], &other = reports[1]->contacts[0];
    if (are_same(one.depth, other.depth, same)) {
      EXPECT_EQ(one.status, other.status);
    }
    const PairSeparation &person = reports[0]->separated_pairs[0],
                         &same_person = reports[1]->separated_pairs[0];
    EXPECT_EQ(person.validity, same_person.validity);
    expect_same(person.clearance, same_person.clearance, "clearance of the person");
  }
  void expect_same(double one, double other, const char* what) const {
    EXPECT_TRUE(are_same(one, other, same)) << what << ": " << one << ", " << other;
  }

  // m: of two proofs of one distance. What errors of places may add is bounded to second order.
  const double same = GetParam().has_errors ? 1e-3 : 1e-7;
  Random random{20261129};
  std::vector<Scene> scenes;
  std::vector<std::unique_ptr<Monitor>> monitors;
  std::vector<SeenCloud> clouds;
  const Report* reports[2] = {};
  std::map<std::string, Pose> poses;
  std::map<std::string, bool> is_silent, is_absent;
  std::map<PairStatus, int> statuses;
  int compared = 0;  // zones
  std::int64_t now = test::kStart;
};

TEST_P(SwappedObjects, HaveTheSameBoundsZonesAndContacts) {
  for (int i = 0; i < 3'000; ++i) {
    SCOPED_TRACE(i);
    ASSERT_NO_FATAL_FAILURE(tick());
    compare_pairs();
    if (GetParam().is_wide) compare_zones();
    if (HasFailure()) return;
  }
  for (const PairStatus status : {PairStatus::kConverged, PairStatus::kOverlapping,
                                  PairStatus::kUnknown, PairStatus::kAbsent})
    EXPECT_GT(statuses[status], 100) << static_cast<int>(status);
  EXPECT_EQ(statuses[PairStatus::kStale] > 100, GetParam().has_speeds);
  EXPECT_EQ(compared > 4'000, GetParam().is_wide);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SwappedObjects,
                         testing::Values(Kind{false, false, true}, Kind{false, true, true},
                                         Kind{true, false, true}, Kind{true, true, true},
                                         Kind{false, true, false}, Kind{true, true, false}));

}  // namespace
}  // namespace clearance
