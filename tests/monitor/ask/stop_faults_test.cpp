// What is published of a robot's stop while its joints or what is beside it are not known: the rows
// of monitor/FAULTS.md about stops. The cell and the joints are those of stopping_cell.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/config/cell/stopping_cell.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

constexpr double kSpeed = 1.0;  // rad/s, of the shoulder

class StopFaults : public StoppingCells {
 protected:
  // A person stands 2 m from the shoulder's axis. Nothing else moves but the shoulder.
  void build(const std::string& stopping = "{reaction_ms: 50, time_ms: 200}") {
    monitor_.reset();
    angle_ = 1.0;
    scene_ = scene(cell(
        stopping, "  - {name: person, max_speed: 1.6, age_limit_ms: 20, sphere: {radius: 0.3}}\n",
        "  - {between: [arm, person]}\nzones:\n  - {name: stops, between: [arm, person], "
        "stops: {margin: 0.05}}\n",
        ", age_limit_ms: 20"));
    monitor_.emplace(scene_);
    person_ = 0;
    while (scene_.objects.at(person_).name != "person") ++person_;
  }

  // One ms later. Positions are those of a shoulder that turns at kSpeed, unless `stands`.
  const RobotStop& tick(std::optional<double> sent, bool stands = false) {
    now_ += kTick;
    if (!stands) angle_ += 1e-3 * kSpeed;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      const bool is_shoulder = scene_.variables[v].name == "shoulder";
      JointSample sample = test::joint(v, is_shoulder ? angle_ : 0.0, now_);
      sample.has_velocity = sent.has_value();
      sample.velocity = is_shoulder ? sent.value_or(0.0) : 0.0;
      joints.push_back(sample);
    }
    return report(joints, true);
  }
  const RobotStop& silent(bool person_is_there = true) {
    now_ += kTick;
    return report({}, person_is_there);
  }
  [[nodiscard]] double least() const {
    double least = kInfinity;
    for (const PairReport& pair : report_->pairs)
      if (!std::isnan(pair.stop_lower)) least = std::min(least, pair.stop_lower);
    return least;
  }

 private:
  const RobotStop& report(const std::vector<JointSample>& joints, bool person_is_there) {
    std::vector<PoseSample> poses;
    if (person_is_there) poses.push_back(test::sample(person_, test::at(2.0, 0.0, 0.0), now_));
    report_ = &monitor_->tick(poses, joints, now_);
    return report_->stops.at(0);
  }

 protected:
  Scene scene_;
  std::optional<Monitor> monitor_;
  const Report* report_ = nullptr;

 private:
  std::uint32_t person_ = 0;
  double angle_ = 1.0;
  std::int64_t now_ = kStart;
};

TEST_F(StopFaults, WithVelocitiesOfAllJointsItIsMeasured) {
  build();
  for (int i = 0; i < 50; ++i) static_cast<void>(tick(kSpeed));
  EXPECT_EQ(tick(kSpeed).validity, SeparationValidity::kMeasured);
  EXPECT_EQ(tick(kSpeed).scaling, 1.0);
  EXPECT_GT(least(), 0.0);
}

// At first nothing tells how fast the joints are: each may go anywhere, by its limit.
TEST_F(StopFaults, WithoutVelocitiesLimitsStandIn) {
  build();
  const RobotStop& unknown = tick(std::nullopt, true);
  EXPECT_EQ(unknown.validity, SeparationValidity::kAssumed);
  const double by_limits = least();
  build();
  static_cast<void>(tick(0.0, true));
  EXPECT_LT(by_limits, least() - 0.1);
}

TEST_F(StopFaults, ALateJointMeansThatItHasToStop) {
  build();
  for (int i = 0; i < 50; ++i) static_cast<void>(tick(kSpeed));
  for (int i = 0; i < 20; ++i) EXPECT_GT(silent().scaling, 0.0) << "it is not late yet: " << i;
  const RobotStop& late = silent();
  EXPECT_EQ(late.scaling, 0.0);
  EXPECT_EQ(late.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(late.clearance, -kInfinity);
  EXPECT_TRUE(std::isnan(late.time));
}

TEST_F(StopFaults, AJointThatIsFrozenMeansThatItHasToStop) {
  build();
  for (int i = 0; i < 50; ++i) static_cast<void>(tick(kSpeed));
  int ticks = 0;
  while (tick(kSpeed, true).scaling > 0.0 && ++ticks < 1000) {
  }
  EXPECT_LT(ticks, 100) << "its velocity says that it moves";
  EXPECT_EQ(tick(kSpeed, true).validity, SeparationValidity::kUnknown);
}

// A driver that sends 0, or deg/s of another size: the larger of both counts.
TEST_F(StopFaults, OfVelocitiesThatContradictPositionsTheLargerCounts) {
  const auto after = [&](double sent) {
    build();
    for (int i = 0; i < 40; ++i) static_cast<void>(tick(sent));
    return least();
  };
  const double truly = after(kSpeed);
  EXPECT_NEAR(after(0.0), truly, 0.01) << "as the positions say";
  EXPECT_NEAR(after(-kSpeed), truly, 0.01);
}

TEST_F(StopFaults, WhatIsBesideItAndWasNeverHeardMeansThatItHasToStop) {
  build();
  const RobotStop& stop = silent(false);
  EXPECT_EQ(stop.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(stop.scaling, 0.0);
  EXPECT_EQ(tick(0.0, true).scaling, 1.0) << "the person is there now";
}

// The shoulder turns towards a wall until a report admits less than its speed. Its brakes act 10 ms
// before the stated reaction is over.
class StopInProgress : public StoppingCells {
 protected:
  StopInProgress()
      : scene_(scene(
            cell("{reaction_ms: 50, joints: {shoulder: {deceleration: 229.183}, elbow: "
                 "{deceleration: 400}, reach: {deceleration: 1}, grip: {deceleration: 1}}}",
                 "  - {name: wall, fixed: true, sphere: {radius: 0.3}, pose: {xyz: [1.2, 0, 0]}}\n",
                 "  - {between: [arm, wall]}\nzones:\n  - {name: stops, between: [arm, wall], "
                 "stops: {margin: 0.05}}\n"))),
        monitor_(scene_) {}

  // `noise`: the velocities that the joints which stand send, rad/s or m/s.
  const RobotStop& tick(double speed, bool stated, double noise = 0.0) {
    now_ += kTick;
    angle_ += 1e-3 * speed;
    std::vector<JointSample> joints;
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      const bool is_shoulder = scene_.variables[v].name == "shoulder";
      JointSample sample = test::joint(v, is_shoulder ? angle_ : 0.0, now_);
      sample.has_velocity = true;
      sample.velocity = is_shoulder ? speed : static_cast<double>(now_ / kTick % 3 - 1) * noise;
      sample.stopping = stated;
      joints.push_back(sample);
    }
    return monitor_.tick({}, joints, now_).stops.at(0);
  }
  // The least scaling of the reports while the brakes act.
  double least_scaling(bool stated, double noise = 0.0) {
    while (tick(kSpeed, false).scaling == 1.0 && angle_ < 2.0) {
    }
    EXPECT_LT(angle_, 0.0) << "nothing was in its path";
    for (int ms = 0; ms < 40; ++ms) static_cast<void>(tick(kSpeed, false));
    double least = 1.0;
    for (double speed = kSpeed; speed > 0.0; speed -= 1e-3 * kDeceleration)
      least = std::min(least, tick(speed, stated, noise).scaling);
    return least;
  }

  static constexpr double kDeceleration = 4.0;  // rad/s2

 private:
  Scene scene_;
  Monitor monitor_;
  std::int64_t now_ = kStart;
  double angle_ = -2.0;
};

TEST_F(StopInProgress, IsNotToldToStopAgainIfItIsStated) { EXPECT_EQ(least_scaling(true), 1.0); }

TEST_F(StopInProgress, IsBelievedWhileJointsThatStandSendNoise) {
  EXPECT_EQ(least_scaling(true, 1e-4), 1.0);
}

TEST_F(StopInProgress, CountsAnotherReactionIfItIsNotStated) {
  EXPECT_LT(least_scaling(false), 1.0);
}

TEST_F(StopInProgress, IsBelievedForAsLongAsItTakes) {
  const double takes = kSpeed / kDeceleration;
  for (int ms = 0; ms <= 250; ++ms) EXPECT_NEAR(tick(kSpeed, true).time, takes, 1e-6) << ms;
  EXPECT_NEAR(tick(kSpeed, true).time, 0.051 + takes, 1e-6) << "it has not slowed down";
}

// Each 19th message without it: the statement is no other one for that.
TEST_F(StopInProgress, IsBelievedNoLongerIfItFlickers) {
  const double takes = kSpeed / kDeceleration;
  for (int ms = 0; ms <= 250; ++ms) static_cast<void>(tick(kSpeed, ms % 19 != 0));
  for (int ms = 0; ms <= 250; ++ms)
    ASSERT_NEAR(tick(kSpeed, ms % 19 != 0).time, 0.051 + takes, 1e-6) << ms;
}

// A late pose of a person is no end of it: the person has gone on by their largest speed.
TEST_F(StopFaults, ALatePersonComesNearerByTheStatedSpeed) {
  build();
  for (int i = 0; i < 50; ++i) static_cast<void>(tick(0.0, true));
  const double before = least();
  for (int i = 0; i < 15; ++i) static_cast<void>(silent(false));
  EXPECT_LE(least(), before - 1.6 * 0.015 + 1e-6);
}

}  // namespace
}  // namespace clearance
