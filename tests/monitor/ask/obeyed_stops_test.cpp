// Robots that obey RobotStop::scaling, beside a person who walks and bodies that are fixed.
//
// Oracle: machines that move in time, judged at each millisecond with kinematics of their own and a
// fresh distance of each pair. Whatever has not moved since it stood is not judged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/obeying_robot.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::first_seed, test::ObeyingRobot;
using test::kStart, test::kTick;

constexpr double kOracle = 2e-9;        // m
constexpr double kFastest = 20.0;       // m/s: no two points of this cell approach faster
constexpr std::size_t kTicks = 1'500;   // of a run
constexpr std::size_t kPostures = 300;  // drawn until one is clear

// The arms stop in drawn manners: with accelerations, they reach goals; without, they go straight.
test::DrawnArms drawn_cell(Random& random) {
  return test::drawn_arms(
      random, [&] { return ObeyingRobot::kStep * random.integer(0, 100); },
      [&] { return random.chance(0.3) ? random.log_uniform(0.05, 1.0) : kInfinity; });
}

// Walks towards places near the arms, at up to 1.6 m/s.
class Walker {
 public:
  Walker(std::uint64_t seed, std::size_t age) : random_(seed), age_(age) {}

  void begin() {
    at_ = Vec3(0.6, 0.0, 1.0) + 1.3 * horizontal();
    choose();
    past_.assign(age_ + 1, at_);
  }
  void step() {
    if (left_-- == 0) choose();
    const Vec3 towards = goal_ - at_;
    if (towards.norm() > 2e-3) at_ += speed_ * ObeyingRobot::kStep * towards.normalized();
    past_.push_back(at_);
    past_.pop_front();
  }
  [[nodiscard]] Pose now() const { return {.position = at_}; }
  [[nodiscard]] Pose said() const { return {.position = past_.front()}; }

 private:
  Vec3 horizontal() {
    Vec3 direction = random_.direction();
    direction.z() = 0.0;
    return direction.normalized();
  }
  void choose() {
    goal_ = Vec3(0.3, 0.0, 1.0) + random_.uniform(0.1, 1.0) * horizontal();
    speed_ = random_.chance(0.5) ? test::kPersonSpeed : random_.uniform(0.0, test::kPersonSpeed);
    left_ = random_.integer(100, 800);
  }

  Random random_;
  std::size_t age_;
  Vec3 at_ = Vec3::Zero(), goal_ = Vec3::Zero();
  double speed_ = 0.0;
  int left_ = 0;
  std::deque<Vec3> past_;
};

struct JudgedRuns {
  std::size_t instants = 0, nearer = 0, moving = 0, slowed = 0, stops = 0, stated = 0;
  double least_left = kInfinity;  // m: of distances less their margins
  std::string worst;
};

// One cell in time.
class SimulatedCell {
 public:
  explicit SimulatedCell(std::uint64_t seed, std::size_t late = 0)
      : random_(seed),
        arms_(drawn_cell(random_)),
        exact_(test::drawn_errors(scene_, random_)),
        age_(random_.chance(0.5) ? 0 : static_cast<std::size_t>(random_.integer(1, 10))),
        walker_(random_.next(), age_),
        monitor_(scene_) {
    for (std::uint32_t r = 0; r < scene_.robots.size(); ++r)
      robots_.emplace_back(arms_, r, age_, late, random_.next());
    for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p)
      pairs_.push_back({.pair = p, .margin = test::margin_of(scene_, p)});
  }

  void go(JudgedRuns& judged) {
    if (!begin()) return;
    for (std::size_t t = 0; t < kTicks; ++t) {
      const std::vector<RobotStop>& stops = monitor_.tick(poses(), joints(), now_).stops;
      for (std::size_t r = 0; r < robots_.size(); ++r) {
        const bool stood = robots_[r].stands();
        robots_[r].obey(stops[r].scaling);
        judged.slowed += !stood && stops[r].scaling < 1.0 && stops[r].scaling > 0.0;
        judged.stops += !stood && robots_[r].stands();
        judged.moving += !robots_[r].stands();
        judged.stated += !robots_[r].stands() && robots_[r].said().stopping;
        if (robots_[r].is_at_its_end()) return;
      }
      walker_.step();
      now_ += kTick;
      judge(judged);
    }
  }

 private:
  struct Pair {
    std::uint32_t pair = 0;
    double margin = 0.0;
    double clear_for = 0.0;  // s
  };

  // Postures from which all of the arms would stop clear.
  bool begin() {
    for (std::size_t i = 0; i < kPostures; ++i) {
      now_ += 100'000 * kTick;
      walker_.begin();
      for (ObeyingRobot& robot : robots_) robot.begin();
      const Report& report = monitor_.tick(poses(), joints(), now_);
      if (std::ranges::all_of(report.stops, [](const auto& stop) { return stop.scaling == 1.0; }))
        return true;
    }
    return false;
  }
  [[nodiscard]] std::int64_t stamp() const {
    return now_ - static_cast<std::int64_t>(age_) * kTick;
  }
  std::vector<PoseSample> poses() const {
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
      if (scene_.objects[i].name == "person")
        samples.push_back(test::sample(i, walker_.said(), stamp()));
    return samples;
  }
  std::vector<JointSample> joints() const {
    std::vector<JointSample> samples;
    for (const ObeyingRobot& robot : robots_) {
      for (std::size_t j = 0; j < robot.joints(); ++j) {
        samples.push_back(test::joint(robot.variable(j), robot.said().positions[j], stamp()));
        samples.back().has_velocity = true;
        samples.back().velocity = robot.said().velocities[j];
        samples.back().stopping = robot.said().stopping;
      }
    }
    return samples;
  }

  void judge(JudgedRuns& judged) {
    std::vector<double> at(scene_.variables.size(), 0.0);
    for (const ObeyingRobot& robot : robots_)
      for (std::size_t j = 0; j < robot.joints(); ++j) at[robot.variable(j)] = robot.position(j);
    const std::vector<Pose> sent(scene_.objects.size(), walker_.now());
    const std::vector<Pose> places = test::true_poses(scene_, at, sent, exact_);
    for (Pair& pair : pairs_) {
      pair.clear_for -= ObeyingRobot::kStep;
      if (pair.clear_for > 0.0) continue;
      const double left = test::distance_of(scene_, pair.pair, places) - pair.margin;
      pair.clear_for = left / kFastest - ObeyingRobot::kStep;
      const ObjectPair& of = scene_.pairs[pair.pair];
      const bool moves = std::ranges::any_of(robots_, [&](const ObeyingRobot& robot) {
        return !robot.stands() && (test::is_moved_link(scene_, robot.robot(), of.first) ||
                                   test::is_moved_link(scene_, robot.robot(), of.second));
      });
      if (!moves) continue;
      ++judged.instants;
      judged.nearer += left < -kOracle || (pair.margin == 0.0 && left <= 0.0);
      if (left >= judged.least_left) continue;
      judged.least_left = left;
      judged.worst = scene_.objects[of.first].name + " - " + scene_.objects[of.second].name;
    }
  }

  Random random_;
  test::DrawnArms arms_;
  const Scene& scene_ = arms_.scene;
  test::DrawnErrors exact_;
  std::size_t age_;
  Walker walker_;
  Monitor monitor_;
  std::vector<ObeyingRobot> robots_;
  std::vector<Pair> pairs_;
  std::int64_t now_ = kStart;
};

TEST(ObeyedStops, ComeNearerIfTheBrakesActLaterThanStated) {
  JudgedRuns judged;
  for (std::uint64_t seed = 1; seed <= 100 && judged.nearer == 0; ++seed)
    SimulatedCell(seed, 60).go(judged);
  EXPECT_GT(judged.nearer, 0u);
}

// CLEARANCE_STOPS_SEED: the first of the runs. CLEARANCE_STOPS_SHOW prints how many there were.
TEST(ObeyedStops, KeepEachMarginUntilTheRobotStands) {
  JudgedRuns all;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(80); ++seed) {
    JudgedRuns judged;
    SimulatedCell(seed).go(judged);
    EXPECT_EQ(judged.nearer, 0u) << "seed " << seed << ", " << judged.least_left << " m, "
                                 << judged.worst;
    all.instants += judged.instants;
    all.moving += judged.moving;
    all.slowed += judged.slowed;
    all.stops += judged.stops;
    all.stated += judged.stated;
    all.least_left = std::min(all.least_left, judged.least_left);
  }
  EXPECT_GT(all.instants, 10'000u);
  EXPECT_GT(all.moving, 5'000u);
  EXPECT_GT(all.slowed, 100u);
  EXPECT_GT(all.stops, 3u);
  EXPECT_GT(all.stated, 30u);
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr)
    std::cout << all.instants << " judged, " << all.moving << " ticks in motion, " << all.slowed
              << " slowed, " << all.stops << " stops, " << all.stated << " ticks in stated stops, "
              << all.least_left << " m above the margin\n";
}

}  // namespace
}  // namespace clearance
