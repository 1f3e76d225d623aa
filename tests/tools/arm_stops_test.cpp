// The example of an arm that works beside a person, by zones, by S_p and by its stops, and the
// machine that it simulates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "monitor/examples/arm/swinging_joint.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/random.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

// A stop begins somewhere in a motion. Below the printed speed, the joint takes as long, and its
// distance falls in proportion.
TEST(SwingingJoint, StandsWithinItsTableOnceTheReactionIsOver) {
  Random random(59);
  constexpr double kStep = 1e-3;  // s
  for (int i = 0; i < 300; ++i) {
    const double full = random.uniform(0.5, 3.0), reaction = random.uniform(0.0, 0.2);
    const double time = random.uniform(0.1, 0.5);
    const double distance = full * time * random.uniform(0.3, 1.0);
    stops::SwingingJoint joint({.from = -1.0,
                                .to = 1.0,
                                .full_speed = full,
                                .acceleration = random.uniform(2.0, 8.0),
                                .reaction = reaction,
                                .stop = JointStop::by_table({{full, distance, time}})});
    for (double t = random.uniform(0.3, 3.0); t > 0.0; t -= kStep) {
      joint.command(full);
      joint.advance(kStep);
    }
    joint.command(0.0);
    for (double t = 0.0; t < reaction - kStep; t += kStep) joint.advance(kStep);
    const double from = joint.position(), speed = std::abs(joint.velocity());
    // A step of the reaction may be left: the velocity changes in it, and so does the position.
    const double most = speed + 8.0 * 2.0 * kStep;
    for (double t = 0.0; t < time + 3.0 * kStep; t += kStep) joint.advance(kStep);
    EXPECT_EQ(joint.velocity(), 0.0) << i;
    EXPECT_LE(std::abs(joint.position() - from), most / full * distance + 2.0 * kStep * most) << i;
  }
}

TEST(SwingingJoint, SwingsBetweenItsPlacesAsFastAsItMay) {
  const auto strokes = [](double speed) {
    stops::SwingingJoint joint({.from = 1.0,
                                .to = -1.0,
                                .full_speed = 2.0,
                                .acceleration = 4.0,
                                .stop = JointStop::by_deceleration(8.0)});
    double least = 1.0, most = 1.0;
    for (int i = 0; i < 15'000; ++i) {
      joint.command(speed);
      joint.advance(1e-3);
      EXPECT_LE(std::abs(joint.velocity()), std::min(speed, 2.0) + 1e-12);
      least = std::min(least, joint.position());
      most = std::max(most, joint.position());
    }
    EXPECT_NEAR(least, speed > 0.0 ? -1.0 : 1.0, 0.01);
    EXPECT_NEAR(most, 1.0, 0.01);
    return joint.strokes();
  };
  EXPECT_EQ(strokes(9.0), 10u) << "each takes 2 / 2 + 2 / 4 s";
  EXPECT_EQ(strokes(1.0), 6u) << "each takes 2 / 1 + 1 / 4 s";
  EXPECT_EQ(strokes(0.0), 0u);
}

TEST(SwingingJoint, StopsWhenItIsToldNothingForAsLongAsItsReaction) {
  stops::SwingingJoint joint({.from = -1.0,
                              .to = 1.0,
                              .full_speed = 1.0,
                              .acceleration = 5.0,
                              .reaction = 0.1,
                              .stop = JointStop::by_time(0.2)});
  for (int i = 0; i < 500; ++i) {
    joint.command(1.0);
    joint.advance(1e-3);
  }
  for (int i = 0; i < 98; ++i) joint.advance(1e-3);
  EXPECT_EQ(joint.velocity(), 1.0) << "the last command has just begun to act";
  for (int i = 0; i < 210; ++i) joint.advance(1e-3);
  EXPECT_EQ(joint.velocity(), 0.0);
  for (int i = 0; i < 1000; ++i) joint.advance(1e-3);
  EXPECT_EQ(joint.velocity(), 0.0) << "until it is told something";
}

struct Obeying {
  std::size_t strokes = 0;
  double at_full_speed = -1.0;        // percent
  double moving = -1.0, ever = -1.0;  // least true distances, m
};

// Parses the line that begins with `name`.
Obeying obeying(const std::string& output, const std::string& name) {
  std::istringstream lines(output);
  Obeying outcome;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream figures(line.substr(name.size()));
    std::string percent;
    figures >> outcome.strokes >> outcome.at_full_speed >> percent >> outcome.moving >>
        outcome.ever;
  }
  return outcome;
}

// The person passes once. On a busy machine answers are older, and the arm stops where none comes
// within its reaction.
TEST(StoppingArm, KeepsTheMarginAndIsHeldBackLeastByItsStops) {
  const std::string cell = test::places::sources() + "/config/cells/stops.yaml";
  constexpr double kMargin = 0.05;  // m: in this cell
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell}, dds_arguments(dds)));
  ChildProcess arm(test::places::programs() + "/example_arm",
                   with({"stops", cell, "--seconds", "5"}, dds_arguments(dds)));
  ASSERT_EQ(arm.wait(std::chrono::seconds(300)), 0) << arm.output();
  for (const char* const obeyed : {"zones ", "S_p ", "stops "}) {
    const Obeying outcome = obeying(arm.output(), obeyed);
    EXPECT_GT(outcome.moving, kMargin) << obeyed << arm.output();
    EXPECT_LT(outcome.ever, 2.0) << obeyed << "has no person beside it: " << arm.output();
    EXPECT_GT(outcome.at_full_speed, 0.0) << obeyed << arm.output();
    EXPECT_LT(outcome.at_full_speed, 100.0) << obeyed << "is not held back: " << arm.output();
  }
  EXPECT_GT(obeying(arm.output(), "stops ").at_full_speed,
            obeying(arm.output(), "S_p ").at_full_speed)
      << arm.output();
}

TEST(StoppingArm, NeedsACellThatSaysHowItStops) {
  const DdsOptions dds = own_dds();
  ChildProcess arm(
      test::places::programs() + "/example_arm",
      with({"stops", test::places::sources() + "/config/cells/avoid.yaml"}, dds_arguments(dds)));
  EXPECT_EQ(arm.wait(), 1);
  EXPECT_TRUE(arm.wrote("'stopping'")) << arm.output();
}

}  // namespace
}  // namespace clearance::test
