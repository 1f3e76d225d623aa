// A payload of a question is what a cell knows as an attached object. Oracle: the same object,
// attached by a command or by the text of the cell, whose reader makes its pairs, zones and errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "config/edit/cell_editor.hpp"
#include "config/scene/stated_errors.hpp"
#include "core/shapes.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/ask/payloads.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using Result = std::variant<Answer, std::string>;

const std::string kUrdf = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.05 0.05"/></geometry></collision></link>
  <link name="palm"><collision><geometry><sphere radius="0.04"/></geometry></collision></link>
  <joint name="j1" type="revolute"><origin xyz="0 0 0.5"/><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2"/></joint>
  <joint name="bolt" type="fixed"><origin xyz="1 0 0"/><parent link="hand"/><child link="palm"/></joint>
</robot>
)";

const std::string kZone =
    "separation: {human: people, robot_speed: 2, reaction_time_ms: 60, stopping_time_ms: 100, "
    "stopping_distance: 0.1, intrusion_distance: 0}";

// With 33 % of the load the arm brakes within 6 deg, with more within 50 deg.
const std::string kStops =
    ", stopping: {reaction_ms: 20, category: 1, load: {full: 6, tool: 0.5}, table: ["
    "{joint: j1, category: 1, load_percent: 33, speed_percent: 100, time_ms: 100, angle_deg: 6}, "
    "{joint: j1, category: 1, load_percent: 110, speed_percent: 100, time_ms: 800, angle_deg: "
    "50}]}";

struct DrawnCell {
  std::string part = "mass: 1";  // more keys of the part
  std::string stops = kStops;
  std::string exceptions, errors;
  std::string rules;  // beside those of the arm

  // `box`: an entry of the list of objects.
  [[nodiscard]] std::string text(const std::string& box = "") const {
    return "name: test\nunits: {length: m, angle: rad}\nrobots:\n  - {name: arm, urdf: arm.urdf" +
           stops +
           "}\nobjects:\n"
           "  - {name: post, groups: [things], fixed: true, pose: {xyz: [0.3, 1.5, 0.5]}, "
           "box: {size: [0.1, 0.1, 0.1]}}\n"
           "  - {name: rod, groups: [things], fixed: true, pose: {xyz: [1.5, -0.6, 0.5]}, "
           "box: {size: [0.1, 0.1, 2]}}\n"
           "  - {name: worker, groups: [people], max_speed: 1.6, sphere: {radius: 0.2}}\n"
           "  - {name: part, max_speed: 1, sphere: {radius: 0.05}, " +
           part + "}\n" + box +
           "pairs:\n  - {between: [arm, things]}\n  - {between: [arm, arm]}\n"
           "  - {between: [arm, people]}\n  - {between: [arm, part], may_be_empty: true}\n" +
           rules + (exceptions.empty() ? "" : "allowed_collisions:\n" + exceptions) +
           "zones:\n  - {name: stop, between: [arm, things], enter_below: 0.5, leave_above: 0.6}\n"
           "  - {name: reach, between: [hand, rod], may_be_empty: true, enter_below: 0.1, "
           "leave_above: 0.2}\n"
           "  - {name: ppl, between: [arm, people], enter_below: 0.05, leave_above: 0.07, " +
           kZone + "}\n" + (errors.empty() ? "" : "errors: {" + errors + "}\n");
  }
};

// What the scene watches, and in which zones, by names; with the errors of both.
std::set<std::string> watched(const Scene& scene) {
  const StatedErrors errors(scene);
  std::set<std::string> names;
  const auto note = [&](const std::string& where, std::uint32_t p) {
    const ObjectPair& pair = scene.pairs[p];
    const std::string &a = scene.objects[pair.first].name, &b = scene.objects[pair.second].name;
    names.insert(where + std::min(a, b) + " " + std::max(a, b) + " " +
                 std::to_string(errors.largest(pair.first, pair.second)));
  };
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) note("", p);
  for (const Zone& zone : scene.zones)
    for (const std::uint32_t p : zone.pairs) note(zone.name + ": ", p);
  return names;
}

class AttachedPayloads : public testing::Test {
 protected:
  AttachedPayloads() { test::write_text(folder_ / "arm.urdf", kUrdf); }

  [[nodiscard]] Scene scene(const std::string& text) const {
    return scene_of(text, folder_ / "cell.yaml");
  }
  // The answer after a command has attached the object, or why there is none.
  [[nodiscard]] Result attached(const std::string& text, const Payload& payload,
                                const Question& question) const {
    auto opened = CellEditor::open(text, folder_ / "cell.yaml");
    if (!std::holds_alternative<CellEditor>(opened)) return "no valid cell";
    const auto edited = std::get<CellEditor>(opened).edit(
        std::vector<CellChange>{Attach{.object = payload.name,
                                       .to = payload.link,
                                       .carrier_from_object = payload.link_from_object,
                                       .touch = payload.touch}});
    if (const auto* refusal = std::get_if<EditRefusal>(&edited)) return refusal->reason;
    const Scene& scene = std::get<Cell>(edited).scene;
    const auto loaded = scene_with(this->scene(text), std::vector{payload});
    if (const auto* carrying = std::get_if<Scene>(&loaded)) {
      EXPECT_EQ(watched(*carrying), watched(scene)) << text;
    }
    return ask(scene, question);
  }
  [[nodiscard]] Result carried(const std::string& text, const Payload& payload,
                               Question question) const {
    question.payloads = {payload};
    return ask(scene(text), question);
  }
  [[nodiscard]] Answer answer_of(const Result& result) const {
    if (const auto* text = std::get_if<std::string>(&result)) {
      ADD_FAILURE() << *text;
      return {};
    }
    return std::get<Answer>(result);
  }

  test::ScratchFolder folder_;
};

// The palm carries it, and it reaches beyond.
Payload part_at(double x) {
  return {.name = "part",
          .shape = {},
          .link = "palm",
          .link_from_object = {.position = {x, 0.0, 0.0}},
          .touch = {}};
}

Payload box_at(double x) {
  Payload payload = part_at(x);
  payload.name = "box";
  payload.shape = std::get<ConvexBody>(point(Vec3::Zero(), 0.05));
  return payload;
}

Question turn(double from, double to, double worker = 9.0) {
  Question question;
  question.motion = {
      .joints = {"j1"}, .times = {0.0, 1.0}, .positions = {from, to}, .velocities = {}};
  question.poses = {{.object = "worker", .world_from_object = {.position = {-worker, 0.0, 0.5}}}};
  question.others = OthersMove::kNot;
  question.tolerance = 1e-6;
  return question;
}

// A part that no link carries is far away.
Question with_part(Question question) {
  question.poses.push_back({.object = "part", .world_from_object = {.position = {0, 0, 30.0}}});
  return question;
}

// The searches end where `lower` is good enough, which stated errors keep away from `upper`.
void expect_same(const Result& payload, const Result& attached, const std::string& cell) {
  ASSERT_EQ(payload.index(), attached.index())
      << cell << (payload.index() != 0 ? std::get<1>(payload) : std::get<1>(attached));
  if (payload.index() != 0) return;
  const Answer &a = std::get<Answer>(payload), &b = std::get<Answer>(attached);
  EXPECT_NEAR(a.lower, b.lower, 3e-6) << cell;
  if (cell.find("errors:") == std::string::npos) {
    EXPECT_NEAR(a.upper, b.upper, 3e-6) << cell;
  }
  EXPECT_LE(a.lower, b.upper) << cell;
  EXPECT_LE(b.lower, a.upper) << cell;
  ASSERT_EQ(a.margins.size(), b.margins.size());
  for (std::size_t i = 0; i < a.margins.size(); ++i)
    EXPECT_EQ(a.margins[i].verdict, b.margins[i].verdict) << i << " of " << cell;
  EXPECT_LE(a.scaling.factor, b.scaling.factor_above) << cell;
  EXPECT_LE(b.scaling.factor, a.scaling.factor_above) << cell;
}

DrawnCell drawn_cell(Random& random) {
  DrawnCell cell;
  if (random.chance(0.3)) cell.stops.clear();
  cell.part =
      random.chance(0.3) ? "absent: false" : "mass: " + std::to_string(random.uniform(0.1, 7.5));
  if (random.chance(0.4)) cell.rules += "  - {between: [part, things], may_be_empty: true}\n";
  for (const char* between :
       {"hand, post", "palm, rod", "part, post", "arm, rod", "part, things"}) {
    if (random.chance(0.2))
      cell.exceptions +=
          "  - {between: [" + std::string(between) + "], may_be_empty: true, reason: drawn}\n";
  }
  if (random.chance(0.7)) {
    const auto length = [&] { return std::to_string(random.uniform(0.0, 0.05)); };
    cell.errors = "attached: {translation: " + length() + "}, poses: {translation: " + length() +
                  "}, shapes: " + length();
    if (random.chance(0.5))
      cell.errors +=
          ", except: [{object: part, translation: " + length() + ", shape: " + length() + "}]";
  }
  return cell;
}

Question drawn_question(Random& random, const DrawnCell& cell) {
  Question question =
      turn(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(1.3, 4.0));
  question.margins = {random.uniform(0.0, 0.6)};
  for (const auto& [a, b] : {std::pair("stop", ""), std::pair("arm", "things"),
                             std::pair("arm", "people"), std::pair("ppl", "")})
    question.margins_between.push_back({a, b, random.uniform(0.0, 0.6)});
  question.stoppable = !cell.stops.empty() && random.chance(0.5);
  question.time_scaling = random.chance(0.5);
  return question;
}

TEST_F(AttachedPayloads, HaveTheAnswerOfTheSameObjectAttachedByACommand) {
  Random random(83);
  int answers = 0, refusals = 0;
  for (std::uint64_t i = 0; i < repeats(400); ++i) {
    const DrawnCell cell = drawn_cell(random);
    const Question question = drawn_question(random, cell);
    Payload payload = part_at(random.uniform(0.05, 0.6));
    payload.link_from_object.position.y() = random.uniform(-0.3, 0.3);
    if (random.chance(0.3)) payload.link = "hand";
    if (random.chance(0.2)) payload.touch = {random.chance(0.5) ? "things" : "rod"};
    if (random.chance(0.1)) payload.touch = {"people"};
    if (random.chance(0.1)) payload.touch = {"nobody"};
    const Result carried_by_question = carried(cell.text(), payload, question);
    expect_same(carried_by_question, attached(cell.text(), payload, question), cell.text());
    (carried_by_question.index() == 0 ? answers : refusals)++;
    if (HasFailure()) return;
  }
  EXPECT_GT(answers, refusals);
  EXPECT_GT(refusals, 0);
}

TEST_F(AttachedPayloads, OfNewObjectsHaveTheAnswerOfACellThatAttachesThem) {
  Random random(84);
  for (std::uint64_t i = 0; i < repeats(400); ++i) {
    DrawnCell cell = drawn_cell(random);
    const Question question = with_part(drawn_question(random, cell));
    const double x = random.uniform(0.05, 0.6);
    const std::string entry = "  - {name: box, attached: {to: palm, pose: {xyz: [" +
                              std::to_string(x) + ", 0, 0]}}, sphere: {radius: 0.05}}\n";
    const Payload payload = box_at(std::stod(std::to_string(x)));
    expect_same(carried(cell.text(), payload, question), ask(scene(cell.text(entry)), question),
                cell.text());
    if (HasFailure()) return;
  }
}

TEST_F(AttachedPayloads, CountInTheZonesAndGroupsOfTheirLink) {
  Question question = with_part(turn(1.3, 1.31));
  question.margins_between = {{"stop", "", 0.4}, {"arm", "things", 0.4}};
  const Answer without = answer_of(ask(scene(DrawnCell().text()), question));
  EXPECT_EQ(without.margins.at(1).verdict, Verdict::kFree);
  question.payloads = {box_at(0.4)};
  const Answer answer = answer_of(ask(scene(DrawnCell().text()), question));
  EXPECT_EQ(answer.margins.at(1).verdict, Verdict::kBelow);
  EXPECT_EQ(answer.margins.at(2).verdict, Verdict::kBelow);
}

TEST_F(AttachedPayloads, MayNotTouchWhatOnlyTheirLinkMayTouch) {
  DrawnCell cell;
  cell.exceptions =
      "  - {between: [palm, post], reason: the palm presses on it}\n"
      "  - {between: [hand, post], reason: so does the hand}\n";
  const Answer answer = answer_of(carried(cell.text(), box_at(0.4), with_part(turn(1.37, 1.38))));
  EXPECT_LT(answer.lower, 0.1);
}

TEST_F(AttachedPayloads, HaveTheErrorThatTheCellExceptsForThem) {
  DrawnCell cell;
  cell.errors = "attached: {translation: 0.001}, poses: {translation: 0.002}";
  const Question question = turn(0.0, 0.001);
  const double usual = answer_of(carried(cell.text(), part_at(0.3), question)).lower;
  cell.errors += ", except: [{object: part, translation: 0.05}]";
  EXPECT_NEAR(answer_of(carried(cell.text(), part_at(0.3), question)).lower, usual - 0.049, 3e-6);
}

// From 2 rad/s the arm goes on by 50 deg instead of 6 deg.
TEST_F(AttachedPayloads, AreLoadsOfStopsAndOneWithoutMassIsTheWorst) {
  Question question = turn(0.0, 0.5);
  question.motion.times = {0.0, 0.25};
  question.stoppable = true;
  DrawnCell cell;
  const auto lower = [&] { return answer_of(carried(cell.text(), part_at(0.4), question)).lower; };
  EXPECT_GT(lower(), 0.3) << "1 kg";
  cell.part = "mass: 6";
  EXPECT_LT(lower(), 0.1);
  cell.part = "absent: false";
  EXPECT_LT(lower(), 0.1) << "not stated";
  cell.part = "mass: 9";
  EXPECT_NE(std::get<std::string>(carried(cell.text(), part_at(0.4), question)).find("9.5 kg"),
            std::string::npos);
}

TEST_F(AttachedPayloads, AreNoPeopleAndNoSensors) {
  Payload person = part_at(0.3);
  person.name = "worker";
  Question question = turn(0.0, 0.1);
  question.poses.front().object = "part";
  EXPECT_NE(std::get<std::string>(carried(DrawnCell().text(), person, question))
                .find("'worker' on both sides of the zone"),
            std::string::npos);
  DrawnCell cell;
  cell.rules = "  - {between: [arm, camera]}\n";
  const std::string sensors =
      "sensors:\n  - {name: camera, depth_image: /cam, depth_error: {constant: 0.001}, range: "
      "[0.3, 5], age_limit_ms: 200, max_speed: 1.5, mount: {pose: {xyz: [1, 2, 2]}}}\n";
  Payload camera = part_at(0.3);
  camera.name = "camera";
  EXPECT_NE(std::get<std::string>(carried(cell.text() + sensors, camera, with_part(turn(0.0, 0.1))))
                .find("payload \"camera\" is a sensor"),
            std::string::npos);
}

}  // namespace
}  // namespace clearance
