// A cell with an arm that takes MoveIt's messages, and what becomes of it message after message.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "monitor/intake/known_scene.hpp"
#include "monitor/intake/scene_translator.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::moveit {

inline const std::string kMoveItArm = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="finger"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="swing" type="revolute"><origin xyz="2 0 0"/><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="close" type="prismatic"><origin xyz="0.2 0 0"/><parent link="hand"/><child link="finger"/><axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="1"/></joint>
  <joint name="frame" type="fixed"><origin xyz="1 0 0"/><parent link="hand"/><child link="tip"/></joint>
</robot>
)";

// The cell is in millimetres, unlike the messages.
inline const std::string kMoveItCell = R"(name: test
units: {length: mm, angle: deg}
ros2: {planning_scene: true, collision_object: true, attached_collision_object: true, world_frame: map}
robots:
  - {name: arm, urdf: arm.urdf}
objects:
  - {name: table, fixed: true, groups: [cells], pose: {xyz: [0, 5000, 0]}, box: {size: [300, 300, 30]}}
  - {name: cart, groups: [cells], sphere: {radius: 100}}
pairs:
  - {between: [arm, arm]}
  - {between: [arm, cells]}
  - {between: [arm, moveit], publish: false}
zones:
  - {name: near, between: [hand, moveit], enter_below: 30, leave_above: 50}
)";

class MoveItCell : public testing::Test {
 protected:
  explicit MoveItCell(const std::string& text = kMoveItCell) {
    test::write_text(folder_ / "arm.urdf", kMoveItArm);
    auto opened = CellEditor::open(text, folder_ / "cell.yaml");
    if (const auto* errors = std::get_if<std::vector<CellError>>(&opened)) {
      for (const CellError& error : *errors) ADD_FAILURE() << error.text;
    }
    editor_.emplace(std::get<CellEditor>(std::move(opened)));
    cell_ = read(text);
    poses_["hand"] = {{2.0, 0.0, 0.0}, test::turned(Vec3::UnitZ(), 0.5)};
    poses_["tip"] = compose(poses_["hand"], test::at(1.0, 0.0, 0.0));
  }

  [[nodiscard]] Cell read(const std::string& text) const {
    return read_good(text, folder_ / "cell.yaml");
  }

  // Does what a message says, which has to give a cell that the reader accepts.
  template <class Message>
  Translation send(const Message& message) {
    Translation done =
        translator_.translate(message, known_scene(cell_), [this](const std::string& body) {
          const auto found = poses_.find(body);
          return found == poses_.end() ? std::nullopt : std::optional(found->second);
        });
    for (const MeshFile& file : done.files)
      test::write_text(folder_ / ("sent:" + file.name), file.bytes);
    make(done);
    const KnownScene known = known_scene(cell_);
    EXPECT_TRUE(translator_.exceptions(known.watched, known.exceptions).empty());
    return done;
  }
  // Sends what must be refused, and must change nothing. Returns the field.
  template <class Message>
  std::string refused(const Message& message) {
    const std::string before = editor_->text();
    const Translation done = send(message);
    EXPECT_EQ(editor_->text(), before);
    return done.refused.size() == 1 ? done.refused.front().field : "";
  }

  [[nodiscard]] const Object* object(const std::string& name) const {
    const auto& objects = cell_.scene.objects;
    const auto found = std::ranges::find(objects, name, &Object::name);
    return found == objects.end() ? nullptr : &*found;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Object& each : cell_.scene.objects) names.push_back(each.name);
    return names;
  }
  [[nodiscard]] bool watches(const std::string& a, const std::string& b) const {
    return known_scene(cell_).watched.contains(name_pair(a, b));
  }
  // The place of an attached object in the frame of the link that carries it.
  [[nodiscard]] const RobotBase* carried(const std::string& name) const {
    for (const Robot& robot : cell_.scene.robots) {
      if (robot.is_attached && robot.name == name) return &robot.base;
    }
    return nullptr;
  }

  const test::ScratchFolder folder_;
  std::optional<CellEditor> editor_;
  Cell cell_;
  SceneTranslator translator_;
  std::map<std::string, Pose> poses_;  // of links now

 private:
  void make(const Translation& done) {
    std::vector<CellChange> changes = done.changes;
    auto result = editor_->propose(changes, [&](const Scene& changed) {
      return translator_.exceptions(watched_pairs(changed), done.exceptions);
    });
    if (const auto* refusal = std::get_if<EditRefusal>(&result)) {
      ADD_FAILURE() << refusal->change << " " << refusal->path << ": " << refusal->reason;
      return;
    }
    editor_->keep();
    cell_ = std::get<Cell>(std::move(result));
  }
};

}  // namespace clearance::moveit
