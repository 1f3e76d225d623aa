// Random lists of changes.
//
// Oracle: the ordinary reader, which reads each changed text as a file of its own.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "tests/config/edit/drawn_change.hpp"
#include "tests/config/edit/edited_cell.hpp"

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
  for (int round = 0; round < 24; ++round) {
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

}  // namespace
}  // namespace clearance
