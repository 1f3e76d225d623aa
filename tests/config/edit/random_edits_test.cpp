// Random lists of changes.
//
// Oracle: the ordinary reader, which reads each changed text as a file of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <variant>
#include <vector>

#include "tests/config/edit/drawn_change.hpp"
#include "tests/config/edit/edited_cell.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

// Step by step, wholly in one list, and from the text: the same cell. Refusals leave no trace.
TEST_F(CellEdits, RandomListsGiveTheCellOfTheirText) {
  Random random(11);
  std::array<int, test::kChangeKinds> accepted{}, rejected{};
  std::string text = kEditedCell;  // without the mesh, which every reading checks again
  text.replace(text.find("mesh: {file: spare.obj}"), 23, "sphere: {radius: 60}");
  std::string wider = text, invalid = text;
  wider.replace(wider.find("leave_above: 50"), 15, "leave_above: 60");
  invalid.replace(invalid.find("max_speed: 1000"), 15, "max_speed: -1");
  test::DrawnNames names{
      .objects = {"table", "cart", "box", "spare", "hand", "base", "none", "p0", "p1", "p2", "p3"},
      .added = {"p0", "p1", "p2", "p3"},
      .carriers = {"tip", "hand", "base"},
      .robots = {"arm", "arm", "none"},
      .joints = {"swing", "swing", "none"},
      .groups = {"things", "things", "arm", "none"},
      .templates = {"bin", "bin", "bin", "none"},
      .zones = {"stop", "stop", "none"},
      .contacts = {"c0", "c1", "c2"},
      .sources = {"camera", "robot", "a name that is longer than thirty-two bytes"},
      .cells = {text, wider, invalid, "name: ["},
      .files = {"", "cell.yaml"},
      .shapes = {"sphere: {radius: 60}", "box: {size: [100, 50, 70]}", "sphere: {radius: -1}",
                 "capsule: {from: [0, 0, 0], to: [0, 0, 70], radius: 9}"},
      .length = 0.001};
  test::DrawnChange draw(random, names);
  int compared = 0;
  for (int round = 0; round < 40; ++round) {
    editor_.emplace(open(text));
    CellEditor whole = open(text);
    names.attached.clear();
    std::vector<CellChange> done;
    for (int step = 0; step < 60; ++step) {
      const std::array<CellChange, 1> change{draw()};
      const std::string before = editor_->text();
      const auto result = editor_->edit(change);
      if (std::holds_alternative<EditRefusal>(result)) {
        ++rejected[change[0].index()];
        EXPECT_NE(std::get<EditRefusal>(result).reason, "");
        ASSERT_EQ(editor_->text(), before);
        continue;
      }
      ++accepted[change[0].index()];
      done.push_back(change[0]);
      const Cell& cell = std::get<Cell>(result);
      names.attached.clear();
      for (const Robot& robot : cell.scene.robots) {
        if (robot.is_attached)
          names.attached.push_back(cell.scene.objects[robot.links[0].object].name);
      }
      expect_same(cell, read_good(cell.yaml, folder_ / "cell.yaml"));
      if (HasFailure()) return;
    }
    const auto at_once = whole.edit(done);
    // A rule or a contact may become void by a later change. In one list that is a mistake.
    if (const auto* refused = std::get_if<EditRefusal>(&at_once)) {
      const bool is_rule = std::holds_alternative<SetPair>(done[refused->change]);
      EXPECT_TRUE(is_rule || std::holds_alternative<AllowContact>(done[refused->change]));
      EXPECT_TRUE(refused->path.starts_with(is_rule ? "pairs[" : "contacts["))
          << refused->path << ": " << refused->reason;
      continue;
    }
    ++compared;
    EXPECT_EQ(std::get<Cell>(at_once).yaml, editor_->text());
  }
  EXPECT_GT(compared, 8);
  for (std::size_t kind = 0; kind < test::kChangeKinds; ++kind) {
    const bool is_file = kind == CellChange(ReadCellAgain{}).index();  // a running monitor reads it
    EXPECT_EQ(accepted[kind] == 0, is_file) << kind;
    EXPECT_GT(rejected[kind], 0) << kind;
  }
}

// Of an object that comes, changes and goes: in one list or step by step, the same cell.
TEST_F(CellEdits, AllListsOfThreeGiveTheCellOfTheirSteps) {
  using enum SetPair::Rule;
  const std::string sphere = ", sphere: {radius: 60}}";
  const std::vector<CellChange> changes = {
      AddObject{"{name: p0, groups: [things]" + sphere},
      ReplaceObject{"{name: p0, groups: [things], fixed: true, pose: {xyz: [0, 0, 500]}" + sphere},
      RemoveObject{"p0"},
      Attach{.object = "p0", .to = "hand", .carrier_from_object = Pose{}, .far = true},
      Detach{"p0", Pose{Vec3(0, 0, 0.7), Eigen::Quaterniond::Identity()}},
      Place{"p0", Pose{Vec3(0, 0, 0.9), Eigen::Quaterniond::Identity()}},
      SetAbsent{"p0"},
      SetMaxSpeed{"p0", 1.0},
      SetPair{"p0", "cart", kPublish},
      SetPair{"p0", "cart", kLeaveOut, "they may touch"},
      AllowContact{"c0", "p0", "table", 0.01, {.distance = 0.1}, "test", "test"},
      WithdrawContact{"c0"}};
  std::string text = kEditedCell;  // without the mesh, which every reading checks again
  text.replace(text.find("mesh: {file: spare.obj}"), 23, "sphere: {radius: 60}");
  const auto is_rule = [](const CellChange& change) {
    return std::holds_alternative<SetPair>(change) || std::holds_alternative<AllowContact>(change);
  };
  const CellEditor begun = open(text);
  test::EveryChoice choice;
  int whole = 0;
  while (choice.next()) {
    std::vector<CellChange> list;
    for (int i = 0; i < 3; ++i) list.push_back(changes[choice.of(changes.size())]);
    CellEditor at_once = open(text), by_steps = open(text);
    bool are_accepted = true;
    for (const CellChange& change : list) {
      const auto result = by_steps.edit({&change, 1});
      are_accepted = are_accepted && std::holds_alternative<Cell>(result);
      if (!are_accepted) break;
    }
    const auto result = at_once.edit(list);
    if (const auto* refused = std::get_if<EditRefusal>(&result)) {
      ASSERT_EQ(at_once.text(), begun.text()) << choice.runs();
      // What a later change makes void is a mistake in one list.
      ASSERT_TRUE(!are_accepted || refused->path.starts_with("pairs[") ||
                  refused->path.starts_with("contacts["))
          << choice.runs() << ": " << refused->path << ": " << refused->reason;
      continue;
    }
    ++whole;
    // A list may name an object before it adds it.
    ASSERT_TRUE(are_accepted || std::ranges::any_of(list, is_rule)) << choice.runs();
    if (!are_accepted) continue;
    ASSERT_EQ(at_once.text(), by_steps.text()) << choice.runs();
  }
  EXPECT_EQ(choice.runs(), 1'728u);
  EXPECT_GT(whole, 50);
}

}  // namespace
}  // namespace clearance
