// A monitor of a changed scene goes on where the one before it stands.
//
// Oracle: a monitor without a change.
#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <memory>
#include <string>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// Balls of radius 0.1 by name. All pairs are published and belong to the zone, which is entered
// below 0.3 m and left above 0.4 m.
Scene balls(const std::vector<std::string>& names) {
  std::vector<Object> objects;
  for (const std::string& name : names) {
    objects.push_back(test::moving(name, {test::ball(0.1)}));
    objects.back().may_jump = false;
    objects.back().max_speed = 2.0;
  }
  Scene scene = test::cell_of(std::move(objects));
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  return scene;
}

// Runs scenes one after another in one monitor each. Poses are along x, by the names of objects.
class TakeOver : public testing::Test {
 protected:
  void begin(const Scene& scene) {
    scenes.push_back(scene);
    numbers.emplace(scenes.back());
    monitor = std::make_unique<Monitor>(scenes.back());
  }
  void change(const Scene& scene) {
    scenes.push_back(scene);
    monitor = test::taken_over(*monitor, *std::next(scenes.rbegin()), scenes.back(), *numbers);
  }
  std::uint32_t object(const std::string& name) const {
    const auto& objects = scenes.back().objects;
    const auto found = std::ranges::find(objects, name, &Object::name);
    return static_cast<std::uint32_t>(found - objects.begin());
  }
  const Report& tick(const std::vector<std::pair<std::string, double>>& places,
                     const std::string& source = "arm") {
    now += kTick;
    std::vector<PoseSample> samples;
    for (const auto& [name, x] : places) {
      samples.push_back(test::sample(object(name), test::at(x, 0, 0), now));
      samples.back().source = numbers->of(SourceName(source));
    }
    return monitor->tick(samples, now);
  }

  std::list<Scene> scenes;
  std::optional<SourceNumbers> numbers;
  std::unique_ptr<Monitor> monitor;
  std::int64_t now = kStart;
};

// Poses may still be sent for the scene before, which was read elsewhere with all objects.
TEST_F(TakeOver, PosesThatAShareDoesNotReadAreNoneOfThoseInUse) {
  begin(balls({"a", "b", "c"}));
  tick({{"a", 0.0}, {"b", 1.0}, {"c", 2.0}});
  Scene share = balls({"a", "b", "c"});
  std::erase_if(share.pairs, [](const ObjectPair& pair) { return pair.second == 2; });
  share.zones = {test::zone_over(share, 0.3, 0.4)};
  share.objects[2].is_read = false;
  change(share);
  EXPECT_EQ(tick({{"a", 0.0}, {"b", 1.0}}).oldest_pose_ns, now);
  tick({{"a", 0.0}, {"b", 1.0}, {"c", 2.0}});
  EXPECT_EQ(tick({{"a", 0.0}, {"b", 1.0}}).oldest_pose_ns, now);
  for (const std::uint64_t count : monitor->rejected(2)) EXPECT_EQ(count, 0u);
}

TEST_F(TakeOver, PosesOfObjectsThatStayAreKnownAtOnceWhereverTheyStandInTheList) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  change(balls({"new", "b", "a"}));
  const Report& report = tick({});
  EXPECT_EQ(report.cycle, 2u);
  EXPECT_EQ(report.unknown, 2u) << "pairs of the new one";
  const PairReport& pair = report.pairs[2];
  EXPECT_EQ(pair.status, PairStatus::kConverged);
  EXPECT_NEAR(pair.distance, 0.8, 1e-12);
  EXPECT_EQ(pair.age_a_ns, kTick);
  EXPECT_TRUE(report.zones[0].active) << "the new one may be anywhere";
  EXPECT_EQ(tick({{"new", 5.0}}).unknown, 0u);
}

TEST_F(TakeOver, AZoneThatWasActiveStaysSoUntilItIsLeft) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 0.49}});
  ASSERT_TRUE(tick({{"b", 0.55}}).zones[0].active);
  const std::uint64_t since = tick({}).zones[0].since_cycle;
  Scene wider = balls({"b", "a"});
  wider.objects[0].margin = 0.01;
  change(wider);
  const Report& report = tick({});
  EXPECT_TRUE(report.zones[0].active) << "0.35 m are between the thresholds";
  EXPECT_EQ(report.zones[0].since_cycle, since);
  EXPECT_FALSE(report.zones[0].changed);
}

TEST_F(TakeOver, AZoneThatWasNotActiveIsNotEnteredByTheChange) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 0.56}});
  tick({{"b", 0.56}});
  ASSERT_FALSE(tick({}).zones[0].active) << "0.36 m are between the thresholds";
  change(balls({"b", "a"}));
  EXPECT_FALSE(tick({}).zones[0].active);
}

// A body passes another within the tick of the change.
TEST_F(TakeOver, AZoneThatIsCrossedInTheTickOfTheChangeIsNotMissed) {
  Scene scene = balls({"a", "b"});
  for (Object& object : scene.objects) object.max_speed = 5000.0;
  begin(scene);
  tick({{"a", -1.0}, {"b", 0.0}});
  ASSERT_FALSE(tick({{"a", -1.0}}).zones[0].active);
  Scene next = balls({"c", "a", "b"});
  for (Object& object : next.objects) object.max_speed = 5000.0;
  next.zones[0].pairs = {2};
  change(next);
  const Report& report = tick({{"a", 1.0}, {"c", 50.0}});
  EXPECT_NEAR(report.pairs[2].distance, 0.8, 1e-9);
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_LT(report.pairs[2].swept_lower, 0.0);
}

TEST_F(TakeOver, AContradictionIsNotForgotten) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  ASSERT_EQ(tick({{"a", 0.5}}).unknown, 1u) << "0.5 m in a tick";
  change(balls({"b", "a"}));
  EXPECT_EQ(tick({{"a", 0.5}}).unknown, 1u);
  EXPECT_EQ(tick({{"a", 0.0}}).unknown, 1u) << "for an age limit";
  EXPECT_TRUE(monitor->input_age(1).contradicted);
  EXPECT_EQ(monitor->rejected(1)[static_cast<std::size_t>(Reject::kTooFast)], 2u);
}

TEST_F(TakeOver, APoseThatIsLateStaysLate) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  for (int i = 0; i < 30; ++i) tick({{"b", 1.0}});
  ASSERT_EQ(tick({{"b", 1.0}}).stale, 1u);
  change(balls({"b", "a"}));
  const Report& report = tick({{"b", 1.0}});
  EXPECT_EQ(report.stale, 1u);
  EXPECT_NEAR(report.lower_all, 0.8 - 2.0 * 0.032, 1e-9);
}

TEST_F(TakeOver, TheOwnerStaysAndARivalIsStillRefused) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  change(balls({"b", "a"}));
  tick({{"a", 0.0}}, "rival");
  EXPECT_EQ(monitor->rejected(1)[static_cast<std::size_t>(Reject::kOtherSource)], 1u);
  EXPECT_EQ(monitor->input_age(1).source, numbers->of(SourceName("arm")));
}

TEST_F(TakeOver, AnObjectWhoseSourceIsStatedOtherwiseWaitsForThatSource) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  Scene next = balls({"b", "a"});
  next.objects[1].source = "camera";
  change(next);
  EXPECT_EQ(tick({{"a", 0.0}, {"b", 1.0}}).unknown, 1u);
  EXPECT_EQ(tick({{"a", 0.0}}, "camera").unknown, 0u);
}

TEST_F(TakeOver, AFixedObjectStandsWhereTheChangedSceneSays) {
  const auto with_table = [](double x) {
    Scene scene = test::cell_of({test::moving("a", {test::ball(0.1)}),
                                 test::fixed("table", {test::ball(0.1)}, test::at(x, 0, 0))});
    scene.pairs[0].publish = true;
    return scene;
  };
  begin(with_table(1.0));
  ASSERT_NEAR(tick({{"a", 0.0}}).pairs[0].distance, 0.8, 1e-12);
  change(with_table(3.0));
  EXPECT_NEAR(tick({}).pairs[0].distance, 2.8, 1e-12);
}

TEST_F(TakeOver, AnObjectThatTheChangedSceneHasAsAbsentIsLeftOutAndComesBackUnknown) {
  begin(balls({"a", "b", "c"}));
  tick({{"a", 0.0}, {"b", 0.25}, {"c", 1.0}});
  ASSERT_TRUE(tick({}).zones[0].active);
  Scene next = balls({"a", "b", "c"});
  next.objects[1].absent = true;
  change(next);
  EXPECT_EQ(absent_pairs(tick({})), 2u);
  EXPECT_NEAR(tick({}).minimum.distance, 0.8, 1e-12);
  EXPECT_FALSE(tick({}).zones[0].active);
  change(balls({"a", "b", "c"}));
  EXPECT_EQ(tick({}).unknown, 2u) << "where it was before says nothing";
  EXPECT_EQ(tick({{"b", 0.5}}).unknown, 0u);
}

TEST_F(TakeOver, AFixedObjectMayBeAbsentToo) {
  const auto with_table = [](bool absent) {
    Scene scene = test::cell_of({test::moving("a", {test::ball(0.1)}),
                                 test::fixed("table", {test::ball(0.1)}, test::at(1, 0, 0)),
                                 test::fixed("wall", {test::ball(0.1)}, test::at(3, 0, 0))});
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.objects[1].absent = absent;
    return scene;
  };
  begin(with_table(true));
  EXPECT_NEAR(tick({{"a", 0.0}}).minimum.distance, 2.8, 1e-12);
  EXPECT_EQ(absent_pairs(tick({})), 1u);
  EXPECT_TRUE(tick({}).minimum_certified);
  change(with_table(false));
  EXPECT_NEAR(tick({}).minimum.distance, 0.8, 1e-12);
  change(with_table(true));
  const Report& report = tick({});
  EXPECT_NEAR(report.minimum.distance, 2.8, 1e-12);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kAbsent);
}

TEST_F(TakeOver, ABodyOfAnotherShapeIsWhereTheObjectIs) {
  begin(balls({"a", "b"}));
  tick({{"a", 0.0}, {"b", 1.0}});
  Scene next = balls({"a", "b"});
  next.objects[0].parts[0] = test::ball(0.3);
  change(next);
  EXPECT_NEAR(tick({{"a", 0.001}}).pairs[0].distance, 0.599, 1e-12);
}

// Joints and links, with a cell in which the cart stands elsewhere in the list.
TEST(TakeOverOfRobots, LinksAreWhereTheJointsSayWithoutANewSample) {
  const Scene scene = test::scara_cell();
  Scene next = scene;
  next.objects[1].margin = 0.1;
  SourceNumbers numbers(scene);
  Monitor monitor(scene), unchanged(scene);
  std::vector<JointSample> joints;
  for (std::uint32_t i = 0; i < 3; ++i) {
    JointSample sample;
    sample.variable = i;
    sample.stamp_ns = kStart;
    sample.position = 0.1;
    joints.push_back(sample);
  }
  monitor.tick({}, joints, kStart);
  unchanged.tick({}, joints, kStart);
  const auto after = test::taken_over(monitor, scene, next, numbers);
  after->tick({}, kStart + kTick);
  unchanged.tick({}, kStart + kTick);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    EXPECT_EQ(after->input_age(i).age_ns, unchanged.input_age(i).age_ns) << scene.objects[i].name;
    EXPECT_EQ(after->pose(i).position, unchanged.pose(i).position) << scene.objects[i].name;
  }
  EXPECT_EQ(after->joint_age(1).age_ns, kTick);
  next.robots[0].joints[1].parent_from_joint.position.x() += 0.5;
  const auto longer = test::taken_over(unchanged, scene, next, numbers);
  longer->tick({}, kStart + 2 * kTick);
  after->tick({}, kStart + 2 * kTick);
  EXPECT_NEAR(longer->pose(4).position.x(), after->pose(4).position.x() + 0.5 * std::cos(0.1),
              1e-9);
}

// The cart is not known any more once another source has to send it.
TEST(TakeOverOfAttachedObjects, ForgetsThemWithTheirCarrier) {
  const auto scene_with = [](const std::string& keys) {
    return scene_of(
        "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
        "  - {name: cart, groups: [moving], max_speed: 1, sphere: {radius: 0.1}" +
        keys +
        "}\n"
        "  - {name: post, fixed: true, sphere: {radius: 0.1}}\n"
        "  - {name: tray, attached: {to: cart}, max_speed: 1, sphere: {radius: 0.2}}\n"
        "  - {name: load, attached: {to: tray}, max_speed: 1, sphere: {radius: 0.3}}\n"
        "pairs: [{between: [moving, post]}]\n");
  };
  const Scene first = scene_with("");
  for (const std::string keys : {"", ", margin: 0.1", ", source: camera"}) {
    SourceNumbers numbers(first);
    Monitor before(first);
    before.tick(std::array{test::sample(0, test::at(3, 0, 0), kStart)}, kStart);
    const Scene second = scene_with(keys);
    const auto after = test::taken_over(before, first, second, numbers);
    const bool is_other = keys == ", source: camera";
    EXPECT_EQ(after->tick({}, kStart + 30 * kTick).unknown, is_other ? 3u : 0u) << keys;
    for (const std::uint32_t object : {0u, 2u, 3u})
      EXPECT_EQ(after->input_age(object).age_ns, is_other ? -1 : 30 * kTick) << keys;
  }
}

TEST(SourceNumbers, ThoseThatAChangedSceneNamesKeepTheirNumbers) {
  Scene scene = balls({"a"});
  scene.objects[0].source = "one";
  SourceNumbers numbers(scene);
  EXPECT_EQ(numbers.of(SourceName("two")), 1u);
  EXPECT_TRUE(numbers.add_named(std::vector{SourceName("two"), SourceName("three")}));
  for (int i = 0; i < 40; ++i) (void)numbers.of(SourceName("s" + std::to_string(i)));
  EXPECT_EQ(numbers.of(SourceName("one")), 0u);
  EXPECT_EQ(numbers.of(SourceName("two")), 1u);
  EXPECT_EQ(numbers.of(SourceName("three")), 2u);
}

TEST(SourceNumbers, NoOtherSourceTakesThePlaceOfOneThatTheCellNames) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kMaxSources; ++i) names.push_back("s" + std::to_string(i));
  Scene scene = balls(names);
  for (Object& object : scene.objects) object.source = object.name;
  SourceNumbers numbers(scene);
  EXPECT_EQ(numbers.of(SourceName("other")), kNoSource);
  EXPECT_EQ(numbers.name(0).view(), "s0");
  EXPECT_FALSE(numbers.add_named(std::vector{SourceName("other")}));
  EXPECT_EQ(numbers.of(SourceName("s3")), 3u);
}

}  // namespace
}  // namespace clearance
