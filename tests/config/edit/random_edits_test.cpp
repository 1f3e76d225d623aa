// Random lists of changes.
//
// Oracle: the ordinary reader, which reads each changed text as a file of its own.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tests/config/edit/edited_cell.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// Draws changes that are often, but not always, possible.
CellChange random_change(Random& random) {
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
  };
  const std::array<std::string, 9> names = {"table", "cart", "box", "spare", "p0",
                                            "p1",    "p2",   "p3",  "hand"};
  const std::string &name = names[below(names.size())], &other = names[below(names.size())];
  const auto pose = [&] {
    return Pose(Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)),
                below(2) == 0 ? Eigen::Quaterniond::Identity() : random.rotation());
  };
  const auto maybe = [&](double value) {
    return below(3) == 0 ? std::nullopt : std::optional(value);
  };
  switch (below(15)) {
    case 0:
      return AddObject{
          "{name: p" + std::to_string(below(4)) +
          ", groups: [things], capsule: {from: [0, 0, 0], to: [0, 0, 70], radius: 9}}"};
    case 1:
    case 2:
      return AddFromTemplate{"bin", "p" + std::to_string(below(4)), {}, pose()};
    case 3:
      return RemoveObject{name};
    case 4:
      return SetAbsent{name, below(2) == 0};
    case 5:
    case 6:
      return Attach{name, below(2) == 0 ? "tip" : other, pose(),
                    below(2) == 0 ? std::vector<std::string>{other} : std::vector<std::string>{}};
    case 7:
      return Detach{name, pose()};
    case 8:
      return Place{name, pose()};
    case 9:
      return SetMaxSpeed{name, maybe(random.uniform(-0.1, 2.0))};
    case 10:
      return SetMargin{name, maybe(random.uniform(-0.01, 0.1))};
    case 11:
      return SetPair{name, other, static_cast<SetPair::Rule>(below(4)), "drawn"};
    case 12: {
      ContactEnd end;
      if (below(2) == 0) end.distance = random.uniform(-0.001, 0.1);
      if (below(2) == 0) end.time_ns = 1'700'000'000'123'456'789;
      return AllowContact{"c" + std::to_string(below(3)),
                          name,
                          other,
                          random.uniform(-0.001, 0.01),
                          end,
                          "drawn",
                          "drawn"};
    }
    case 13:
      return WithdrawContact{"c" + std::to_string(below(3))};
    default:
      return SetZoneThresholds{"stop", random.uniform(0.0, 0.1), random.uniform(0.05, 0.2)};
  }
}

// Step by step, wholly in one list, and from the text: the same cell. Refusals leave no trace.
TEST_F(CellEdits, RandomListsGiveTheCellOfTheirText) {
  Random random(11);
  int accepted = 0, rejected = 0;
  std::string text = kEditedCell;  // without the mesh, which every reading checks again
  text.replace(text.find("mesh: {file: spare.obj}"), 23, "sphere: {radius: 60}");
  for (int round = 0; round < 8; ++round) {
    editor_.emplace(open(text));
    CellEditor whole = open(text);
    std::vector<CellChange> done;
    for (int step = 0; step < 30; ++step) {
      const std::array<CellChange, 1> change{random_change(random)};
      const std::string before = editor_->text();
      const auto result = editor_->edit(change);
      if (std::holds_alternative<EditRefusal>(result)) {
        ++rejected;
        ASSERT_EQ(editor_->text(), before);
        continue;
      }
      ++accepted;
      done.push_back(change[0]);
      const Cell& cell = std::get<Cell>(result);
      expect_same(cell, read_good(cell.yaml, folder_ / "cell.yaml"));
      if (HasFailure()) return;
    }
    const auto at_once = whole.edit(done);
    ASSERT_TRUE(std::holds_alternative<Cell>(at_once));
    EXPECT_EQ(std::get<Cell>(at_once).yaml, editor_->text());
  }
  EXPECT_GT(accepted, 50);
  EXPECT_GT(rejected, 40);
}

}  // namespace
}  // namespace clearance
