#include "config/edit/change_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

std::vector<CellChange> changes_of(const std::string& text,
                                   const std::filesystem::path& file = "changes.yaml") {
  auto read = read_changes(text, file);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&read)) {
    for (const CellError& error : *errors) ADD_FAILURE() << error.text;
    return {};
  }
  return std::get<std::vector<CellChange>>(std::move(read));
}

std::vector<std::string> mistakes_of(const std::string& text) {
  const auto read = read_changes(text, "changes.yaml");
  std::vector<std::string> texts;
  if (const auto* errors = std::get_if<std::vector<CellError>>(&read)) {
    for (const CellError& error : *errors) texts.push_back(error.text);
  }
  return texts;
}

template <class Change>
Change only(const std::string& text) {
  const std::vector<CellChange> changes = changes_of(text);
  if (changes.size() != 1 || !std::holds_alternative<Change>(changes[0])) {
    ADD_FAILURE() << changes.size() << " changes, or one of another kind: " << text;
    return {};
  }
  return std::get<Change>(changes[0]);
}

TEST(ChangeReader, ReadsEveryKindInTheOrderOfTheText) {
  const auto changes = changes_of(R"(
- add_object: {name: box, fixed: true, sphere: {radius: 5}}
- add_from_template: {template: bin, object: bin_7, groups: [bins], pose: {xyz: [1, 2, 3]}}
- remove_object: {object: box}
- set_absent: {object: part}
- attach: {object: part, to: hand, pose: {xyz: [0, 0, 0.1]}, touch: [finger], overlap: 0.002}
- detach: {object: part}
- place: {object: bin_7, pose: {xyz: [1, 0, 0]}}
- set_max_speed: {object: cart, max_speed: 2}
- set_margin: {object: cart}
- set_age_limit: {object: cart, age_limit_ms: 12.5}
- set_source: {object: cart, source: tracker}
- set_pair: {between: [a, b], rule: leave_out, reason: they are welded}
- set_zone_thresholds: {zone: stop, enter_below: 0.1, leave_above: 0.2}
- read_cell_again: {}
- replace_object: {name: box, fixed: true, sphere: {radius: 6}}
- allow_contact: {contact: grip, between: [part, fingers], depth: 0.002, until: {distance: 0.01, cycle: 900}, by: planner, reason: it is gripped}
- withdraw_contact: {contact: grip}
- attach_robot: {robot: gripper, to: flange, pose: {xyz: [0, 0, 0.1]}, far: true}
- detach_robot: {robot: gripper, joints: {left: 0.01}, absent: true}
- note: {text: it was looked into}
)");
  ASSERT_EQ(changes.size(), 20u);
  EXPECT_EQ(std::get<AddObject>(changes[0]).yaml, "{name: box, fixed: true, sphere: {radius: 5}}");
  const auto& bin = std::get<AddFromTemplate>(changes[1]);
  EXPECT_EQ(bin.template_name, "bin");
  EXPECT_EQ(bin.object, "bin_7");
  EXPECT_THAT(bin.groups, ElementsAre("bins"));
  EXPECT_EQ(bin.world_from_object.position, Vec3(1, 2, 3));
  EXPECT_EQ(std::get<RemoveObject>(changes[2]).object, "box");
  EXPECT_TRUE(std::get<SetAbsent>(changes[3]).absent);
  const auto& attach = std::get<Attach>(changes[4]);
  EXPECT_EQ(attach.object, "part");
  EXPECT_EQ(attach.to, "hand");
  EXPECT_EQ(attach.carrier_from_object.value().position, Vec3(0, 0, 0.1));
  EXPECT_THAT(attach.touch, ElementsAre("finger"));
  EXPECT_EQ(attach.overlap, 0.002);
  EXPECT_FALSE(std::get<Detach>(changes[5]).world_from_object) << "where it is now";
  EXPECT_EQ(std::get<Place>(changes[6]).world_from_object.position, Vec3(1, 0, 0));
  EXPECT_EQ(std::get<SetMaxSpeed>(changes[7]).m_per_s, 2.0);
  EXPECT_FALSE(std::get<SetMargin>(changes[8]).m) << "the default of the cell";
  EXPECT_EQ(std::get<SetAgeLimit>(changes[9]).ns, 12'500'000);
  EXPECT_EQ(std::get<SetSource>(changes[10]).source, "tracker");
  const auto& pair = std::get<SetPair>(changes[11]);
  EXPECT_EQ(pair.a + pair.b, "ab");
  EXPECT_EQ(pair.rule, SetPair::Rule::kLeaveOut);
  EXPECT_EQ(pair.reason, "they are welded");
  EXPECT_EQ(std::get<SetZoneThresholds>(changes[12]).leave_above, 0.2);
  EXPECT_EQ(std::get<ReadCellAgain>(changes[13]).file, "");
  EXPECT_EQ(std::get<ReplaceObject>(changes[14]).yaml,
            "{name: box, fixed: true, sphere: {radius: 6}}");
  const auto& contact = std::get<AllowContact>(changes[15]);
  EXPECT_EQ(contact.contact, "grip");
  EXPECT_EQ(contact.a + contact.b, "partfingers");
  EXPECT_EQ(contact.depth, 0.002);
  EXPECT_EQ(contact.end, (ContactEnd{.distance = 0.01, .last_cycle = 900}));
  EXPECT_EQ(contact.by, "planner");
  EXPECT_EQ(std::get<WithdrawContact>(changes[16]).contact, "grip");
  const auto& attach_robot = std::get<AttachRobot>(changes[17]);
  EXPECT_EQ(attach_robot.robot + attach_robot.to, "gripperflange");
  EXPECT_EQ(attach_robot.carrier_from_root.value().position, Vec3(0, 0, 0.1));
  EXPECT_TRUE(attach_robot.far);
  const auto& detach_robot = std::get<DetachRobot>(changes[18]);
  ASSERT_EQ(detach_robot.joints.size(), 1u);
  EXPECT_EQ(detach_robot.joints[0].position, 0.01);
  EXPECT_TRUE(detach_robot.absent && !detach_robot.powered);
  EXPECT_EQ(std::get<Note>(changes[19]).text, "it was looked into");
}

// The block of YAML in idl/COMMANDS.md, which names the file of another cell.
TEST(ChangeReader, ReadsThePageAboutCommandsWhichHasEveryKind) {
  std::ifstream page(test::places::sources() + "/idl/COMMANDS.md");
  std::string text{std::istreambuf_iterator<char>(page), {}};
  text.erase(0, text.find("```yaml\n") + 8);
  text.erase(text.find("```"));
  const test::ScratchFolder folder;
  test::write_text(folder / "other.yaml", "name: other\n");
  std::set<std::size_t> kinds;
  for (const CellChange& change : changes_of(text, folder / "changes.yaml"))
    kinds.insert(change.index());
  EXPECT_EQ(kinds.size(), std::variant_size_v<CellChange>);
}

TEST(ChangeReader, TakesLengthsAndAnglesInTheStatedUnits) {
  const auto changes = changes_of(R"(
units: {length: mm, angle: deg}
changes:
  - attach: {object: part, to: hand, pose: {xyz: [0, 0, 90], rpy: [0, 0, 90]}, overlap: 2}
  - set_zone_thresholds: {zone: stop, enter_below: 30, leave_above: 50}
)");
  ASSERT_EQ(changes.size(), 2u);
  const auto& attach = std::get<Attach>(changes[0]);
  const Pose pose = attach.carrier_from_object.value();
  EXPECT_EQ(pose.position, Vec3(0, 0, 0.09));
  EXPECT_NEAR(pose.orientation.z(), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(attach.overlap, 0.002);
  EXPECT_EQ(std::get<SetZoneThresholds>(changes[1]).enter_below, 0.03);
}

TEST(ChangeReader, AcceptsOneChangeWithoutAList) {
  EXPECT_EQ(only<Attach>("attach: {object: part, to: hand}").to, "hand");
  EXPECT_FALSE(only<SetAbsent>("set_absent: {object: part, absent: false}").absent);
  EXPECT_EQ(only<SetAbsent>("set_absent: {object: part}").id, std::nullopt);
  EXPECT_EQ(only<SetAbsent>("set_absent: {object: person_1, id: b7}").id, "b7");
}

TEST(ChangeReader, ReadsTheFileThatReplacesTheCellFromBesideTheChanges) {
  const test::ScratchFolder folder;
  test::write_text(folder / "other.yaml", "name: other\n");
  const auto changes = changes_of("- replace_cell: {file: other.yaml}\n", folder / "changes.yaml");
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(std::get<ReplaceCell>(changes[0]).yaml, "name: other\n");
}

TEST(ChangeReader, NamesTheSpotOfEveryMistake) {
  const auto errors = mistakes_of(R"(- attach: {object: part, too: hand}
- atach: {object: part}
- set_pair: {between: [a], rule: publish}
- set_pair: {between: [a, b], rule: forbid}
- place: {object: part}
- set_zone_thresholds: {zone: stop, enter_below: near, leave_above: 1}
- [attach]
- replace_cell: {file: no_such_file.yaml}
- set_max_speed: {object: cart, max_speed: -1}
)");
  std::vector<std::string> places;
  for (const std::string& error : errors) places.push_back(error.substr(0, error.find(": ")));
  EXPECT_THAT(places, ElementsAre("changes.yaml:1:11", "changes.yaml:1:26", "changes.yaml:2:3",
                                  "changes.yaml:3:23", "changes.yaml:4:37", "changes.yaml:5:10",
                                  "changes.yaml:6:50", "changes.yaml:7:3", "changes.yaml:8:24",
                                  "changes.yaml:9:44"));
  EXPECT_THAT(mistakes_of("- attach: {object"), ElementsAre(StartsWith("changes.yaml:1:")));
  EXPECT_THAT(mistakes_of("units: {length: inch}\nchanges: []\n"),
              ElementsAre(StartsWith("changes.yaml:1:17")));
}

}  // namespace
}  // namespace clearance
