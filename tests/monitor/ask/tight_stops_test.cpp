// How near PairReport::stop_lower comes to the truth: robots that keep their path, beside bodies
// that are fixed.
//
// Oracle: dense samples of the line on which such a robot stops, at the least by golden section.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::kStart, test::kTick;

constexpr double kTotalReaction = 0.051;  // s: stated, and a period
constexpr double kNear = 0.5;             // m: pairs that are compared are no farther
constexpr double kFar = 0.1;  // m: that stop farther than this may have any bound above it

// A stop of one arm of the cell. The other one stands.
class StoppingArm {
 public:
  explicit StoppingArm(const Scene& scene) : scene_(scene), monitor_(scene), random_(59) {}

  // The left arm in a drawn posture, at a share of its speeds.
  const Report& tick(double share) {
    now_ += 100'000 * kTick;
    positions_.clear();
    velocities_.assign(scene_.variables.size(), 0.0);
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      const JointVariable& of = scene_.variables[v];
      const double least = std::max(of.lower, -2.5), most = std::min(of.upper, 2.5);
      positions_.push_back(0.8 * random_.uniform(least, most));
      const bool slides = of.upper - of.lower < 0.2;
      if (of.robot == 0 && !slides) velocities_[v] = share * of.max_speed * random_.sign();
      joints.push_back(test::joint(v, positions_[v], now_));
      joints.back().has_velocity = true;
      joints.back().velocity = velocities_[v];
    }
    std::vector<PoseSample> poses;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
      if (scene_.objects[i].name == "person")
        poses.push_back(test::sample(i, test::at(50, 0, 0), now_));
    return monitor_.tick(poses, joints, now_);
  }

  // The least distance of a pair on the line, and how far its points go at the most, m.
  struct Truth {
    double least = kInfinity, went = 0.0;
  };
  [[nodiscard]] Truth truth(std::uint32_t pair) const {
    const RobotStops& stops = scene_.robots[0].stopping;
    double in_proportion = 0.0;
    for (std::size_t j = 0; j < scene_.robots[0].joints.size(); ++j) {
      if (!test::moves(scene_, scene_.robots[0], j)) continue;
      const double speed = std::abs(velocities_[scene_.robots[0].joints[j].variable]);
      if (speed > 0.0)
        in_proportion = std::max(in_proportion, stops.joints[j].distance(speed) / speed);
    }
    const double end = kTotalReaction + in_proportion;
    constexpr int kSamples = 60;
    Truth found;
    int best = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double apart = distance(pair, end * i / kSamples, &found.went);
      if (apart < found.least) best = i;
      found.least = std::min(found.least, apart);
    }
    double low = end * std::max(0, best - 1) / kSamples;
    double high = end * std::min(kSamples, best + 1) / kSamples;
    for (int i = 0; i < 25; ++i) {
      const double third = (high - low) / 3.0;
      const double left = distance(pair, low + third), right = distance(pair, high - third);
      found.least = std::min({found.least, left, right});
      (left < right ? high : low) += left < right ? -third : third;
    }
    return found;
  }

 private:
  double distance(std::uint32_t pair, double t, double* went = nullptr) const {
    const std::vector<Pose> places = at(t);
    if (went != nullptr) {
      const std::vector<Pose> begin = at(0.0);
      const ObjectPair& of = scene_.pairs[pair];
      for (const std::uint32_t object : {of.first, of.second})
        *went = std::max(*went, (places[object].position - begin[object].position).norm());
    }
    return std::max(0.0, test::distance_of(scene_, pair, places));
  }
  [[nodiscard]] std::vector<Pose> at(double t) const {
    std::vector<double> positions = positions_;
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += t * velocities_[v];
    Random none(1);
    return test::true_poses(scene_, positions,
                            std::vector<Pose>(scene_.objects.size(), test::at(50, 0, 0)),
                            test::drawn_errors(scene_, none));
  }

  const Scene& scene_;
  Monitor monitor_;
  Random random_;
  std::vector<double> positions_, velocities_;
  std::int64_t now_ = kStart;
};

double quantile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

// CLEARANCE_STOPS_SHOW prints the figures of monitor/ask/STOPS.md.
TEST(TightStops, AreWithinMillimetresOfTheTruth) {
  const std::string stops = "{reaction_ms: 50, path: kept, time_ms: 200}";
  Scene scene = test::arms_that_stop(stops, stops);
  scene.robots[1].stopping = {};
  StoppingArm arm(scene);
  std::vector<double> below, relative;  // m; of the distance travelled
  for (std::uint64_t i = 0; i < repeats(2'400); ++i) {
    const Report& report = arm.tick(0.1 * static_cast<double>(1 + i % 6));
    for (const PairReport& pair : report.pairs) {
      const ObjectPair& of = scene.pairs[pair.pair];
      const bool has_other = scene.objects[of.first].fixed || scene.objects[of.second].fixed;
      const bool has_link = test::is_moved_link(scene, scene.robots[0], of.first) ||
                            test::is_moved_link(scene, scene.robots[0], of.second);
      if (!has_other || !has_link || !(pair.upper < kNear) || !(pair.stop_lower < kFar)) continue;
      const auto truth = arm.truth(pair.pair);
      if (truth.least <= 0.0) continue;
      EXPECT_LE(pair.stop_lower, truth.least + 2e-9);
      below.push_back(truth.least - pair.stop_lower);
      if (truth.went > 1e-3) relative.push_back(below.back() / truth.went);
    }
  }
  ASSERT_GT(below.size(), 50u);
  const double median = quantile(below, 0.5), most = quantile(below, 0.95);
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr)
    std::cout << below.size() << " pairs: median " << 1e3 * median << " mm, p95 " << 1e3 * most
              << " mm; of the distance travelled " << quantile(relative, 0.5) << ", "
              << quantile(relative, 0.95) << "\n";
  EXPECT_LT(median, 10e-3);
  EXPECT_LT(most, 25e-3);
}

}  // namespace
}  // namespace clearance
