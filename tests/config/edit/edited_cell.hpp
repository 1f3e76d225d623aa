// A cell with a robot, a template and objects of every kind, and an editor of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {

inline const std::string kOneJointUrdf = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="swing" type="revolute"><origin xyz="2 0 0"/><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="frame" type="fixed"><origin xyz="1 0 0"/><parent link="hand"/><child link="tip"/></joint>
</robot>
)";

inline const std::string kEditedCell = R"(# A cell for the tests of changes.
name: test
units: {length: mm, angle: deg}

robots:
  - {name: arm, urdf: arm.urdf}
templates: # bodies
  - {name: bin, groups: [things], margin: 5, box: {size: [100, 100, 100]}}
objects:
  # The table is heavy.
  - name: table
    fixed: true
    groups: [things]
    pose: {xyz: [0, 900, 0]} # in the corner
    box: {size: [300, 300, 30]}
  - {name: cart, groups: [things], max_speed: 1000, sphere: {radius: 100}}
  - {name: box, groups: [things], fixed: true, pose: {xyz: [0, 0, 1500.0]}, box: {size: [10, 20, 30]}}
  - name: spare
    mesh: {file: spare.obj}
pairs:
  - {between: [arm, things], publish: false} # all of them
  - {between: [spare, cart]}
zones:
  - {name: stop, between: [hand, table], enter_below: 30, leave_above: 50}
)";

// Compares what the monitor and the programs read of a cell.
inline void expect_same(const Cell& a, const Cell& b) {
  EXPECT_EQ(a.yaml, b.yaml);
  EXPECT_EQ(a.file, b.file);
  EXPECT_EQ(a.files, b.files);
  EXPECT_EQ(a.scene.revision, b.scene.revision);
  ASSERT_EQ(a.scene.objects.size(), b.scene.objects.size());
  for (std::size_t i = 0; i < a.scene.objects.size(); ++i) {
    const Object &x = a.scene.objects[i], &y = b.scene.objects[i];
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.groups, y.groups);
    EXPECT_EQ(x.fixed, y.fixed);
    EXPECT_EQ(x.absent, y.absent);
    EXPECT_EQ(x.world_from_object.position, y.world_from_object.position);
    EXPECT_EQ(x.world_from_object.orientation.coeffs(), y.world_from_object.orientation.coeffs());
    EXPECT_EQ(x.margin, y.margin);
    EXPECT_EQ(x.max_speed, y.max_speed);
    EXPECT_EQ(x.age_limit_ns, y.age_limit_ns);
    EXPECT_EQ(x.source, y.source);
    EXPECT_EQ(x.pose_error, y.pose_error);
    ASSERT_EQ(x.parts.size(), y.parts.size());
    for (std::size_t p = 0; p < x.parts.size(); ++p) {
      EXPECT_EQ(x.parts[p].name, y.parts[p].name);
      EXPECT_EQ(x.parts[p].shape.anchors, y.parts[p].shape.anchors);
      EXPECT_EQ(x.parts[p].shape.radius, y.parts[p].shape.radius);
      EXPECT_EQ(x.parts[p].shape.position_error, y.parts[p].shape.position_error);
      EXPECT_EQ(x.parts[p].object_from_part.position, y.parts[p].object_from_part.position);
    }
  }
  ASSERT_EQ(a.scene.robots.size(), b.scene.robots.size());
  for (std::size_t i = 0; i < a.scene.robots.size(); ++i) {
    const RobotBase &x = a.scene.robots[i].base, &y = b.scene.robots[i].base;
    EXPECT_EQ(a.scene.robots[i].name, b.scene.robots[i].name);
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.object, y.object);
    EXPECT_EQ(x.robot, y.robot);
    EXPECT_EQ(x.link, y.link);
    EXPECT_EQ(x.base_from_root.position, y.base_from_root.position);
    EXPECT_EQ(x.base_from_root.orientation.coeffs(), y.base_from_root.orientation.coeffs());
  }
  ASSERT_EQ(a.scene.variables.size(), b.scene.variables.size());
  for (std::size_t i = 0; i < a.scene.variables.size(); ++i) {
    const JointVariable &x = a.scene.variables[i], &y = b.scene.variables[i];
    EXPECT_EQ(x.is_held(), y.is_held());
    EXPECT_EQ(x.is_read, y.is_read);
    EXPECT_TRUE(!x.is_held() || x.held == y.held);
  }
  ASSERT_EQ(a.scene.pairs.size(), b.scene.pairs.size());
  for (std::size_t i = 0; i < a.scene.pairs.size(); ++i) {
    EXPECT_EQ(a.scene.pairs[i].first, b.scene.pairs[i].first);
    EXPECT_EQ(a.scene.pairs[i].second, b.scene.pairs[i].second);
    EXPECT_EQ(a.scene.pairs[i].publish, b.scene.pairs[i].publish);
  }
  ASSERT_EQ(a.scene.zones.size(), b.scene.zones.size());
  for (std::size_t i = 0; i < a.scene.zones.size(); ++i) {
    EXPECT_EQ(a.scene.zones[i].pairs, b.scene.zones[i].pairs);
    EXPECT_EQ(a.scene.zones[i].enter_below, b.scene.zones[i].enter_below);
    EXPECT_EQ(a.scene.zones[i].leave_above, b.scene.zones[i].leave_above);
  }
  ASSERT_EQ(a.scene.contacts.size(), b.scene.contacts.size());
  for (std::size_t i = 0; i < a.scene.contacts.size(); ++i) {
    EXPECT_EQ(a.scene.contacts[i].name, b.scene.contacts[i].name);
    EXPECT_EQ(a.scene.contacts[i].pairs, b.scene.contacts[i].pairs);
    EXPECT_EQ(a.scene.contacts[i].depth, b.scene.contacts[i].depth);
    EXPECT_TRUE(a.scene.contacts[i].end == b.scene.contacts[i].end);
    EXPECT_EQ(a.scene.contacts[i].by, b.scene.contacts[i].by);
    EXPECT_EQ(a.scene.contacts[i].reason, b.scene.contacts[i].reason);
  }
}

class CellEdits : public testing::Test {
 protected:
  CellEdits() {
    test::write_text(folder_ / "arm.urdf", kOneJointUrdf);
    test::write_text(
        folder_ / "spare.obj",
        "v 0 0 0\nv 200 0 0\nv 0 200 0\nv 0 0 200\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    editor_.emplace(open(kEditedCell));
  }
  [[nodiscard]] CellEditor open(const std::string& text) const {
    auto opened = CellEditor::open(text, folder_ / "cell.yaml");
    if (const auto* errors = std::get_if<std::vector<CellError>>(&opened)) {
      for (const CellError& error : *errors) ADD_FAILURE() << error.text;
    }
    return std::get<CellEditor>(std::move(opened));
  }
  // Makes changes that have to be accepted, and reads the text as a file.
  Cell edit(const std::vector<CellChange>& changes) {
    auto result = editor_->edit(changes);
    if (const auto* refused = std::get_if<EditRefusal>(&result)) {
      ADD_FAILURE() << refused->change << " " << refused->path << ": " << refused->reason;
      return {};
    }
    EXPECT_EQ(std::get<Cell>(result).yaml, editor_->text());
    expect_same(std::get<Cell>(result), read_good(editor_->text(), folder_ / "cell.yaml"));
    return std::get<Cell>(std::move(result));
  }
  // Makes changes that have to be refused, and to leave the text as it was.
  EditRefusal refused(const std::vector<CellChange>& changes) {
    const std::string before = editor_->text();
    const auto result = editor_->edit(changes);
    EXPECT_EQ(editor_->text(), before);
    if (const auto* refusal = std::get_if<EditRefusal>(&result)) {
      EXPECT_FALSE(refusal->reason.empty());
      return *refusal;
    }
    ADD_FAILURE() << "accepted: " << std::get<Cell>(result).yaml;
    return {};
  }
  static const Object& named(const Cell& cell, const std::string& name) {
    return *std::ranges::find(cell.scene.objects, name, &Object::name);
  }
  static const ObjectPair* pair(const Cell& cell, const std::string& a, const std::string& b) {
    for (const ObjectPair& each : cell.scene.pairs) {
      const std::string &first = cell.scene.objects[each.first].name,
                        &second = cell.scene.objects[each.second].name;
      if ((first == a && second == b) || (first == b && second == a)) return &each;
    }
    return nullptr;
  }

  test::ScratchFolder folder_;
  std::optional<CellEditor> editor_;
};

}  // namespace clearance
