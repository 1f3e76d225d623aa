// Contacts that the scene allows. Oracle: the closed form of two spheres, whose distance is that of
// their centres less 0.15 m: the finger circles at 2 m, the post is 2.1 m from the axis.
#include <algorithm>
#include <cmath>

#include "core/shapes.hpp"
#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::answered, test::scara_beside, test::swing;

constexpr const char* kNearPin = "fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.1, 0, 0]}";

Scene scene_with(const std::string& depth_and_end) {
  return scara_beside(kNearPin,
                      "contacts: [{name: touch, between: [post, finger], by: test, reason: it is "
                      "meant, depth: " +
                          depth_and_end + "}]\n");
}

// The shoulder's angle at which the finger is this far from the post, m.
double angle_at(double distance) {
  const double centres = distance + 0.15;
  return std::acos((2.1 * 2.1 + 2.0 * 2.0 - centres * centres) / (2.0 * 2.1 * 2.0));
}

constexpr double kNear = 1e-6;

TEST(MeantContacts, KeepEveryMarginDownToTheirDepth) {
  Question question = swing(-1.0, 0.6);
  question.margins = {0.0, 0.02};
  const Answer allowed = answered(scene_with("0.051"), question);
  EXPECT_EQ(allowed.margins[0].verdict, Verdict::kFree);
  EXPECT_EQ(allowed.margins[1].verdict, Verdict::kFree);
  EXPECT_EQ(allowed.upper, 0.0) << "the distance counts the pair as others";
  EXPECT_EQ(allowed.lower, 0.0);
  const Answer deep = answered(scene_with("0.04"), question);
  const double truth = (1.0 - angle_at(-0.04)) / 0.8;
  for (const MarginAnswer& margin : deep.margins) {
    ASSERT_EQ(margin.verdict, Verdict::kBelow);
    EXPECT_NEAR(margin.below_at, truth, kNear);
    EXPECT_GE(margin.below_at, truth - 1e-12);
    EXPECT_LE(margin.above_until, truth + 1e-12);
    EXPECT_GE(margin.above_until, truth - kNear);
  }
}

TEST(MeantContacts, OfOnePairAllowNoOther) {
  Question question = swing(-1.0, 0.6);
  const Scene scene = scara_beside(
      kNearPin,
      "contacts: [{name: touch, between: [post, lower], by: test, reason: it is meant, "
      "depth: 0.5}]\n");
  const Answer answer = answered(scene, question);
  ASSERT_EQ(answer.margins[0].verdict, Verdict::kBelow);
  EXPECT_EQ(scene.objects[answer.margins[0].second].name, "finger");
}

// Contact begins before 1 s, and lasts beyond it.
TEST(MeantContacts, EndByTime) {
  Question question = swing(-1.0, 0.6);
  const double begins = (1.0 - angle_at(0.0)) / 0.8, ends = (1.0 + angle_at(0.0)) / 0.8;
  ASSERT_TRUE(begins < 1.2 && ends > 1.2);
  const Answer early = answered(scene_with("0.1, until: {duration_ms: 1200}"), question);
  ASSERT_EQ(early.margins[0].verdict, Verdict::kBelow);
  EXPECT_NEAR(early.margins[0].below_at, 1.2, kNear);
  EXPECT_GE(early.margins[0].below_at, 1.2);
  EXPECT_LE(early.margins[0].above_until, 1.2);
  const Answer late = answered(scene_with("0.1, until: {duration_ms: 1500}"), question);
  EXPECT_EQ(late.margins[0].verdict, Verdict::kFree);
  // The clock of the waypoints is no other one.
  for (const char* end : {"0.1, until: {time_ns: 9000000000000000000}", "0.1, until: {cycle: 9}"}) {
    const Answer answer = answered(scene_with(end), question);
    ASSERT_EQ(answer.margins[0].verdict, Verdict::kBelow) << end;
    EXPECT_NEAR(answer.margins[0].below_at, begins, kNear) << end;
  }
}

TEST(MeantContacts, EndWhenTheObjectsHaveBeenFarApart) {
  const Scene scene = scene_with("0.1, until: {distance: 0.02}");
  // The finger begins in contact and leaves.
  Question question = swing(0.0, 0.6);
  question.margins = {0.0, 0.019, 0.05};
  const Answer leaves = answered(scene, question);
  EXPECT_EQ(leaves.margins[0].verdict, Verdict::kFree);
  EXPECT_EQ(leaves.margins[1].verdict, Verdict::kFree);
  ASSERT_EQ(leaves.margins[2].verdict, Verdict::kBelow) << "then it is nearer than the margin";
  const double end = angle_at(0.02) / 0.3;
  EXPECT_NEAR(leaves.margins[2].below_at, end, kNear);
  // The finger comes back.
  question.motion.times = {0.0, 1.0, 2.0};
  question.motion.positions = {0.0, 0.3, 0.0};
  question.margins = {0.0};
  const Answer returns = answered(scene, question);
  ASSERT_EQ(returns.margins[0].verdict, Verdict::kBelow);
  EXPECT_NEAR(returns.margins[0].below_at, 2.0 - angle_at(0.0) / 0.3, kNear);
  question.motion.positions = {0.0, 0.9 * angle_at(0.02), 0.0};
  EXPECT_EQ(answered(scene, question).margins[0].verdict, Verdict::kFree) << "not so far";
  // The finger begins far away.
  EXPECT_EQ(answered(scene, swing(-1.0, 0.6)).margins[0].verdict, Verdict::kBelow);
}

TEST(MeantContacts, OfTheQuestionTakeThePlaceOfThoseOfTheScene) {
  const Scene scene = scene_with("0.1");
  Question question = swing(-1.0, 0.6);
  question.contacts.emplace();
  EXPECT_EQ(answered(scene, question).margins[0].verdict, Verdict::kBelow) << "all have ended";
  question.contacts->push_back({.first = "finger", .second = "post", .depth = 0.051});
  EXPECT_EQ(answered(scene, question).margins[0].verdict, Verdict::kFree);
  question.contacts->front().second = "nothing";
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question.contacts->front() = {.first = "finger", .second = "post", .depth = 0.0};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question.contacts = {{{.first = "finger", .second = "post", .depth = 0.051},
                        {.first = "post", .second = "finger", .depth = 0.001}}};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question))) << "two of one pair";
}

// What a cell refuses of a contact, a question refuses by the same sentence.
TEST(MeantContacts, AreNoneWithPeople) {
  const char* zone =
      "zones:\n  - {name: people, between: [post, finger], enter_below: 0.01, leave_above: 0.02, "
      "separation: {human: post, human_speed: 0.1, reaction_time_ms: 500, stopping_time_ms: 500, "
      "stopping_distance: 0.1, intrusion_distance: 0}}\n";
  const Scene scene = scara_beside(kNearPin, zone);
  const auto fault = [&](const Question& question) {
    const auto answer = ask(scene, question);
    const auto* text = std::get_if<std::string>(&answer);
    return text == nullptr ? "" : *text;
  };
  const std::string why = "in the zone 'people' with separation";
  Question question = swing(-1.0, 0.6);
  question.contacts = {{{.first = "finger", .second = "post", .depth = 0.1}}};
  EXPECT_NE(fault(question).find(why), std::string::npos) << fault(question);
  question.contacts = {{{.first = "lower", .second = "post", .depth = 0.1}}};
  EXPECT_EQ(fault(question), "") << "the zone has no such pair";
  question.contacts.reset();
  question.payloads = {{.name = "ball",
                        .shape = std::get<ConvexBody>(point(Vec3::Zero(), 0.02)),
                        .link = "finger",
                        .link_from_object = {},
                        .touch = {"post"}}};
  EXPECT_NE(fault(question).find(why), std::string::npos) << fault(question);
  question.payloads[0].link = "upper";
  EXPECT_EQ(fault(question), "");
}

// Each of these takes another path through the search.
TEST(MeantContacts, CountInVerdictsAloneAndBesidePayloads) {
  const Scene allowed = scene_with("0.051"), deep = scene_with("0.04");
  Question question = swing(-1.0, 0.6);
  question.margins = {0.02};
  const auto expect = [&](const char* of) {
    EXPECT_EQ(answered(allowed, question).margins[0].verdict, Verdict::kFree) << of;
    EXPECT_EQ(answered(allowed, question).lower, 0.0) << of;
    EXPECT_EQ(answered(deep, question).margins[0].verdict, Verdict::kBelow) << of;
  };
  question.only_margins = true;
  expect("margins");
  question.only_verdicts = true;
  expect("verdicts");
  question.only_margins = false;
  expect("verdicts and bounds");
  question.payloads = {{.name = "ball",
                        .shape = std::get<ConvexBody>(point(Vec3::Zero(), 0.02)),
                        .link = "upper",
                        .link_from_object = {},
                        .touch = {"post", "foot", "lower"}}};
  expect("payloads");
}

TEST(MeantContacts, NoSampledPostureIsDeeperThanAFreeMotionAdmits) {
  for (int i = 0; i < 60; ++i) {
    const double from = -0.2 + 0.01 * i, to = 0.2 - 0.0057 * i;
    const double depth = 0.001 + 0.0008 * i;
    Question question = swing(from, to);
    question.margins = {0.0};
    const Answer answer = answered(scene_with(std::to_string(depth)), question);
    double least = 1.0;
    for (int k = 0; k <= 2000; ++k) {
      const double angle = from + (to - from) * k / 2000.0;
      least =
          std::min(least, std::hypot(2.1 - 2.0 * std::cos(angle), 2.0 * std::sin(angle)) - 0.15);
    }
    const bool is_deep = least < -std::stod(std::to_string(depth)) - 1e-9;
    if (is_deep) {
      EXPECT_EQ(answer.margins[0].verdict, Verdict::kBelow) << i;
    }
    if (answer.margins[0].verdict == Verdict::kBelow) {
      const double angle = from + (to - from) * answer.margins[0].below_at / 2.0;
      const double there = std::hypot(2.1 - 2.0 * std::cos(angle), 2.0 * std::sin(angle)) - 0.15;
      EXPECT_LT(there, -std::stod(std::to_string(depth)) + 1e-12) << i;
    }
  }
}

}  // namespace
}  // namespace clearance
