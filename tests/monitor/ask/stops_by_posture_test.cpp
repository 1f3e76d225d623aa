// The rows of a stopping table that count for a posture.
//
// Oracle: dense samples of the line on which the robot stops, and how far its hand is then from the
// vertical line through its shoulder.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/true_bodies.hpp"

namespace clearance {
namespace {

using test::kStart, test::kTick;

constexpr double kStatedReaction = 0.051;         // s: stated, and a period
constexpr double kShort = 0.2, kLong = 0.3;       // s: until the first joint stands, by the step
constexpr double kBoundary = 0.5;                 // m: of both steps
constexpr std::int64_t kApart = 100'000 * kTick;  // of postures that do not follow each other

// 2.2 rad/s is the full speed. No joint needs more time than kShort for the path but in the second
// step.
const std::string kTable =
    "{reaction_ms: 50, path: kept, time_ms: 200, extension: {link: hand, reach: 1}, table: ["
    "{joint: joint1, extension_percent: 50, speed_percent: 100, time_ms: 200, angle_deg: 25.2},"
    "{joint: joint1, extension_percent: 100, speed_percent: 100, time_ms: 300, angle_deg: 37.8}]}";

class ArmByPosture {
 public:
  ArmByPosture()
      : scene_(test::arms_that_stop(kTable, test::kSomeStops)), monitor_(scene_), random_(61) {}

  // The time from the report until the left arm stands, s.
  double tick() {
    now_ += kApart;
    std::vector<JointSample> joints;
    positions_.clear();
    velocities_.clear();
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      const JointVariable& of = scene_.variables[v];
      const double least = std::max(of.lower, -2.5), most = std::min(of.upper, 2.5);
      const bool slides = of.upper - of.lower < 0.2;
      positions_.push_back(0.8 * random_.uniform(least, most));
      velocities_.push_back(slides ? 0.0 : 0.3 * of.max_speed * random_.uniform(-1.0, 1.0));
      joints.push_back(test::joint(v, positions_[v], now_));
      joints.back().has_velocity = true;
      joints.back().velocity = velocities_[v];
    }
    return monitor_.tick({}, joints, now_).stops[0].time;
  }
  // How far the hand is from the axis after this time at the present velocity, m.
  [[nodiscard]] double extension(double t) const {
    std::vector<double> positions = positions_;
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += t * velocities_[v];
    Random none(1);
    const std::vector<Pose> places =
        test::true_poses(scene_, positions, std::vector<Pose>(scene_.objects.size()),
                         test::drawn_errors(scene_, none));
    const Robot& robot = scene_.robots[0];
    return (places[test::object_of(robot, "hand")].position -
            places[test::object_of(robot, "shoulder")].position)
        .head<2>()
        .norm();
  }

 private:
  Scene scene_;
  Monitor monitor_;
  Random random_;
  std::int64_t now_ = kStart;
  std::vector<double> positions_, velocities_;
};

TEST(StopsByPosture, CountWithTheLowestStepThatAStopDoesNotLeave) {
  ArmByPosture arm;
  int lower = 0, left = 0;
  for (int i = 0; i < 1'000; ++i) {
    const bool is_lower = arm.tick() < kStatedReaction + 0.5 * (kShort + kLong);
    double farthest = 0.0;
    for (int k = 0; k <= 50; ++k)
      farthest = std::max(farthest, arm.extension((kStatedReaction + kShort) * k / 50.0));
    const bool is_left = farthest > kBoundary;
    EXPECT_FALSE(is_lower && is_left) << "posture " << i << ", up to " << farthest << " m";
    lower += is_lower;
    left += is_left && arm.extension(0.0) < kBoundary;
  }
  EXPECT_GT(lower, 50);
  EXPECT_GT(left, 20) << "stops that begin within the step and leave it";
}

// The extension of an arm follows from the places of its links.
TEST(StopsByPosture, OfAnArmWhosePlaceIsNotKnownCountWithTheHighestStep) {
  for (const bool is_placed : {true, false}) {
    Scene scene = test::arms_that_stop(kTable, test::kSomeStops);
    const auto person = static_cast<std::uint32_t>(
        std::ranges::find(scene.objects, "person", &Object::name) - scene.objects.begin());
    scene.robots[0].base.kind = RobotBase::Kind::kObject;
    scene.robots[0].base.object = person;
    Monitor monitor(scene);
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
      const bool bends = scene.variables[v].name == "left_joint2";
      joints.push_back(test::joint(v,
                                   bends                            ? 0.0
                                   : scene.variables[v].lower < 0.0 ? 0.0
                                                                    : 0.01,
                                   kStart));
      joints.back().has_velocity = true;
      joints.back().velocity = scene.variables[v].name == "left_joint1" ? 0.1 : 0.0;
    }
    std::vector<PoseSample> poses;
    if (is_placed) poses.push_back(test::sample(person, {}, kStart));
    const double time = monitor.tick(poses, joints, kStart).stops[0].time;
    EXPECT_NEAR(time, kStatedReaction + (is_placed ? kShort : kLong), 1e-6);
  }
}

}  // namespace
}  // namespace clearance
