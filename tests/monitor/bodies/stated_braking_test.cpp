// Joints whose sender says that they brake (JointStates.stopping), and whether that is believed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "monitor/bodies/tracked_variable.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

// A joint that sends its position and its velocity once per millisecond.
class StatedBraking : public testing::Test {
 protected:
  StatedBraking() {
    joint_.max_speed = 2.0;
    joint_.age_limit_ns = 20 * kStepNs;
  }

  bool is_stopping(bool stated, double velocity, bool sends_velocity = true) {
    JointSample sample;
    sample.stamp_ns = now_ns_ += kStepNs;
    sample.position = position_ += 1e-3 * velocity;
    sample.velocity = velocity;
    sample.has_velocity = sends_velocity;
    sample.stopping = stated;
    EXPECT_EQ(take(joint_, sample, now_ns_, {.now_ns = now_ns_, .future_ns = kStepNs}, state_,
                   state_.repetition),
              std::nullopt);
    return state_.is_stopping;
  }

  void begin_anew() {
    state_ = {};
    now_ns_ = 0;
    position_ = 0.0;
  }

  static constexpr std::int64_t kStepNs = 1'000'000;

 private:
  JointVariable joint_;
  TrackedVariable state_;
  std::int64_t now_ns_ = 0;
  double position_ = 0.0;
};

// A sender that forgets to take the statement back must not hide the reaction of the next stop.
TEST_F(StatedBraking, EndsWhenTheJointBecomesFaster) {
  EXPECT_FALSE(is_stopping(false, 1.0));
  EXPECT_TRUE(is_stopping(true, 1.0));
  EXPECT_TRUE(is_stopping(true, 0.5));
  EXPECT_TRUE(is_stopping(true, 0.6)) << "velocities are noisy";
  EXPECT_TRUE(is_stopping(true, -0.1));
  EXPECT_TRUE(is_stopping(true, 0.0));
  EXPECT_FALSE(is_stopping(true, 0.2)) << "it moves again";
  EXPECT_FALSE(is_stopping(true, 0.2));
  EXPECT_FALSE(is_stopping(false, 0.2));
  EXPECT_TRUE(is_stopping(true, 0.2)) << "this is another stop";
}

// Oracle: the rule, by the whole history.
TEST_F(StatedBraking, OfAllSequencesOfSixIsBelievedWhileNoSpeedIsHalfAboveTheLeast) {
  test::EveryChoice choice;
  while (choice.next()) {
    begin_anew();
    std::vector<double> speeds;  // since the statement began
    for (int step = 0; step < 6; ++step) {
      const bool stated = choice.flag();
      const double speed = std::array{0.0, 0.5, 0.74, 1.0}[choice.of(4)];
      const double least = speeds.empty() ? kInfinity : *std::ranges::min_element(speeds);
      if (stated) speeds.push_back(speed);
      if (!stated && (speed == 0.0 || speed > 1.5 * least)) speeds.clear();
      const bool is_believed = stated && speed <= 1.5 * std::min(least, speed);
      ASSERT_EQ(is_stopping(stated, speed), is_believed) << choice.runs() << ", step " << step;
    }
  }
  EXPECT_EQ(choice.runs(), 262'144u);
}

TEST_F(StatedBraking, IsNotBelievedWhileTheVelocityIsNotKnown) {
  EXPECT_FALSE(is_stopping(true, 0.0, false));
  EXPECT_TRUE(is_stopping(true, 0.0, false)) << "two positions tell it";
}

}  // namespace
}  // namespace clearance
