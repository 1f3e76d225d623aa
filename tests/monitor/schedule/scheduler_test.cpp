// Bounds, completeness and choice, on cells of capsules whose true distances have a closed form.
#include "monitor/schedule/scheduler.hpp"

#include <gtest/gtest.h>

#include <set>

#include "monitor/monitor.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// How the moving objects go from one tick to the next.
enum class Style { kCrawl, kSpin, kJitter, kTeleport };

Pose next_pose(const Pose& pose, Style style, Random& random) {
  Pose next = pose;
  const auto turn = [&](double angle) {
    const Vec3 axis = random.in_box(1.0).normalized();
    next.orientation =
        Eigen::AngleAxisd(random.uniform(-angle, angle), axis) * pose.orientation.normalized();
    next.orientation.coeffs() *= random.uniform(0.9995, 1.0005);
  };
  switch (style) {
    case Style::kCrawl:
      next.position += random.in_box(0.002);
      turn(0.001);
      break;
    case Style::kSpin:
      turn(0.1);
      break;
    case Style::kJitter:
      next.position += random.in_box(1e-9);
      break;
    case Style::kTeleport:
      if (random.uniform(0.0, 1.0) < 0.1) next = random.pose(3.0);
      break;
  }
  return next;
}

// Long thin bodies, one of them in two pieces and off its own origin, among fixed ones.
Scene thin_bodies(Random& random) {
  std::vector<Object> objects;
  for (int i = 0; i < 6; ++i) {
    objects.push_back(test::moving("thin", {test::capsule(2.0, 0.005, random.pose(0.5))}));
  }
  objects.push_back(test::moving(
      "two", {test::capsule(1.0, 0.01, random.pose(1.0)), test::ball(0.05, random.pose(1.0))}));
  for (int i = 0; i < 6; ++i) {
    objects.push_back(test::fixed("post", {test::capsule(1.0, 0.02)}, random.pose(3.0)));
  }
  return test::cell_of(std::move(objects));
}

// A scene in motion; tick by tick.
class MovingCell {
 public:
  MovingCell(const Scene& scene, Style style, std::uint64_t seed)
      : scene_(scene), style_(style), random_(seed) {
    for (const Object& object : scene.objects) {
      poses_.push_back(object.fixed ? object.world_from_object : random_.pose(3.0));
    }
  }

  const Report& tick(Monitor& monitor) {
    std::vector<PoseSample> samples;
    now_ns_ += kTick;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      if (scene_.objects[i].fixed) continue;
      poses_[i] = next_pose(poses_[i], style_, random_);
      samples.push_back(test::sample(i, poses_[i], now_ns_));
    }
    return monitor.tick(samples, now_ns_);
  }

  [[nodiscard]] long double truth(std::uint32_t pair) const {
    const auto [a, b, publish] = scene_.pairs[pair];
    return test::true_distance(scene_.objects[a], poses_[a], scene_.objects[b], poses_[b]);
  }

 private:
  const Scene& scene_;
  const Style style_;
  Random random_;
  std::vector<Pose> poses_;
  std::int64_t now_ns_ = kStart;
};

using StyleAndBudget = std::tuple<Style, std::uint32_t>;
class EveryBudget : public testing::TestWithParam<StyleAndBudget> {};

INSTANTIATE_TEST_SUITE_P(Scheduler, EveryBudget,
                         testing::Combine(testing::Values(Style::kCrawl, Style::kSpin,
                                                          Style::kJitter, Style::kTeleport),
                                          testing::Values(0u, 1u, 7u, 40u, 1000u)));

TEST_P(EveryBudget, EveryBoundHoldsInEveryTick) {
  const auto [style, budget] = GetParam();
  Random random(31);
  Scene scene = thin_bodies(random);
  scene.budget = budget;
  Monitor monitor(scene);
  MovingCell motion(scene, style, 32);
  for (int t = 0; t < 300; ++t) {
    const Report& report = motion.tick(monitor);
    ASSERT_LE(report.queries, budget);
    ASSERT_EQ(report.evaluated + report.carried, report.pairs_total);
    long double least = kInfinity;
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      const PairReport pair = monitor.pair(p);
      const long double truth = motion.truth(p);
      ASSERT_LE(pair.lower, truth) << "tick " << t << " pair " << p;
      ASSERT_GE(pair.upper, truth) << "tick " << t << " pair " << p;
      ASSERT_GT(pair.lower, -kInfinity) << "balls bound every pair of bounded parts";
      least = std::min(least, truth);
    }
    ASSERT_LE(report.lower_all, least);
    ASSERT_EQ(report.minimum_known, budget > 0);
    if (report.minimum_proved) {
      ASSERT_NEAR(static_cast<double>(motion.truth(report.minimum.pair) - least), 0.0, 1e-14);
      ASSERT_GE(report.minimum.upper, least);
    }
  }
}

TEST(Scheduler, EvaluatesWhatIsPublishedInEveryTickThatTheBudgetCovers) {
  Random random(41);
  Scene scene = thin_bodies(random);
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  Monitor monitor(scene);
  MovingCell motion(scene, Style::kTeleport, 42);
  for (int t = 0; t < 20; ++t) {
    const Report& report = motion.tick(monitor);
    EXPECT_EQ(report.evaluated, report.pairs_total);
    EXPECT_EQ(report.oldest_evaluation_cycles, 0u);
    EXPECT_TRUE(report.minimum_proved);
  }
}

TEST(Scheduler, EvaluatesAllWhenAskedTo) {
  Random random(41);
  Scene scene = thin_bodies(random);
  scene.evaluate_all = true;
  Monitor monitor(scene);
  MovingCell motion(scene, Style::kCrawl, 42);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(motion.tick(monitor).evaluated, scene.pairs.size());
}

TEST(Scheduler, LeavesAloneWhatNobodyAsksForAndCannotBeTheMinimum) {
  Random random(41);
  Scene scene = thin_bodies(random);
  scene.refresh_s = 1e6;
  Monitor monitor(scene);
  MovingCell motion(scene, Style::kCrawl, 42);
  std::uint32_t queries = 0;
  for (int t = 0; t < 100; ++t) queries = motion.tick(monitor).queries;
  EXPECT_LT(queries, scene.pairs.size() / 2) << "the budget would cover all";
}

TEST(Scheduler, ProvesTheMinimumOnAFractionOfTheBudget) {
  Random random(43);
  Scene scene = thin_bodies(random);
  scene.budget = 12;  // of 70 part pairs
  Monitor monitor(scene);
  MovingCell motion(scene, Style::kCrawl, 44);
  int proved = 0;
  for (int t = 0; t < 500; ++t) proved += motion.tick(monitor).minimum_proved;
  EXPECT_GE(proved, 480);
}

// The boxes of these two corners are nearer to each other than the corners.
TEST(Scheduler, BoundsHoldBeforeAnythingIsEvaluated) {
  const auto corner = [](double size) {
    const std::array<Vec3, 4> points{Vec3::Zero(), size * Vec3::UnitX(), size * Vec3::UnitY(),
                                     size * Vec3::UnitZ()};
    return Part{"corner", test::made(polyhedron_from_vertices(points)), {}};
  };
  Scene scene = test::cell_of(
      {test::moving("a", {corner(1.0)}), test::fixed("b", {corner(-1.0)}, test::at(3, 3, 3))});
  scene.budget = 0;
  Monitor monitor(scene);
  const PoseSample sample = test::sample(0, test::at(0, 0, 0), kStart);
  monitor.tick(std::span(&sample, 1), kStart);
  EXPECT_LE(monitor.pair(0).lower, 7.0 / std::sqrt(3.0));
  EXPECT_GE(monitor.pair(0).upper, 7.0 / std::sqrt(3.0));
  EXPECT_GT(monitor.pair(0).lower, 0.0);
}

TEST(Scheduler, SaysWhenTheBudgetEndsBeforeTheMinimumIsProved) {
  Random random(45);
  Scene scene = thin_bodies(random);
  scene.budget = 1;
  Monitor monitor(scene);
  MovingCell motion(scene, Style::kTeleport, 46);
  EXPECT_FALSE(motion.tick(monitor).minimum_proved);
}

TEST(Scheduler, PartsThatCannotBeTheClosestAreNotEvaluatedAndThePairIsDecidedAllTheSame) {
  std::vector<Part> chain;
  for (int i = 0; i < 5; ++i) chain.push_back(test::ball(0.1, test::at(0, i, 0)));
  const Scene scene = test::cell_of(
      {test::moving("chain", chain), test::fixed("post", {test::ball(0.1)}, test::at(1, 0, 0))});
  Monitor monitor(scene);
  for (int t = 0; t < 5; ++t) {
    const PoseSample sample = test::sample(0, test::at(0, 1e-3 * t, 0), kStart + t * kTick);
    const Report& report = monitor.tick(std::span(&sample, 1), sample.stamp_ns);
    EXPECT_EQ(report.queries, 1u);
    EXPECT_EQ(report.evaluated, 1u);
    EXPECT_EQ(report.minimum.status, PairStatus::kConverged);
    EXPECT_EQ(report.minimum.part_a, 0u);
  }
  // Turned about, the far end comes near.
  Pose turned = test::at(0, 3, 0);
  turned.orientation = Eigen::AngleAxisd(M_PI, Vec3::UnitZ());
  const PoseSample sample = test::sample(0, turned, kStart + 5 * kTick);
  const PairReport& pair = monitor.tick(std::span(&sample, 1), sample.stamp_ns).minimum;
  EXPECT_EQ(pair.part_a, 3u);
  EXPECT_NEAR(pair.distance, 0.8, 1e-12);
}

}  // namespace
}  // namespace clearance
