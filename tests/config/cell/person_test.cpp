// Persons as robots of a cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "config/urdf/person.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string person_cell(const std::string& robot, const std::string& ros = "world_frame: map") {
  return "name: test\nunits: {length: mm, angle: deg}\nros2: {" + ros + "}\nrobots:\n  - " + robot +
         "\nobjects:\n  - {name: post, max_speed: 1000, sphere: {radius: 100}}\n"
         "pairs:\n  - {between: [people, post]}\n"
         "zones:\n  - {name: near, between: [people, post], enter_below: 100, leave_above: 100,\n"
         "     separation: {human: people, reaction_time_ms: 100, stopping_time_ms: 200, "
         "stopping_distance: 100, intrusion_distance: 0}}\n";
}

const std::string kAnna = "{name: anna, person: {stature: 1700, error: 60}, groups: [people]}";

const Object& limb(const Scene& scene, const std::string& name) {
  return *std::ranges::find(scene.objects, name, &Object::name);
}

TEST(Person, HasTwelveLimbsWithItsErrorThatGroupsNameAndABaseOnTheFrameOfItsBody) {
  const Scene scene = scene_of(person_cell(kAnna));
  std::vector<std::string> names;
  for (const Object& object : scene.objects) {
    if (object.name == "post") continue;
    names.push_back(object.name);
    EXPECT_EQ(object.shape_error, 0.06);
    EXPECT_THAT(object.groups, testing::ElementsAre("anna", "people"));
  }
  EXPECT_THAT(names, UnorderedElementsAre("body_anna", "waist_anna", "torso_anna", "p_head_anna",
                                          "l_shoulder_anna", "r_shoulder_anna", "l_elbow_anna",
                                          "r_elbow_anna", "l_hip_anna", "r_hip_anna", "l_knee_anna",
                                          "r_knee_anna"));
  EXPECT_EQ(scene.robots[0].base.frame, "body_anna");
  EXPECT_EQ(scene.robots[0].person->id, "anna");
  EXPECT_THAT(scene.robots[0].notes, testing::IsEmpty()) << "a person has no SRDF";
}

// Without `separation`, too.
TEST(Person, MayBeInNoContactWithWhatMoves) {
  const auto text = [](const std::string& post, const std::string& end) {
    return "name: test\nunits: {length: m, angle: deg}\nros2: {world_frame: map}\nrobots:\n"
           "  - {name: anna, person: {stature: 1.7, error: 0.06}, groups: [people]}\n"
           "  - {name: bert, person: {stature: 1.7, error: 0.06}, groups: [people]}\n"
           "objects:\n  - {name: post, " +
           post +
           ", sphere: {radius: 0.1}}\n"
           "pairs:\n  - {between: [people, post]}\n  - {between: [anna, bert]}\n" +
           end;
  };
  const auto contact = [](const std::string& a, const std::string& b) {
    return "contacts: [{name: c, between: [" + a + ", " + b +
           "], depth: 0.05, by: me, reason: test}]\n";
  };
  const auto left_out = [](const std::string& a, const std::string& b) {
    return "allowed_collisions: [{between: [" + a + ", " + b + "], reason: test}]\n";
  };
  for (const auto& meant : {+contact, +left_out}) {
    EXPECT_THAT(errors_of(text("max_speed: 1", meant("l_elbow_anna", "post"))),
                HasSubstr("'l_elbow_anna' against 'post'"));
    EXPECT_EQ(errors_of(text("fixed: true", meant("l_elbow_anna", "post"))), "");
    EXPECT_EQ(errors_of(text("max_speed: 1", meant("l_elbow_anna", "l_elbow_bert"))), "");
  }
}

// A scene of MoveIt, which a program wrote, is no statement about people.
TEST(Person, StaysWatchedAgainstWhatMovesWhateverAMatrixAllows) {
  const test::ScratchFolder folder;
  test::write_text(
      folder / "s.yaml",
      "name: s\nallowed_collision_matrix: {entry_names: [p_head_anna, tool, post], "
      "entry_values: [{enabled: [true, true, true]}, {enabled: [true, true, true]}, "
      "{enabled: [true, true, true]}]}\nworld: {collision_objects: [{header: {frame_id: "
      "map}, id: post, primitives: [{type: 2, dimensions: [0.1]}]}]}\n");
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: deg}\nros2: {world_frame: map}\n"
      "scenes: [{file: s.yaml, group: things}]\n"
      "robots:\n  - {name: anna, person: {stature: 1.7, error: 0.06}, groups: [people]}\n"
      "objects:\n  - {name: tool, groups: [things], max_speed: 1, sphere: {radius: 0.1}}\n"
      "pairs:\n  - {between: [people, things]}\n",
      folder / "cell.yaml");
  const auto is_watched = [&](const std::string& with) {
    return std::ranges::any_of(scene.pairs, [&](const ObjectPair& pair) {
      const std::string &a = scene.objects[pair.first].name, &b = scene.objects[pair.second].name;
      return (a == "p_head_anna" && b == with) || (b == "p_head_anna" && a == with);
    });
  };
  EXPECT_TRUE(is_watched("tool"));
  EXPECT_FALSE(is_watched("post")) << "that is fixed, and the matrix allows it";
}

// Drillis and Contini: the upper arm has 0.186 of the stature, the shank 0.246.
TEST(Person, HasLimbsOfItsStature) {
  for (const double stature : {1.3, 1.75, 2.1}) {
    const Scene scene =
        scene_of(person_cell("{name: anna, person: {stature: " + std::to_string(1000.0 * stature) +
                             ", error: 0}, groups: [people]}"));
    const auto span = [&](const std::string& name) {
      const auto& anchors = limb(scene, name).parts[0].shape.anchors;
      return (anchors.front() - anchors.back()).norm();
    };
    EXPECT_NEAR(span("l_shoulder_anna"), 0.186 * stature, 1e-9);
    EXPECT_NEAR(span("r_knee_anna"), 0.246 * stature, 1e-9);
    // Girths are those of a person of mean stature at least.
    EXPECT_NEAR(limb(scene, "l_hip_anna").parts[0].shape.radius,
                0.135 * std::max(1.0, stature / 1.756), 1e-9);
  }
}

TEST(Person, ApproachesWithTheSpeedOfItsLimbsUnlessTheZoneStatesOne) {
  const Scene scene = scene_of(person_cell(kAnna));
  EXPECT_FALSE(scene.zones[0].separation->human_speed);
  for (const Object& object : scene.objects) {
    const bool is_arm = object.name.find("shoulder") != std::string::npos ||
                        object.name.find("elbow") != std::string::npos;
    EXPECT_EQ(object.approach_speed, is_arm ? 2.0 : 1.6) << object.name;
  }
}

TEST(Person, HoldsWhatApproachesAsTheLimbThatHoldsItDoes) {
  const auto speed = [](const std::string& carrier) {
    std::string text = person_cell(kAnna);
    text.insert(text.find("pairs:"),
                "  - {name: ball, attached: {to: " + carrier + "}, sphere: {radius: 100}}\n");
    return limb(scene_of(text), "ball").approach_speed;
  };
  EXPECT_EQ(speed("r_elbow_anna"), 2.0);
  EXPECT_EQ(speed("torso_anna"), 1.6);
}

// A tracker's id is in the names that its messages have, and in no name that the cell's rules use.
TEST(Person, HasTheIdInItsJointsAndItsFrameButNotInItsLinks) {
  const Scene scene = scene_of(
      person_cell("{name: anna, person: {stature: 1700, error: 60, id: b7}, groups: [people]}"));
  EXPECT_EQ(scene.robots[0].base.frame, "body_b7");
  EXPECT_EQ(limb(scene, "l_elbow_anna").name, "l_elbow_anna");
  EXPECT_NE(std::ranges::find(scene.variables, "l_elbow_b7", &JointVariable::name),
            scene.variables.end());
  for (const JointVariable& variable : scene.variables)
    EXPECT_FALSE(variable.name == "l_elbow_anna");
}

// The lengths of a tracker's URDF count, and its placeholders of limits do not.
TEST(Person, HasTheLengthsOfTheTrackersSkeleton) {
  const test::ScratchFolder folder;
  const auto urdf = [](const std::string& without) {
    const UrdfRobot skeleton = skeleton_of(1.7);
    std::string text = "<robot name=\"human\">\n";
    for (const UrdfLink& link : skeleton.links)
      if (link.name != without) text += "<link name=\"" + link.name + "_x1\"/>\n";
    for (const UrdfJoint& joint : skeleton.joints) {
      if (joint.child == without) continue;
      const Vec3 at = (joint.child == "r_elbow" ? 2.0 : 1.0) * joint.parent_from_child.xyz;
      const Vec3 axis = joint.axis.value_or(Vec3::UnitX());
      const auto triple = [](const Vec3& v) {
        return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
      };
      text +=
          "<joint name=\"" + joint.name + "_x1\" type=\"" + (joint.axis ? "revolute" : "fixed") +
          "\"><origin xyz=\"" + triple(at) + "\"/><parent link=\"" + joint.parent +
          "_x1\"/><child link=\"" + joint.child + "_x1\"/>" +
          (joint.axis ? "<axis xyz=\"" + triple(axis) +
                            "\"/><limit lower=\"-1\" upper=\"1\" velocity=\"0.5\" effort=\"1\"/>"
                      : "") +
          "</joint>\n";
    }
    return text + "</robot>\n";
  };
  const std::string robot =
      "{name: anna, urdf: human.urdf, person: {stature: 1700, error: 60}, groups: [people]}";
  test::write_text(folder / "human.urdf", urdf(""));
  const Scene scene = scene_of(person_cell(robot), folder / "cell.yaml");
  const auto& anchors = limb(scene, "r_shoulder_anna").parts[0].shape.anchors;
  EXPECT_NEAR((anchors.front() - anchors.back()).norm(), 2.0 * 0.186 * 1.7, 1e-5);
  for (const JointVariable& variable : scene.variables) {
    EXPECT_EQ(variable.max_speed, kInfinity) << variable.name;
    EXPECT_EQ(variable.upper, kInfinity) << variable.name;
  }
  std::string collar = urdf("");
  const std::string shoulder = "<parent link=\"torso_x1\"/><child link=\"l_y_shoulder_x1\"/>";
  ASSERT_NE(collar.find(shoulder), std::string::npos);
  collar.replace(collar.find(shoulder), shoulder.size(),
                 "<parent link=\"l_collar_x1\"/><child link=\"l_y_shoulder_x1\"/>");
  collar.insert(collar.find("</robot>"),
                "<link name=\"l_collar_x1\"/><joint name=\"l_collar_x1\" type=\"fixed\">"
                "<parent link=\"torso_x1\"/><child link=\"l_collar_x1\"/></joint>");
  test::write_text(folder / "human.urdf", collar);
  EXPECT_THAT(errors_of(person_cell(robot), folder / "cell.yaml"),
              HasSubstr("'torso' carries 'l_y_shoulder'"));
  test::write_text(folder / "human.urdf", urdf("l_wrist"));
  EXPECT_THAT(errors_of(person_cell(robot), folder / "cell.yaml"), HasSubstr("'l_wrist'"));
  test::write_text(folder / "human.urdf", "<robot name=\"arm\"><link name=\"base\"/></robot>");
  EXPECT_THAT(errors_of(person_cell(robot), folder / "cell.yaml"), HasSubstr("'body_ID'"));
}

TEST(Person, IsRefusedWithoutAStatureOrWithAnImplausibleOne) {
  const auto errors = [](const std::string& person, const std::string& more = "") {
    return errors_of(
        person_cell("{name: anna, person: {" + person + "}, groups: [people]" + more + "}"));
  };
  EXPECT_THAT(errors("error: 60"), HasSubstr("stature"));
  EXPECT_THAT(errors("stature: 1700"), HasSubstr("error"));
  for (const char* stature : {"1.7", "170", "2400", "-1700"})
    EXPECT_THAT(errors(std::string("error: 60, stature: ") + stature), HasSubstr("stature"));
  EXPECT_THAT(errors("error: 60, stature: 1700, id: b/7"), HasSubstr("'b/7'"));
  EXPECT_THAT(errors("error: 60, stature: 1700, id: " + std::string(33, 'b')), HasSubstr("32"));
  EXPECT_THAT(errors("error: 60, stature: 1700", ", prefix: a_"), HasSubstr("'prefix'"));
  EXPECT_THAT(errors("error: 60, stature: 1700", ", base: {frame: body_b1}"),
              HasSubstr("'frame' of a person's base"));
  EXPECT_THAT(errors_of(person_cell(kAnna, "markers: false")), HasSubstr("world_frame"));
}

TEST(Person, IsRequiredWhereBodiesAreTracked) {
  const std::string tracked = "world_frame: map, tracked_bodies: true";
  EXPECT_EQ(scene_of(person_cell(kAnna, tracked)).robots.size(), 1u);
  const std::string none =
      "name: test\nunits: {length: m, angle: rad}\nros2: {tracked_bodies: true}\nobjects:\n"
      "  - {name: a, sphere: {radius: 1}}\n  - {name: b, sphere: {radius: 1}}\n"
      "pairs: [{between: [a, b]}]\n";
  EXPECT_THAT(errors_of(none), HasSubstr("persons"));
}

TEST(Person, GetsAndLosesItsBodyByAChange) {
  auto opened = CellEditor::open(person_cell(kAnna), "cell.yaml");
  CellEditor editor = std::get<CellEditor>(std::move(opened));
  const auto edit = [&](const SetAbsent& change) {
    auto result = editor.edit(std::vector<CellChange>{change});
    const auto* refusal = std::get_if<EditRefusal>(&result);
    EXPECT_EQ(refusal, nullptr) << refusal->reason;
    return std::get<Cell>(std::move(result)).scene;
  };
  EXPECT_EQ(edit({"anna", false, "b9"}).robots[0].base.frame, "body_b9");
  const Scene gone = edit({"anna", true, ""});
  EXPECT_TRUE(limb(gone, "torso_anna").absent);
  EXPECT_EQ(gone.robots[0].person->id, "");
  EXPECT_FALSE(limb(edit({"anna", false, {}}), "torso_anna").absent);
  const auto refused = editor.edit(std::vector<CellChange>{SetAbsent{"post", false, "b1"}});
  EXPECT_THAT(std::get<EditRefusal>(refused).reason, HasSubstr("no person"));
}

// Neither its joints nor its frame have names that a body's can have.
TEST(Person, WithoutABodyIsHeardOfNone) {
  const Scene scene =
      scene_of(person_cell("{name: anna, person: {stature: 1700, error: 60, id: ''}, "
                           "groups: [people]}"));
  EXPECT_EQ(scene.robots[0].person->id, "");
  EXPECT_EQ(scene.robots[0].base.frame, "body_anna?");
  for (const JointVariable& variable : scene.variables)
    EXPECT_TRUE(variable.name.ends_with("_anna?") || variable.name.starts_with("anna_base/"))
        << variable.name;
}

}  // namespace
}  // namespace clearance
