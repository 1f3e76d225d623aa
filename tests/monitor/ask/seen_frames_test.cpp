// Oracle: the same question beside each measured point, as a sphere of the cell.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance::seen_frames_test {
namespace {

using test::answered, test::scara_beside, test::swing;

constexpr double kRadius = 0.0625;

Scene scara_with_an_eye(const std::string& more = "") {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf}]\n"
      "sensors: [{name: eye, points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 4], "
      "mount: {pose: {xyz: [0, 0, 2]}}" +
          more + "}]\npairs: [{between: [arm, eye]}, {between: [arm, arm]}]\n",
      folder / "cell.yaml");
}

// Points of the world that are exact in float, and the frame of a sensor at its origin.
struct Seen {
  explicit Seen(int count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<MeasuredPoint> measured;
    for (int i = 0; i < count; ++i) {
      const auto coordinate = [&] {
        return static_cast<double>(static_cast<int>(engine() % 256) - 128) / 64.0;
      };
      Vec3 point(coordinate() + 0.5, coordinate(), 0.0);
      points.push_back(point);
      measured.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()), 0.0F,
                          static_cast<float>(kRadius)});
    }
    auto made = std::make_shared<SeenCloud>(SeenCloud::of_points(measured.size()));
    EXPECT_EQ(made->points()->build(measured, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
    cloud = std::move(made);
  }
  std::vector<Vec3> points;
  std::shared_ptr<const SeenCloud> cloud;
};

TEST(SeenFrames, AMotionIsCertifiedAgainstTheNearestPointOfAll) {
  const Scene scene = scara_with_an_eye();
  int free = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Seen seen(5, seed);
    Question question = swing(-1.0, 0.4);
    question.tolerance = 1e-6;
    question.others = OthersMove::kNot;
    question.margins = {0.0, 0.1};
    double least = 1e300;
    for (const Vec3& point : seen.points) {
      const std::string at = std::to_string(point.x()) + ", " + std::to_string(point.y()) + ", 0";
      Question beside = question;
      beside.tolerance = 1e-9;
      least = std::min(least, answered(scara_beside("fixed: true, sphere: {radius: 0.0625}, pose: "
                                                    "{xyz: [" +
                                                    at + "]}"),
                                       beside)
                                  .upper);
    }
    question.seen = {{.sensor = "eye", .cloud = seen.cloud, .world_from_sensor = {}}};
    const Answer answer = answered(scene, question);
    EXPECT_TRUE(answer.within_work_limit);
    EXPECT_LE(answer.lower, least + 1e-9);
    EXPECT_GE(answer.upper, least - 1e-9);
    EXPECT_LE(answer.upper - answer.lower, 1e-6 + 1e-12);
    for (const MarginAnswer& margin : answer.margins) {
      const bool is_free = margin.margin > 0.0 ? least >= margin.margin : least > 0.0;
      EXPECT_EQ(margin.verdict, is_free ? Verdict::kFree : Verdict::kBelow) << seed;
      free += is_free ? 1 : 0;
    }
    Answer again;
    Asker asker(scene);
    ASSERT_FALSE(asker.ask(question, again));
    Question other = question;
    other.motion.positions = {1.0, 2.0};
    ASSERT_FALSE(asker.ask(other, again));
    ASSERT_FALSE(asker.ask(question, again));
    EXPECT_EQ(again.lower, answer.lower) << "whatever was asked before";
  }
  EXPECT_GT(free, 2);
}

// One point before the finger, which rests at 2 m. The frame and its place are not exact.
TEST(SeenFrames, AgeSpeedAndErrorOfAFrameWidenTheBounds) {
  std::vector<MeasuredPoint> measured = {{0.5F, 0.0F, 0.0F, static_cast<float>(kRadius)}};
  auto cloud = std::make_shared<SeenCloud>(SeenCloud::of_points(1));
  ASSERT_EQ(cloud->points()->build(measured, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  Question question = swing(0.0, 0.0);
  question.tolerance = 1e-5;
  question.seen = {{.sensor = "eye",
                    .cloud = cloud,
                    .world_from_sensor = {.position = {2.5, 0.0, 0.0}},
                    .pose_error = 0.01,
                    .age = 0.5}};
  const double now = 3.0 - 2.0 - 0.05 - kRadius;
  const Answer moving = answered(scara_with_an_eye(", max_speed: 0.1"), question);
  EXPECT_NEAR(moving.lower, now - 0.01 - 0.1 * 2.5, 1.1e-5);
  question.others = OthersMove::kNot;
  const Answer still = answered(scara_with_an_eye(), question);
  EXPECT_NEAR(still.lower, now - 0.01, 1e-6);
  EXPECT_GE(still.upper, now - 1e-9);
}

// The finger circles at 2 m. Elements farther than 3 m from the origin were cropped.
TEST(SeenFrames, WhatMayHaveBeenCroppedBoundsAnAnswerWithoutEndlessDivision) {
  std::vector<MeasuredPoint> measured = {{-2.875F, 0.0F, 0.0F, static_cast<float>(kRadius)}};
  auto cloud = std::make_shared<SeenCloud>(SeenCloud::of_points(1));
  ASSERT_EQ(cloud->points()->build(measured, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  cloud->note_crop({.centre = Vec3::Zero(), .radius = 3.0});
  Question question = swing(-1.0, 0.4);
  question.others = OthersMove::kNot;
  question.margins = {0.0, 0.5, 1.0};
  question.seen = {{.sensor = "eye", .cloud = cloud, .world_from_sensor = {}}};
  const Answer answer = answered(scara_with_an_eye(), question);
  EXPECT_TRUE(answer.within_work_limit);
  EXPECT_LT(answer.queries, 10'000u);
  EXPECT_LE(answer.lower, 0.95);
  EXPECT_GT(answer.lower, 0.95 - 2.0 * question.tolerance);
  EXPECT_GT(answer.upper, 1.0);
  ASSERT_EQ(answer.margins.size(), 3u);
  EXPECT_EQ(answer.margins[0].verdict, Verdict::kFree);
  EXPECT_EQ(answer.margins[1].verdict, Verdict::kFree);
  EXPECT_EQ(answer.margins[2].verdict, Verdict::kUndecided) << "a cropped element may be nearer";
}

// Unseen is not clear.
TEST(SeenFrames, ASensorWithoutAFrameIsRefusedByItsName) {
  const Scene scene = scara_with_an_eye(", max_speed: 0.1");
  Question question = swing(0.0, 0.4);
  const auto names_the_sensor = [&] {
    const auto answer = ask(scene, question);
    const auto* text = std::get_if<std::string>(&answer);
    return text != nullptr && text->find("sensor \"eye\"") != std::string::npos;
  };
  EXPECT_TRUE(names_the_sensor()) << "no frame";
  question.seen = {{.sensor = "eye", .cloud = nullptr, .world_from_sensor = {}}};
  EXPECT_TRUE(names_the_sensor()) << "an empty one";
  question.seen.clear();
  question.poses = {{.object = "eye", .world_from_object = {}}};
  EXPECT_TRUE(names_the_sensor()) << "a pose is no frame";
  question.poses.clear();
  const Seen seen(5, 3);
  question.seen = {{.sensor = "eye", .cloud = seen.cloud, .world_from_sensor = {}}};
  EXPECT_TRUE(std::holds_alternative<Answer>(ask(scene, question)));
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scara_with_an_eye(), question)))
      << "no max_speed";
  question.others = OthersMove::kNot;
  EXPECT_TRUE(std::holds_alternative<Answer>(ask(scara_with_an_eye(), question)));
}

}  // namespace
}  // namespace clearance::seen_frames_test
