// clearance-ask on bags of ROS 2. The oracle is the closed form of an arm that swings past a pin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/monitor/recording/ros_camera.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

const std::string kAsk = test::places::programs() + "/clearance-ask";
constexpr std::int64_t kSecondNs = 1'000'000'000;

struct PointText {
  double time = 0.0;
  std::vector<double> positions;
  std::vector<double> velocities = {}, accelerations = {};
};

RosMessage trajectory(std::int64_t log_ns, const std::vector<std::string>& joints,
                      const std::vector<PointText>& points, std::int64_t stamp_ns = 0) {
  RosCdr cdr;
  cdr.header(stamp_ns, "").number(static_cast<std::uint32_t>(joints.size()));
  for (const std::string& joint : joints) cdr.text(joint);
  cdr.number(static_cast<std::uint32_t>(points.size()));
  for (const PointText& point : points) {
    cdr.numbers(point.positions).numbers(point.velocities).numbers(point.accelerations).numbers({});
    const auto ns = static_cast<std::int64_t>(point.time * 1e9);
    cdr.number(static_cast<std::int32_t>(ns / kSecondNs));
    cdr.number(static_cast<std::uint32_t>(ns % kSecondNs));
  }
  return {"/arm/joint_trajectory", "trajectory_msgs/msg/JointTrajectory", log_ns, cdr.bytes()};
}

// The finger is a sphere of 0.05 m that circles at 2 m around the origin.
class AskOfABag : public RunsPrograms {
 protected:
  void SetUp() override {
    write_text(folder / "scara.urdf", kScaraUrdf);
    write_text(folder / "cell.yaml",
               "name: bag\nunits: {length: m, angle: rad}\ndefaults: {age_limit_ms: 20000}\n"
               "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
               "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
               "pairs: [{between: [arm, pin]}, {between: [arm, arm]}]\n");
  }
  int ask(const std::vector<RosMessage>& messages, const std::vector<std::string>& more = {}) {
    write_mcap_bag(path("run.mcap"), messages);
    const int status = run(kAsk, with({path("cell.yaml"), path("run.mcap"), "--out",
                                       path("answers.jsonl"), "--tolerance", "1e-6"},
                                      more));
    answers.clear();
    std::ifstream file(path("answers.jsonl"));
    for (std::string line; std::getline(file, line);)
      answers.push_back(nlohmann::json::parse(line));
    return status;
  }
  std::vector<nlohmann::json> answers;
};

const JointStateText kRest{
    {"elbow", "push", "shoulder", "elsewhere"}, {0.0, 0.0, -1.0, 7.0}, {0.0, 0.0, 0.0, 0.0}};

TEST_F(AskOfABag, HoldsTheOtherJointsWhereTheJointStatesHaveThem) {
  ASSERT_EQ(ask({joint_state(kSecondNs, kSecondNs, kRest),
                 trajectory(2 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {0.6}}})}),
            0)
      << output;
  EXPECT_EQ(answers.at(0)["id"], "/arm/joint_trajectory at 1.000 s");
  EXPECT_NEAR(answers[0]["upper"], 0.15, 1e-6);
  EXPECT_NEAR(answers[0]["t"], 1.25, 1e-3);
  EXPECT_EQ(answers[0]["verdict"]["0.05"], "free");
}

// A topic of the robot has its names without the prefix. Another one's joint states are not its
// own.
TEST_F(AskOfABag, ReadsJointStatesByTheTopicAndThePrefixOfARobot) {
  write_text(folder / "cell.yaml",
             "name: bag\nunits: {length: m, angle: rad}\ndefaults: {age_limit_ms: 20000}\n"
             "robots: [{name: arm, prefix: left_, urdf: scara.urdf, joint_states: /left/state}]\n"
             "objects:\n"
             "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
             "pairs: [{between: [arm, pin]}, {between: [arm, arm]}]\n");
  const JointStateText elsewhere{
      {"left_elbow", "left_push", "left_shoulder"}, {1.0, 0.1, 2.0}, {0.0, 0.0, 0.0}};
  ASSERT_EQ(ask({joint_state(kSecondNs, kSecondNs, kRest, "/left/state"),
                 joint_state(kSecondNs, kSecondNs, elsewhere, "/right/state"),
                 trajectory(2 * kSecondNs, {"left_shoulder"}, {{2.0, {0.6}}})}),
            0)
      << output;
  EXPECT_NEAR(answers.at(0)["upper"], 0.15, 1e-6);
}

// The controller swings from -1 rad to the only point.
TEST_F(AskOfABag, BeginsWhereTheJointsAreIfTheFirstPointIsLater) {
  const RosMessage late = trajectory(2 * kSecondNs, {"shoulder"}, {{2.0, {0.6}}});
  ASSERT_EQ(ask({joint_state(kSecondNs, kSecondNs, kRest), late}), 0) << output;
  EXPECT_NEAR(answers.at(0)["upper"], 0.15, 1e-6);
  EXPECT_EQ(ask({late}), 1) << "nothing says where it begins";
  EXPECT_TRUE(answers.at(0).contains("error"));
}

// As the daemon judges them: nothing rests on a joint that it would not use.
TEST_F(AskOfABag, HasNoInputWhereTheDaemonWouldHaveNone) {
  const auto reason = [&](const std::vector<RosMessage>& messages) {
    EXPECT_EQ(ask(messages), 1) << output;
    return answers.at(0).value("error", "answered");
  };
  const auto at = [](double seconds) { return static_cast<std::int64_t>(seconds * 1e9); };
  const auto elbow = [&](double seconds, double position, double velocity,
                         const std::string& topic = "/joint_states") {
    return joint_state(at(seconds), at(seconds),
                       {{"elbow", "push", "shoulder"}, {position, 0, -1}, {velocity, 0, 0}}, topic);
  };
  const auto motion = [&](double seconds) {
    return trajectory(at(seconds), {"shoulder"}, {{0.0, {-1.0}}, {1.0, {-0.9}}});
  };
  EXPECT_EQ(ask({elbow(1, 0, 0), motion(20.9)}), 0) << output;
  EXPECT_NE(reason({elbow(1, 0, 0), motion(21.1)}).find("older than its age limit"),
            std::string::npos);
  EXPECT_NE(reason({elbow(1, 0, 0.5), motion(1.01)}).find("'elbow' moves at 0.5 rad/s"),
            std::string::npos);
  EXPECT_NE(reason({elbow(1, 1e7, 0), motion(1.01)}).find("'elbow' unknown"), std::string::npos);
  EXPECT_NE(reason({motion(1), elbow(1.01, 0, 0)}).find("'elbow' unknown"), std::string::npos)
      << "what comes later";
  std::string cell = read_text(path("cell.yaml"));
  write_text(path("cell.yaml"), cell.replace(cell.find("20000"), 5, "50"));
  std::vector<RosMessage> two;
  for (int i = 0; i < 20; ++i) {
    two.push_back(elbow(1 + 0.01 * i, 0.0, 0.0));
    two.push_back(elbow(1.005 + 0.01 * i, 1.5, 0.0, "/other/joint_states"));
  }
  two.push_back(motion(1.2));
  EXPECT_NE(reason(two).find("'elbow' contradicted"), std::string::npos);
  EXPECT_EQ(ask({trajectory(at(1), {"shoulder", "elbow", "push"},
                            {{0.0, {-1.0, 0.0, 0.0}}, {1.0, {-0.9, 0.0, 0.0}}})}),
            0)
      << "a motion of all joints needs no other input: " << output;
}

// The finger is at rest 1 m from the cart, which comes nearer by 0.1 m/s.
TEST_F(AskOfABag, AStampAheadDelaysAMotionAndIsRefusedBeyondTheAgeLimit) {
  write_text(folder / "cell.yaml",
             "name: bag\nunits: {length: m, angle: rad}\ndefaults: {age_limit_ms: 5000}\n"
             "ros2: {world_frame: map}\nrobots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
             "  - {name: cart, frame: cart_link, may_jump: true, max_speed: 0.1, sphere: {radius: "
             "0.1}}\npairs: [{between: [arm, cart]}]\n");
  const auto lower = [&](std::int64_t stamp_ns) {
    const JointStateText rest{{"elbow", "push", "shoulder"}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    ask({joint_state(kSecondNs, kSecondNs, rest),
         transforms(kSecondNs, kSecondNs, {{"map", "cart_link", {3.15, 0.0, 0.0}}}),
         trajectory(kSecondNs, {"shoulder"}, {{0.0, {0.0}}, {1.0, {0.0}}}, stamp_ns)});
    return answers.at(0);
  };
  EXPECT_NEAR(lower(0)["lower"], 1.0 - 0.1, 1e-3);
  EXPECT_NEAR(lower(kSecondNs)["lower"], 1.0 - 0.1, 1e-3);
  EXPECT_NEAR(lower(kSecondNs / 2)["lower"], 1.0 - 0.1, 1e-3) << "in the past";
  EXPECT_NEAR(lower(5 * kSecondNs)["lower"], 1.0 - 0.5, 1e-3);
  EXPECT_NE(lower(7 * kSecondNs).value("error", "").find("header.stamp 6.000 s ahead"),
            std::string::npos)
      << answers.at(0);
}

TEST_F(AskOfABag, TakesVelocitiesAndRefusesAccelerations) {
  const auto with_points = [&](std::vector<PointText> points) {
    return ask({joint_state(kSecondNs, kSecondNs, kRest),
                trajectory(2 * kSecondNs, {"shoulder"}, points)});
  };
  ASSERT_EQ(with_points({{0.0, {-1.25}}, {2.0, {-1.0}}}), 0) << output;
  EXPECT_EQ(answers.at(0)["start_deviation"], 0.25);
  const double held = answers.at(0)["upper"];
  ASSERT_EQ(with_points({{0.0, {-1.0}, {3.0}}, {2.0, {-1.0}, {-3.0}}}), 0) << output;
  EXPECT_LT(answers.at(0)["upper"].get<double>(), held - 0.1) << "it leaves its chord";
  EXPECT_EQ(with_points({{0.0, {-1.0}, {0.0}, {1.0}}, {2.0, {-0.9}, {0.0}, {0.0}}}), 1);
  EXPECT_NE(answers.at(0)["error"].get<std::string>().find("accelerations"), std::string::npos);
}

TEST_F(AskOfABag, FailsIfAMotionComesNearerThanExpected) {
  const std::vector<RosMessage> messages = {
      joint_state(kSecondNs, kSecondNs, kRest),
      trajectory(2 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {-0.5}}}),
      trajectory(3 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {0.6}}})};
  EXPECT_EQ(ask(messages, {"--expect-min-distance", "0.1"}), 0) << output;
  EXPECT_EQ(ask(messages, {"--expect-min-distance", "0.2"}), 1) << output;
  EXPECT_NE(output.find("/arm/joint_trajectory at 2.000 s"), std::string::npos) << output;
  EXPECT_NE(output.find("pin - finger"), std::string::npos) << output;
}

TEST_F(AskOfABag, RefusesABagWithoutAMotion) {
  EXPECT_EQ(ask({joint_state(kSecondNs, kSecondNs, kRest)}), 2);
  EXPECT_NE(output.find("JointTrajectory"), std::string::npos) << output;
}

// The profile covers each motion, and the page says which one fails.
TEST_F(AskOfABag, WritesProfilesAPlotAndAPage) {
  const std::vector<RosMessage> bag = {
      joint_state(kSecondNs, kSecondNs, kRest),
      trajectory(2 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {0.6}}}),
      trajectory(3 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {-0.5}}})};
  EXPECT_EQ(ask(bag, {"--expect-min-distance", "0.2", "--profile", path("p.csv"), "--plot",
                      path("p.svg"), "--report", path("p.html")}),
            1)
      << output;
  std::ifstream csv(path("p.csv"));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_EQ(line, "motion,from_s,to_s,lower_m,upper_m,first,second");
  double until = 0.0, least = 1e9;
  int rows = 0;
  while (std::getline(csv, line) && line.find("at 1.000 s") != std::string::npos) {
    double from = 0.0, to = 0.0, lower = 0.0, upper = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str() + line.find(',') + 1, "%lf,%lf,%lf,%lf", &from, &to, &lower,
                          &upper),
              4)
        << line;
    EXPECT_EQ(from, until);
    EXPECT_LE(lower, upper);
    least = std::min(least, upper);
    until = to;
    ++rows;
  }
  EXPECT_EQ(until, 2.0);
  EXPECT_NEAR(least, 0.15, 6e-3);
  EXPECT_GT(rows, 3);
  const std::string page = read_text(path("p.html"));
  EXPECT_NE(page.find("1 of them do not"), std::string::npos);
  EXPECT_NE(page.find("<td class=\"failed\">/arm/joint_trajectory at 1.000 s</td>"),
            std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos) << output;
  EXPECT_NE(read_text(path("p.svg")).find("</svg>"), std::string::npos);
}

// The cart comes to where the finger passes by. Each motion meets it where it is by then.
TEST_F(AskOfABag, TakesObjectsWhereTheBagHasThem) {
  write_text(folder / "cell.yaml",
             "name: bag\nunits: {length: m, angle: rad}\ndefaults: {age_limit_ms: 5000}\n"
             "ros2: {world_frame: map}\nrobots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
             "  - {name: cart, frame: cart_link, may_jump: true, max_speed: 0.1, sphere: {radius: "
             "0.1}}\npairs: [{between: [arm, cart]}]\n");
  const auto cart = [](std::int64_t ns, double x) {
    return transforms(ns, ns, {{"map", "cart_link", {x, 0.0, 0.0}}});
  };
  const std::vector<PointText> swing = {{0.0, {-1.0}}, {2.0, {0.6}}};
  ASSERT_EQ(ask({joint_state(kSecondNs, kSecondNs, kRest), cart(kSecondNs, 3.3),
                 trajectory(2 * kSecondNs, {"shoulder"}, swing), cart(3 * kSecondNs, 2.3),
                 trajectory(4 * kSecondNs, {"shoulder"}, swing),
                 trajectory(4 * kSecondNs, {"nothing"}, swing), cart(5 * kSecondNs, 2.3),
                 trajectory(9 * kSecondNs, {"shoulder"}, swing)},
                {"--others-still"}),
            1)
      << output;
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_NEAR(answers[0]["upper"], 1.15, 1e-6) << answers[0];
  EXPECT_NEAR(answers[1]["upper"], 0.15, 1e-6) << answers[1];
  EXPECT_TRUE(answers[2].contains("error"));
  EXPECT_TRUE(answers[3].contains("error")) << "nothing says where the cart is by then";
  // Unless it stands still, it comes nearer by its speed x the age of its pose and the time since.
  ask({joint_state(kSecondNs, kSecondNs, kRest), cart(kSecondNs, 3.3),
       trajectory(2 * kSecondNs, {"shoulder"}, swing), cart(3 * kSecondNs, 2.3)});
  EXPECT_NEAR(answers.at(0)["upper"], 1.15 - 0.1 * (1.0 + 1.25), 0.01) << answers[0];
}

// A camera looks down on a plate 0.1 m above the path of the finger.
TEST_F(AskOfABag, TakesWhatACameraSawBeforeTheMotion) {
  write_text(folder / "cell.yaml",
             "name: bag\nunits: {length: m, angle: rad}\ndefaults: {age_limit_ms: 5000}\n"
             "robots: [{name: arm, urdf: scara.urdf}]\n"
             "sensors:\n  - {name: eye, depth_image: /cam/depth, size: [80, 60], depth_error: "
             "{constant: 0.002}, range: [0.3, 5], own_shell: 0.005, age_limit_ms: 5000, "
             "mount: {pose: {xyz: [2.2, 0, 1], rpy: [3.141592653589793, 0, 0]}}}\n"
             "pairs: [{between: [arm, eye]}]\n");
  const PinholeCamera view{80, 60, 60.0, 60.0, 39.5, 29.5};
  const auto plate = [&](std::int64_t ns, float depth) {
    return depth_image(ns, view, std::vector<float>(80 * 60, depth));
  };
  const JointStateText rest{{"elbow", "push", "shoulder"}, {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}};
  const std::vector<PointText> swing = {{0.0, {-1.0}}, {2.0, {0.6}}};
  ASSERT_EQ(ask({camera_info(kSecondNs, view), joint_state(kSecondNs, kSecondNs, rest),
                 plate(kSecondNs + 1000, 0.9F), joint_state(2 * kSecondNs, 2 * kSecondNs, rest),
                 trajectory(2 * kSecondNs, {"shoulder"}, swing),
                 plate(2 * kSecondNs + kSecondNs / 2, 0.7F),
                 joint_state(3 * kSecondNs, 3 * kSecondNs, rest),
                 trajectory(3 * kSecondNs, {"shoulder"}, swing),
                 joint_state(4 * kSecondNs, 4 * kSecondNs, rest)},
                {"--others-still"}),
            0)
      << output;
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_NEAR(answers[0]["upper"], 0.1 - 0.05 - 0.002, 1e-3) << answers[0];
  EXPECT_NEAR(answers[1]["upper"], 0.3 - 0.05 - 0.002, 1e-3) << answers[1];
  EXPECT_EQ(answers[0]["pair"], (nlohmann::json{"eye", "finger"}));
}

// Without a frame, nothing is known of what the camera sees. A question may leave it out, but not
// ask for a margin of it then.
TEST_F(AskOfABag, LeavesOutSensorsThatTheQuestionNames) {
  std::string cell = read_text(path("cell.yaml"));
  cell.replace(cell.find("pairs: ["), 8,
               "sensors: [{name: eye, depth_image: /cam/depth, depth_error: {constant: 0.002}, "
               "range: [0.3, 2]}]\npairs: [{between: [arm, eye]}, ");
  write_text(path("cell.yaml"), cell);
  const JointStateText rest{{"elbow", "push", "shoulder"}, {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}};
  const std::vector<RosMessage> bag = {
      joint_state(kSecondNs, kSecondNs, rest),
      trajectory(kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {2.0, {0.6}}}),
      joint_state(kSecondNs + 10'000'000, kSecondNs + 10'000'000, rest)};
  const auto error = [&] { return answers.at(0).value("error", ""); };
  EXPECT_EQ(ask(bag), 1);
  EXPECT_NE(error().find("eye"), std::string::npos) << answers.at(0);
  ASSERT_EQ(ask(bag, {"--without", "eye"}), 0) << output;
  EXPECT_EQ(answers.at(0)["without"], nlohmann::json{"eye"});
  EXPECT_NEAR(answers[0]["upper"], 0.15, 1e-6);
  EXPECT_EQ(ask(bag, {"--without", "eye", "--margin", "finger,eye=0.05"}), 1);
  EXPECT_NE(error().find("leaves out"), std::string::npos) << answers.at(0);
  EXPECT_EQ(ask(bag, {"--without", "eye", "--without", "pin"}), 1);
  EXPECT_NE(error().find("\"pin\" is fixed"), std::string::npos) << answers.at(0);
}

// The motion ends at 0.8 rad/s, 0.1 s before the shoulder would stand.
TEST_F(AskOfABag, CountsStopsIfItsMotionsHaveToBeStoppable) {
  const std::vector<RosMessage> bag = {
      joint_state(kSecondNs, kSecondNs, kRest),
      trajectory(2 * kSecondNs, {"shoulder"}, {{0.0, {-1.0}}, {1.0, {-0.2}}})};
  EXPECT_EQ(ask(bag, {"--stoppable"}), 1);
  EXPECT_NE(answers.at(0)["error"].get<std::string>().find("stopping"), std::string::npos);
  std::string cell = read_text(path("cell.yaml"));
  cell.replace(cell.find("urdf: scara.urdf"), 16,
               "urdf: scara.urdf, joints: {elbow: {velocity: 2}}, stopping: {reaction_ms: 40, "
               "path: kept, time_ms: 60}");
  write_text(path("cell.yaml"), cell);
  const auto distance = [](double angle) {
    return std::sqrt(4.0 + 2.3 * 2.3 - 4.0 * 2.3 * std::cos(angle)) - 0.15;
  };
  ASSERT_EQ(ask(bag), 0) << output;
  EXPECT_NEAR(answers.at(0)["upper"], distance(0.2), 1e-6);
  ASSERT_EQ(ask(bag, {"--stoppable"}), 0) << output;
  EXPECT_NEAR(answers.at(0)["upper"], distance(0.2 - 0.8 * 0.1), 1e-6);
  write_text(path("motion.jsonl"),
             R"({"joints": ["shoulder"], "times_s": [0, 1], "positions": [[-1], [-0.2]],
                 "held": {"elbow": 0, "push": 0}, "stoppable": true, "time_scaling": true})");
  std::string line = read_text(path("motion.jsonl"));
  std::erase(line, '\n');
  write_text(path("motion.jsonl"), line + "\n");
  ASSERT_EQ(run(kAsk, {path("cell.yaml"), path("motion.jsonl"), "--out", path("answers.jsonl")}), 0)
      << output;
  const auto answer = nlohmann::json::parse(read_text(path("answers.jsonl")));
  EXPECT_NEAR(answer["upper"], distance(0.2 - 0.8 * 0.1), 1e-3);
  EXPECT_EQ(answer["time_scaling"]["factor"], 1.0);
}

// A bar of 1 m lies 2.6 m away. If it is rotated by 90 degrees, its side is towards the arm.
TEST_F(AskOfABag, AStatedPoseHasTheFormAndTheOrderOfACell) {
  write_text(folder / "cell.yaml",
             "name: bag\nunits: {length: m, angle: rad}\n"
             "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
             "  - {name: bar, box: {size: [1, 0.2, 0.2]}}\npairs: [{between: [arm, bar]}]\n");
  const auto ask_with = [&](const std::string& pose) {
    write_text(path("motion.jsonl"),
               R"({"joints": ["shoulder"], "times_s": [0, 2], "positions": [[-1], [0.6]], )"
               R"("held": {"elbow": 0, "push": 0}, "others": "still", "poses": {"bar": )" +
                   pose + "}}\n");
    run(kAsk, {path("cell.yaml"), path("motion.jsonl"), "--out", path("answers.jsonl")});
    return nlohmann::json::parse(read_text(path("answers.jsonl")));
  };
  EXPECT_NEAR(ask_with(R"({"xyz": [2.6, 0, 0]})").at("upper"), 0.05, 1e-3) << output;
  EXPECT_NEAR(ask_with(R"({"xyz": [2.6, 0, 0], "quaternion": [0, 0, 0, 1]})").at("upper"), 0.05,
              1e-3);
  EXPECT_NEAR(ask_with(R"({"xyz": [2.6, 0, 0], "quaternion": [0, 0, 0.6, 0.8]})").at("upper"),
              0.3568, 1e-3);
  for (const char* refused :
       {"[2.6, 0, 0, 1, 0, 0, 0]", R"({"xyz": [2.6, 0, 0], "rpy": [0, 0, 1]})", "{}"}) {
    EXPECT_EQ(ask_with(refused).at("error").get<std::string>().rfind(
                  R"(poses.bar: expected {"xyz": [x, y, z], "quaternion": [x, y, z, w]})", 0),
              0u);
  }
}

TEST_F(AskOfABag, AnswersHaveTheSameBytesInSeveralThreads) {
  std::vector<RosMessage> bag = {joint_state(kSecondNs, kSecondNs, kRest)};
  for (int i = 0; i < 12; ++i) {
    bag.push_back(trajectory((2 + i) * kSecondNs, {i == 5 ? "nothing" : "shoulder"},
                             {{0.0, {-1.0 + 0.1 * i}}, {2.0, {0.6}}}));
  }
  EXPECT_EQ(ask(bag), 1) << "one motion has an error";
  const std::string one = read_text(path("answers.jsonl"));
  EXPECT_EQ(ask(bag, {"--threads", "3"}), 1) << output;
  EXPECT_EQ(read_text(path("answers.jsonl")), one);
  EXPECT_EQ(answers.size(), 12u);
}

}  // namespace
}  // namespace clearance::test
