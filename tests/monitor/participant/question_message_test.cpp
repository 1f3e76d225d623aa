// Questions and answers go over the wire and come back as they were.
#include "monitor/participant/question_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/participant/body_message.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

MotionQuestion whole_question() {
  MotionQuestion asked{.client = "planner", .request = 7, .scene_revision = 9};
  Question& question = asked.question;
  question.motion = {.joints = {"a", "b"},
                     .times = {0.0, 1.5},
                     .positions = {1, 2, 3, 4},
                     .velocities = {5, 6, 7, 8}};
  question.beside = {{.joints = {"c"}, .times = {0.5}, .positions = {9}, .velocities = {}}};
  question.held = {{"d", 0.25}};
  question.poses = {{.object = "cart", .world_from_object = test::at(1, 2, 3), .age = 0.1},
                    {.object = "base", .world_from_object = Pose(), .turn_speed = 0.5}};
  question.joints = {{.name = "e", .position = -0.5, .age = 0.02}};
  question.contacts = {{.first = "part", .second = "bin", .depth = 0.01, .until = 2.0},
                       {.first = "hand", .second = "bin", .depth = 0.02, .distance = 0.3}};
  question.moving = {{.object = "box", .times = {0.0}, .world_from_object = {test::at(4, 5, 6)}}};
  question.payloads = {{.name = "part",
                        .shape = {},
                        .link = "hand",
                        .link_from_object = test::at(0, 0, 1),
                        .touch = {"finger"}},
                       {.name = "new part",
                        .shape = std::get<ConvexBody>(box(Vec3(0.1, 0.2, 0.3))),
                        .link = "hand",
                        .link_from_object = Pose(),
                        .touch = {}}};
  question.others = OthersMove::kNot;
  question.margins = {0.0, 0.1};
  question.margins_between = {{"hand", "pin", 0.05}, {"slow", "", 0.2}};
  question.tolerance = 0.002;
  question.only_margins = true;
  question.profile =
      ProfileRequest{.first = "hand", .second = "pin", .tolerance = 0.01, .most_points = 20};
  question.time_scaling = true;
  question.stoppable = true;
  question.work_limit = 1234;
  return asked;
}

std::string path_of_fault(const MotionQuestion& asked) {
  const auto read = from_wire(*to_wire(asked));
  const auto* fault = std::get_if<MalformedField>(&read);
  return fault == nullptr ? "" : fault->path;
}

TEST(QuestionMessage, ComesBackAsItWas) {
  const MotionQuestion asked = whole_question();
  const auto read = from_wire(*to_wire(asked));
  ASSERT_TRUE(std::holds_alternative<MotionQuestion>(read))
      << std::get<MalformedField>(read).path << std::get<MalformedField>(read).reason;
  const auto& got = std::get<MotionQuestion>(read);
  EXPECT_EQ(got.client, "planner");
  EXPECT_EQ(got.request, 7u);
  EXPECT_EQ(got.scene_revision, 9u);
  const Question &a = got.question, &b = asked.question;
  EXPECT_EQ(a.motion.joints, b.motion.joints);
  EXPECT_EQ(a.motion.times, b.motion.times);
  EXPECT_EQ(a.motion.positions, b.motion.positions);
  EXPECT_EQ(a.motion.velocities, b.motion.velocities);
  ASSERT_EQ(a.beside.size(), 1u);
  EXPECT_EQ(a.beside[0].positions, b.beside[0].positions);
  ASSERT_EQ(a.held.size(), 1u);
  EXPECT_EQ(a.held[0].name, "d");
  EXPECT_EQ(a.held[0].position, 0.25);
  ASSERT_EQ(a.poses.size(), 2u);
  EXPECT_EQ(a.poses[0].world_from_object.position, Vec3(1, 2, 3));
  EXPECT_EQ(a.poses[0].age, 0.1);
  EXPECT_EQ(a.poses[0].turn_speed, kInfinity);
  EXPECT_EQ(a.poses[1].turn_speed, 0.5);
  ASSERT_EQ(a.joints.size(), 1u);
  EXPECT_EQ(a.joints[0].name, "e");
  EXPECT_EQ(a.joints[0].position, -0.5);
  EXPECT_EQ(a.joints[0].age, 0.02);
  ASSERT_TRUE(a.contacts);
  ASSERT_EQ(a.contacts->size(), 2u);
  EXPECT_EQ((*a.contacts)[0].first + (*a.contacts)[0].second, "partbin");
  EXPECT_EQ((*a.contacts)[0].depth, 0.01);
  EXPECT_EQ((*a.contacts)[0].until, 2.0);
  EXPECT_EQ((*a.contacts)[0].distance, kInfinity);
  EXPECT_EQ((*a.contacts)[1].distance, 0.3);
  ASSERT_EQ(a.moving.size(), 1u);
  EXPECT_EQ(a.moving[0].world_from_object[0].position, Vec3(4, 5, 6));
  ASSERT_EQ(a.payloads.size(), 2u);
  EXPECT_FALSE(a.payloads[0].shape);
  ASSERT_TRUE(a.payloads[1].shape);
  EXPECT_EQ(a.payloads[1].shape->vertices.size(), 8u);
  EXPECT_EQ(a.payloads[0].name + a.payloads[0].link + a.payloads[0].touch.at(0), "parthandfinger");
  EXPECT_EQ(a.others, OthersMove::kNot);
  EXPECT_EQ(a.margins, b.margins);
  ASSERT_EQ(a.margins_between.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.margins_between[i].a, b.margins_between[i].a);
    EXPECT_EQ(a.margins_between[i].b, b.margins_between[i].b);
    EXPECT_EQ(a.margins_between[i].margin, b.margins_between[i].margin);
  }
  EXPECT_EQ(a.tolerance, 0.002);
  EXPECT_TRUE(a.only_margins);
  ASSERT_TRUE(a.profile);
  EXPECT_EQ(a.profile->first + a.profile->second, "handpin");
  EXPECT_EQ(a.profile->tolerance, 0.01);
  EXPECT_EQ(a.profile->most_points, 20u);
  EXPECT_TRUE(a.stoppable);
  EXPECT_TRUE(a.time_scaling);
  EXPECT_EQ(a.work_limit, 1234u);
}

TEST(QuestionMessage, RefusesEachFieldByItsPath) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(path_of_fault(whole_question()), "");
  const auto with = [](auto change) {
    MotionQuestion asked = whole_question();
    change(asked, asked.question);
    return path_of_fault(asked);
  };
  EXPECT_EQ(with([](auto& asked, auto&) { asked.client = ""; }), "client");
  EXPECT_EQ(with([](auto& asked, auto&) { asked.client = "\xff"; }), "client");
  EXPECT_EQ(with([](auto& asked, auto&) { asked.request = 0; }), "request");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.times[1] = kNaN; }), "motion.times[1]");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.velocities[2] = 1 / 0.0; }), "motion.velocities[2]");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.joints[1] = ""; }), "motion.joints[1]");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.joints.assign(kMostMotionJoints + 1, "x"); }),
            "motion.joints");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.times.resize(kMostWaypoints + 1); }),
            "motion.times");
  EXPECT_EQ(with([](auto&, auto& q) { q.motion.positions.resize(5); }), "motion.positions");
  EXPECT_EQ(with([](auto&, auto& q) { q.beside[0].positions[0] = kNaN; }),
            "beside[0].positions[0]");
  EXPECT_EQ(with([](auto&, auto& q) { q.held[0].position = kNaN; }), "held[0].position");
  EXPECT_EQ(with([](auto&, auto& q) { q.poses[0].world_from_object.position.x() = kNaN; }),
            "poses[0].world_from_object.position");
  EXPECT_EQ(
      with([](auto&, auto& q) { q.poses[0].world_from_object.orientation.coeffs().setZero(); }),
      "poses[0].world_from_object.orientation");
  EXPECT_EQ(with([](auto&, auto& q) { q.moving[0].object = std::string(65, 'n'); }),
            "moving[0].object");
  EXPECT_EQ(with([](auto&, auto& q) { q.payloads[0].link = ""; }), "payloads[0].link");
  EXPECT_EQ(with([](auto&, auto& q) { q.poses[0].age = -1.0; }), "poses[0].age");
  EXPECT_EQ(with([](auto&, auto& q) { q.poses[1].turn_speed = kNaN; }), "poses[1].turn_speed");
  EXPECT_EQ(with([](auto&, auto& q) { q.joints[0].position = kNaN; }), "joints[0].position");
  EXPECT_EQ(with([](auto&, auto& q) { q.joints[0].age = kInfinity; }), "joints[0].age");
  EXPECT_EQ(with([](auto&, auto& q) { (*q.contacts)[0].second = ""; }), "contacts[0].second");
  EXPECT_EQ(with([](auto&, auto& q) { (*q.contacts)[0].until = kNaN; }), "contacts[0].until");
  EXPECT_EQ(with([](auto&, auto& q) { q.payloads[1].shape->radius = -1.0; }), "payloads[1].body");
  EXPECT_EQ(with([](auto&, auto& q) { q.others = static_cast<OthersMove>(7); }), "others");
  EXPECT_EQ(with([](auto&, auto& q) { q.margins[1] = kNaN; }), "margins[1]");
  EXPECT_EQ(with([](auto&, auto& q) { q.tolerance = kNaN; }), "tolerance");
  EXPECT_EQ(with([](auto&, auto& q) { q.profile->most_points = kMostProfile + 1; }), "profile");
}

// Every kind of body comes back with the same vertices, sizes and radius, to the bit.
TEST(QuestionMessage, BringsBodiesToTheBit) {
  const std::vector<Vec3> corners = {
      {0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.3}, {0.07, 0.08, 0.09}};
  const ShapeResult bodies[] = {point(Vec3(0.1, 0.2, 0.3), 0.05),
                                segment(Vec3(0, 0, 0.1), Vec3(0.3, 0, 0), 0.02),
                                box(Vec3(0.1, 0.2, 0.3)),
                                polyhedron_from_vertices(corners),
                                ellipsoid(Vec3(0.1, 0.2, 0.3)),
                                cylinder(0.1, 0.2, 0.01),
                                cone(0.1, 0.2),
                                truncated_cone(0.1, 0.3, 0.2)};
  for (const ShapeResult& made : bodies) {
    const auto& body = std::get<ConvexBody>(made);
    EXPECT_EQ(unsent_part(body), "");
    MotionQuestion asked = whole_question();
    asked.question.payloads[1].shape = body;
    const auto read = from_wire(*to_wire(asked));
    ASSERT_TRUE(std::holds_alternative<MotionQuestion>(read));
    const auto& got = std::get<MotionQuestion>(read).question.payloads[1].shape;
    ASSERT_TRUE(got);
    EXPECT_EQ(got->radius, body.radius);
    EXPECT_EQ(got->curved, body.curved);
    EXPECT_EQ(got->anchors, body.anchors);
    EXPECT_EQ(got->position_error, body.position_error);
  }
}

TEST(QuestionMessage, RefusesBodiesOfTooManyPointsAndOfUnknownKinds) {
  const auto refused = [](const auto& change) {
    Sample<clearance_msg_Question> message = to_wire(whole_question());
    clearance_msg_StatedBody& body = message->payloads._buffer[1].body;
    change(body);
    const auto read = from_wire(*message);
    const auto* fault = std::get_if<MalformedField>(&read);
    return fault != nullptr && fault->path == "payloads[1].body";
  };
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_TRUE(refused([](auto& body) { body.kind = 4; }));
  EXPECT_TRUE(refused([](auto& body) { body.points._length = 3; }));
  EXPECT_TRUE(refused([](auto& body) { body.points._buffer[2].y = 1 / 0.0; }));
  EXPECT_TRUE(refused([](auto& body) {
    dds_free(body.points._buffer);
    body.points = {};
    reserve_sequence(body.points, kMostBodyPoints + 1);
    body.points._length = kMostBodyPoints + 1;
  }));
}

TEST(QuestionMessage, OfAnAnswerComesBackAsItWas) {
  QuestionResult result{.client = "planner", .request = 7, .scene_revision = 9, .cycle = 11};
  result.now_ns = 13;
  result.lower = 0.1;
  result.upper = 0.2;
  result.time = 0.5;
  result.first = "pin";
  result.second = "hand";
  result.point_on_first = {1, 2, 3};
  result.margins = {{.margin = 0.1, .verdict = Verdict::kFree, .above_until = 2.0},
                    {.margin = 0.2, .verdict = Verdict::kFree, .a = "hand", .b = "pin"},
                    {.margin = 0.3, .verdict = Verdict::kFree, .a = "slow"}};
  result.profile = {{.from = 0.0, .to = 1.0, .lower = 0.1, .upper = 0.3, .first = "pin"}};
  result.time_limit = TimeLimit{.is_limited = true, .factor = 0.5, .zone = "slow"};
  result.within_work_limit = false;
  result.queries = 15;
  result.start_deviation = 0.25;
  result.start_joint = "a";
  const QuestionResult got = from_wire(*to_wire(result, 3));
  EXPECT_EQ(got.cycle, 11u);
  EXPECT_EQ(got.now_ns, 13);
  EXPECT_EQ(got.lower, 0.1);
  EXPECT_EQ(got.upper, 0.2);
  EXPECT_EQ(got.first + got.second, "pinhand");
  EXPECT_EQ(got.point_on_first, Vec3(1, 2, 3));
  EXPECT_TRUE(std::isnan(got.point_on_second.x()));
  EXPECT_TRUE(got.is_free(0.1));
  EXPECT_FALSE(got.is_free(0.2)) << "that one is of two objects only";
  EXPECT_TRUE(got.is_free(0.2, "hand", "pin"));
  EXPECT_FALSE(got.is_free(0.1, "hand", "pin"));
  EXPECT_TRUE(got.is_free(0.3, "slow"));
  ASSERT_EQ(got.profile.size(), 1u);
  EXPECT_EQ(got.profile[0].upper, 0.3);
  ASSERT_TRUE(got.time_limit);
  EXPECT_EQ(got.time_limit->factor, 0.5);
  EXPECT_EQ(got.time_limit->zone, "slow");
  EXPECT_FALSE(got.within_work_limit);
  EXPECT_EQ(got.queries, 15u);
  EXPECT_EQ(got.start_deviation, 0.25);
  EXPECT_EQ(got.start_joint, "a");
}

// A refusal says nothing about the motion, whatever else stands in it.
TEST(QuestionMessage, OfARefusalIsNeverFree) {
  QuestionResult result{.client = "planner", .request = 7, .status = QuestionStatus::kNoInput};
  result.margins = {{.margin = 0.1, .verdict = Verdict::kFree}};
  const QuestionResult got = from_wire(*to_wire(result, 3));
  EXPECT_FALSE(got.is_free(0.1));
  EXPECT_EQ(got.lower, -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(got.time_limit);
  Sample<clearance_msg_Answer> message = to_wire(result, 3);
  message->status = 0;
  message->margins._buffer[0].verdict = 77;
  EXPECT_FALSE(from_wire(*message).is_free(0.1));
}

}  // namespace
}  // namespace clearance
