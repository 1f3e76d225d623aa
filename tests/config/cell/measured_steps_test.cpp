// The keys `load` and `extension` of `stopping`, as maps: what the arm carries and how far it
// reaches choose the rows of its table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/config/cell/stopping_cell.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;

constexpr double kOneDegree = std::numbers::pi / 180.0;

// Of the shoulder, whose full speed is 3 rad/s: 10 degrees a step of the load, and 1 of the
// extension.
std::string table() {
  std::string csv = "joint,load_percent,extension_percent,speed_percent,time_ms,angle_deg\n";
  for (const int load : {1, 2})
    for (const int extension : {1, 2, 3})
      csv += "1," + std::to_string(50 * load) + "," + std::to_string(40 * extension) + ",100,400," +
             std::to_string(10 * load + extension) + "\n";
  return csv;
}

class MeasuredSteps : public StoppingCells {
 protected:
  MeasuredSteps() { test::write_text(folder_ / "stops.csv", table()); }
  static std::string with(const std::string& conditions, const std::string& objects = "") {
    return cell("{reaction_ms: 10, table: stops.csv, time_ms: 200, " + conditions + "}", objects);
  }
  // Of the shoulder from its full speed, degrees.
  static double most(const Scene& scene) {
    return stop(scene, "shoulder").distance(3.0) / kOneDegree;
  }
  static std::string part(const std::string& name, const std::string& to, const std::string& more) {
    return "  - {name: " + name + ", sphere: {radius: 0.01}, attached: {to: " + to + "}" + more +
           "}\n";
  }
};

TEST_F(MeasuredSteps, OfTheLoadFollowFromTheMassesOfWhatIsAttached) {
  const std::string load = "load: {full: 10, tool: 3}";
  EXPECT_NEAR(most(scene(with(load))), 13, 1e-9) << "the tool alone is 30 %";
  EXPECT_NEAR(most(scene(with(load, part("bolt", "rail", ", mass: 2")))), 13, 1e-9);
  EXPECT_NEAR(most(scene(with(load, part("bolt", "rail", ", mass: 2.5")))), 23, 1e-9);
  EXPECT_NEAR(
      most(scene(with("load: {full: 0.3, tool: 0.1}", part("bolt", "rail", ", mass: 0.2")))), 23,
      1e-9)
      << "the full load";
  EXPECT_NEAR(most(scene(with(load, part("bolt", "rail", "")))), 23, 1e-9) << "its mass is unknown";
  EXPECT_NEAR(most(scene(with(load, part("box", "post", ", mass: 5")))), 13, 1e-9)
      << "it stands beside the arm";
  EXPECT_NEAR(most(scene(with(
                  load, part("bolt", "rail", ", mass: 1.5") + part("nut", "bolt", ", mass: 1.5")))),
              23, 1e-9)
      << "what is attached to a load is part of it";
  EXPECT_THAT(
      errors(with(load, part("bolt", "rail", ", mass: 7.5"))),
      mistake_at("cell.yaml:4", "found 10.5 kg on the robot 'arm', 105 %", "at most 100 %"));
}

TEST_F(MeasuredSteps, OfTheLoadCountToolsWithJoints) {
  test::write_text(folder_ / "tool.urdf",
                   R"(<robot name="tool"><link name="root"><collision><geometry>
                        <sphere radius="0.02"/></geometry></collision></link></robot>)");
  const auto most_with = [&](const std::string& more) {
    std::string text = with("load: {full: 10, tool: 3}");
    text.insert(
        text.find("objects:"),
        "  - {name: tool, urdf: tool.urdf, prefix: t_, attached: {to: hand}" + more + "}\n");
    return most(scene(text + "  - {between: [tool, post]}\n"));
  };
  EXPECT_NEAR(most_with(", mass: 2"), 13, 1e-9);
  EXPECT_NEAR(most_with(", mass: 3"), 23, 1e-9);
  EXPECT_NEAR(most_with(""), 23, 1e-9) << "its mass is unknown";
  EXPECT_NEAR(most_with(", absent: true"), 13, 1e-9);
}

TEST_F(MeasuredSteps, OfTheExtensionHaveAllJointsAndTheWorstLast) {
  const Scene arm = scene(with("load: 50, extension: {link: hand, reach: 2}"));
  const RobotStops& stops = arm.robots[0].stopping;
  ASSERT_EQ(stops.steps.size(), 3u);
  const std::size_t shoulder = joint(arm, "shoulder");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(stops.steps[i].extension, 0.4 * (static_cast<double>(i) + 1), 1e-12);
    EXPECT_NEAR(stops.steps[i].joints[shoulder].distance(3.0) / kOneDegree,
                11 + static_cast<double>(i), 1e-9);
    EXPECT_EQ(stops.steps[i].joints[joint(arm, "elbow")].time(1.0), 0.2);
  }
  EXPECT_NEAR(most(arm), 13, 1e-9);
  EXPECT_TRUE(scene(with("load: 50")).robots[0].stopping.steps.empty());
}

// The hand is 0.5 to 1.5 m from the elbow, and the prismatic joint moves it straight.
TEST_F(MeasuredSteps, OfTheExtensionKnowHowFastEachJointChangesIt) {
  const Scene arm = scene(with("extension: {link: hand, reach: 2}"));
  const Extension& extension = arm.robots[0].stopping.extension;
  EXPECT_EQ(extension.joint, joint(arm, "shoulder"));
  EXPECT_EQ(extension.levers[joint(arm, "shoulder")], 0.0) << "it turns about this axis";
  const RobotJoint& reach = arm.robots[0].joints[joint(arm, "reach")];
  EXPECT_NEAR(extension.levers[joint(arm, "elbow")],
              1.5 + arm.variables[reach.variable].limit_tolerance, 1e-12)
      << "positions may be a little beyond their limits";
  EXPECT_NEAR(extension.levers[joint(arm, "reach")], 1.0, 1e-12);
  EXPECT_EQ(extension.levers[joint(arm, "grip")], 0.0) << "it is beyond the hand";
  const auto fingers = scene(with("extension: {link: right, reach: 2}")).robots[0].stopping;
  EXPECT_EQ(fingers.extension.levers[joint(arm, "grip")], 1.0) << "the finger mimics it";
  EXPECT_EQ(fingers.extension.levers[joint(arm, "finger")], 0.0);
}

TEST_F(MeasuredSteps, AreRefusedWithWhatIsWrong) {
  EXPECT_THAT(errors(with("extension: {link: hnad, reach: 2}")),
              mistake_at("cell.yaml:5", "found the link 'hnad'", "'hand'"));
  EXPECT_THAT(errors(with("extension: {link: upper, reach: 2}")),
              mistake_at("cell.yaml:5", "'upper', which no joint moves away from an axis"));
  EXPECT_THAT(errors(with("extension: {link: hand}")), mistake_at("cell.yaml:5", "'reach'"));
  EXPECT_THAT(errors(with("extension: {link: hand, reach: 0}")), mistake_at("cell.yaml:5", "0"));
  EXPECT_THAT(errors(with("extension: {link: hand, reach: 900}")),
              mistake_at("cell.yaml:5", "found a reach of 900 m", "a unit wrong"));
  EXPECT_THAT(errors(with("load: {tool: 2}")), mistake_at("cell.yaml:5", "'full'"));
  EXPECT_THAT(errors(with("load: {full: 2}")), mistake_at("cell.yaml:5", "'tool'"));
  EXPECT_THAT(errors(with("load: {full: 5, tool: -1}")), mistake_at("cell.yaml:5", "-1"));
  EXPECT_THAT(errors(cell("{reaction_ms: 10, time_ms: 200, load: {full: 5, tool: 1}}")),
              mistake_at("cell.yaml:5", "found 'load' without 'table'"));
  test::write_text(folder_ / "stops.csv",
                   "joint,extension_percent,speed_percent,time_ms,angle_deg\n1,66,100,400,20\n");
  EXPECT_THAT(errors(with("extension: {link: hand, reach: 2}")),
              mistake_at("cell.yaml:5", "found extensions up to 66 %", "100 %"));
}

}  // namespace
}  // namespace clearance
