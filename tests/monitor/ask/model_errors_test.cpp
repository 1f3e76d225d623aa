// Answers hold for every machine within the stated errors of the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/shapes.hpp"
#include "tests/monitor/ask/scara_questions.hpp"
#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/true_bodies.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::answered, test::kPin, test::scara_beside, test::swing;

const std::string kScaraErrors =
    "errors: {joints: {position: 0.002, translation: 0.001}, bases: {translation: 0.002}, fixed: "
    "{translation: 0.003}}\n";

double distance_at(const Scene& scene, double shoulder, const test::DrawnErrors& errors) {
  const std::vector<double> positions = {shoulder, 0.0, 0.0};
  const std::vector<Pose> poses =
      test::true_poses(scene, positions, std::vector<Pose>(scene.objects.size()), errors);
  double least = kInfinity;
  for (const ObjectPair& pair : scene.pairs)
    least = std::min(least, test::fresh_distance(scene.objects[pair.first], poses[pair.first],
                                                 scene.objects[pair.second], poses[pair.second])
                                .upper);
  return least;
}

TEST(QuestionsWithModelErrors, NoMachineComesNearerThanTheAnswer) {
  const Scene scene = scara_beside(kPin, kScaraErrors);
  Question question = swing(-1.0, 0.6);
  question.margins = {0.12};
  const Answer answer = answered(scene, question);
  const Answer exact = answered(scara_beside(kPin), question);
  EXPECT_LT(answer.lower, exact.lower - 0.01) << "two joints, base and pin";
  EXPECT_GT(answer.lower, exact.lower - 0.03);
  EXPECT_GT(answer.upper, exact.upper);
  Random random(1);
  double nearest = kInfinity;
  for (std::uint64_t i = 0; i < repeats(4'000); ++i) {
    const double at = random.uniform(-0.1, 0.1);
    const double distance = distance_at(scene, at, test::drawn_errors(scene, random));
    ASSERT_LE(answer.lower, distance + 1e-9);
    nearest = std::min(nearest, distance);
  }
  EXPECT_LT(nearest, 0.147) << "the model comes to 0.15 m";
}

TEST(QuestionsWithModelErrors, AMarginIsOnlyFreeForAllMachines) {
  Question question = swing(-1.0, 0.6);
  question.margins = {0.145};
  EXPECT_EQ(answered(scara_beside(kPin), question).margins[0].verdict, Verdict::kFree);
  EXPECT_NE(answered(scara_beside(kPin, kScaraErrors), question).margins[0].verdict,
            Verdict::kFree);
}

TEST(QuestionsWithModelErrors, APayloadHasTheErrorOfAttachedObjects) {
  Question question = swing(-1.0, 0.6);
  question.payloads.push_back({.name = "part",
                               .shape = std::get<ConvexBody>(point(Vec3::Zero(), 0.06)),
                               .link = "finger",
                               .link_from_object = {},
                               .touch = {}});
  const double without = answered(scara_beside(kPin), question).lower;
  const double with =
      answered(scara_beside(kPin, "errors: {attached: {translation: 0.007}}\n"), question).lower;
  EXPECT_NEAR(with, without - 0.007, 1e-6);
}

}  // namespace
}  // namespace clearance
