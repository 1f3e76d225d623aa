// clearance-view's page shows how a robot stops: a row, a ghost where it comes to stand, and the
// pair that limits its speed.
//
// Oracle: the closed forms of an arm with two joints of one metre each, and of their stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kShoulder = 0.2, kElbow = 0.5;            // rad
constexpr double kShoulderSpeed = 0.8, kElbowSpeed = 0.6;  // rad/s
constexpr double kToPin = 0.3;                             // s, at these speeds
constexpr double kRadii = 0.05 + 0.05, kMargin = 0.05;     // m: of finger and pin
constexpr double kReaction = 0.04 + 1.0 / 200.0;           // s: stated, and a period
constexpr double kDeceleration = 1.0, kElbowTime = 0.3;    // rad/s2; s
constexpr double kAgeLimit = 20.0;                         // s

struct Place {
  double x = 0.0, y = 0.0;
};
Place elbow_at(double shoulder) { return {std::cos(shoulder), std::sin(shoulder)}; }
Place finger_at(double shoulder, double elbow) {
  return {std::cos(shoulder) + std::cos(shoulder + elbow),
          std::sin(shoulder) + std::sin(shoulder + elbow)};
}

// How far each joint goes on after the brakes act, rad.
std::array<double, 2> braking(const std::string& path) {
  const double shoulder = 0.5 * kShoulderSpeed * kShoulderSpeed / kDeceleration;
  const double elbow = kElbowSpeed * kElbowTime;
  if (path == "left") return {shoulder, elbow};
  const double longest = std::max(shoulder / kShoulderSpeed, elbow / kElbowSpeed);
  return {longest * kShoulderSpeed, longest * kElbowSpeed};
}

// The joints' angles of the ghost show the reaction, which is longer by the age of the positions:
// one age for both joints.
void expect_standstill(const json& ghosts, double sign, const std::string& path) {
  ASSERT_EQ(ghosts.size(), 3u) << ghosts << "the links that move";
  const auto angle = [&](const char* link) {
    return std::atan2(ghosts[link]["x"][1].get<double>(), ghosts[link]["x"][0].get<double>());
  };
  const double shoulder = angle("upper"), elbow = angle("lower") - shoulder;
  const auto [shoulder_braking, elbow_braking] = braking(path);
  const double until = (sign * (shoulder - kShoulder) - shoulder_braking) / kShoulderSpeed;
  EXPECT_NEAR((sign * (elbow - kElbow) - elbow_braking) / kElbowSpeed, until, 1e-9);
  EXPECT_GE(until, kReaction - 1e-9);
  EXPECT_LE(until, kReaction + kAgeLimit);
  const Place at = finger_at(shoulder, elbow), bend = elbow_at(shoulder);
  EXPECT_NEAR(ghosts["finger"]["place"][0], at.x, 1e-9);
  EXPECT_NEAR(ghosts["finger"]["place"][1], at.y, 1e-9);
  // The middle of the second link is half of the elbow's and the finger's places.
  EXPECT_NEAR(ghosts["lower"]["place"][0], 0.5 * (bend.x + at.x), 1e-9);
  EXPECT_NEAR(ghosts["lower"]["place"][1], 0.5 * (bend.y + at.y), 1e-9);
}

void expect_colour(const json& ghosts, const json& colour) {
  for (const auto& [link, ghost] : ghosts.items()) EXPECT_EQ(ghost["colour"], colour) << link;
}

// The page's facts by stage, while the arm rests, then moves away from the pin, then towards it.
std::map<std::string, json> shown_of_arm(const std::string& path) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const std::string file = (folder / "cell.yaml").string();
  const Place pin = finger_at(kShoulder + kShoulderSpeed * kToPin, kElbow + kElbowSpeed * kToPin);
  write_text(
      file,
      "name: stopping\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
      "defaults: {age_limit_ms: 20000}\nrobots:\n"
      "  - {name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, stopping: "
      "{reaction_ms: 40, path: " +
          path +
          ", time_ms: 300, joints: {shoulder: {deceleration: 1}}}}\n"
          "objects: [{name: pin, fixed: true, sphere: {radius: 0.05}, pose: {xyz: [" +
          std::to_string(pin.x) + ", " + std::to_string(pin.y) +
          ", 0]}}, {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -50}}]\n"
          "pairs: [{between: [finger, pin]}, {between: [arm, wall]}]\n"
          "zones: [{name: stops clear, between: [finger, pin], stops: {margin: "
          "0.05}}]\n");
  const DdsOptions dds = own_dds();
  const ChildProcess daemon(kDaemon, with({file}, dds_arguments(dds)));
  const View view(with({file}, dds_arguments(dds)));
  Participant participant(dds);
  RosJoints joints(participant);
  EXPECT_TRUE(joints.is_heard()) << daemon.output();
  PageScript page("stops", {view.page()});
  const auto send_until = [&](const char* text, double share) {
    EXPECT_TRUE(eventually(
        [&] {
          joints.send({"shoulder", "elbow", "push"}, {kShoulder, kElbow, 0.0},
                      {share * kShoulderSpeed, share * kElbowSpeed, 0.0});
          return page.wrote(text);
        },
        std::chrono::seconds(200)))
        << page.output();
  };
  send_until("rests", 0.0);
  send_until("moves away", -1.0);
  send_until("linked", 1.0);
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  std::map<std::string, json> shown;
  for (const json& line : lines_of(page)) shown[line["stage"]] = line;
  return shown;
}

class ViewOfAStoppingRobot : public testing::TestWithParam<std::string> {};

TEST_P(ViewOfAStoppingRobot, HasARowAGhostWhereItStandsAndThePairThatLimitsIt) {
  std::map<std::string, json> shown = shown_of_arm(GetParam());
  ASSERT_EQ(shown.size(), 5u);
  const json& rests = shown["rests"];
  const Place from = finger_at(kShoulder, kElbow);
  const Place pin = finger_at(kShoulder + kShoulderSpeed * kToPin, kElbow + kElbowSpeed * kToPin);
  const double distance = std::hypot(pin.x - from.x, pin.y - from.y) - kRadii;
  ASSERT_EQ(rests["row"].size(), 8u);
  EXPECT_EQ(rests["row"][0], "arm stops: pin – finger");
  EXPECT_NEAR(std::stod(std::string(rests["row"][1])), 1e3 * distance, 1.0);
  EXPECT_NEAR(std::stod(std::string(rests["row"][3])), 1e3 * (distance - kMargin), 1.0);
  EXPECT_EQ(rests["row"][4], "1.00");
  EXPECT_EQ(rests["row"][6], "100 %") << "of its motion is clear";
  EXPECT_EQ(rests["kind"], "");
  EXPECT_EQ(rests["ghosts"], json::object()) << "none at rest";

  const json& away = shown["moves away"];
  EXPECT_EQ(away["row"][4], "1.00");
  EXPECT_EQ(away["kind"], "");
  EXPECT_EQ(away["row"][6], "100 %");
  EXPECT_GE(std::stod(std::string(away["row"][7])), kReaction + kElbowTime - 0.005)
      << "the time until it stands";
  expect_standstill(away["ghosts"], -1.0, GetParam());
  expect_colour(away["ghosts"], away["good"]);
  EXPECT_EQ(away["lines"], json({{{"pair", "pin – finger"}, {"level", "outside"}}}));

  const json& near = shown["comes near"];
  EXPECT_LT(std::stod(std::string(near["row"][4])), 1.0);
  EXPECT_LT(std::stod(std::string(near["row"][6])), 100.0);
  const json &head = near["csv"][0], &first = near["csv"][1];
  ASSERT_EQ(head.size(), first.size());
  const auto saved = [&](const char* column) {
    return std::string(first.at(std::ranges::find(head, column) - head.begin()));
  };
  EXPECT_LT(std::stod(saved("arm/stop_scaling")), 1.0);
  EXPECT_LT(std::stod(saved("arm/stop_share")), 1.0);
  EXPECT_LT(std::stod(saved("arm/stop_clearance_m")), 0.0);
  EXPECT_EQ(saved("arm/stop_pair"), "pin – finger");
  EXPECT_NEAR(std::stod(saved("stop_lower_m")), std::stod(saved("arm/stop_clearance_m")) + kMargin,
              1e-9);
  ASSERT_NE(near["plotted"], "") << "a cell without other scalings has the plot";
  EXPECT_LT(std::stod(std::string(near["plotted"])), 1.0);
  EXPECT_EQ(near["kind"], "alarm");
  EXPECT_THAT(std::string(near["row"][3]), HasSubstr("−")) << "nearer than the margin";
  expect_standstill(near["ghosts"], 1.0, GetParam());
  expect_colour(near["ghosts"], near["alarm"]);
  EXPECT_EQ(near["lines"], json({{{"pair", "pin – finger"}, {"level", "inside"}}}));

  EXPECT_EQ(shown["without"]["ghosts"], json::object());
  EXPECT_EQ(shown["without"]["query"], "off");
  EXPECT_EQ(shown["without"]["pairs"], "pin~finger") << "chosen by a click on the row";
  EXPECT_EQ(shown["linked"]["ghosts"], json::object());
  EXPECT_EQ(shown["linked"]["query"], "off");
  EXPECT_EQ(shown["linked"]["errors"], json::array());
}

INSTANTIATE_TEST_SUITE_P(Paths, ViewOfAStoppingRobot, testing::Values("kept", "left"),
                         [](const auto& path) { return path.param; });

}  // namespace
}  // namespace clearance::test
