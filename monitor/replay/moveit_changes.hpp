// The changes that MoveIt's messages in a log make in the cell of a replay.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/edit/cell_editor.hpp"
#include "monitor/intake/scene_keeper.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// Messages mean what they mean to the daemon, with two exceptions. A mesh is its convex hull, since
// a replay writes no files. The capacity of the cell bounds nothing, since nothing has to be
// allocated beforehand.
class MoveItChanges {
 public:
  // `first` outlives this. `adapt`: as for SceneHistory.
  MoveItChanges(const Cell& first, std::function<void(Scene&)> adapt)
      : cell_(&first), adapt_(std::move(adapt)) {}

  void add(std::shared_ptr<const moveit::RawScene> message) {
    waiting_.push_back(std::move(message));
  }
  // The cell after the first of the waiting messages that changes it; it lives as long as this.
  // Null: no message does. The monitor has run the last tick of the present cell.
  [[nodiscard]] const Cell* next(const Monitor& monitor);
  // The parts that were left out, and why: each is one sentence.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  [[nodiscard]] bool open();

  const Cell* cell_;
  std::function<void(Scene&)> adapt_;
  std::optional<CellEditor> editor_;  // opened when the first message comes
  moveit::SceneKeeper keeper_{moveit::MeshForm::kHull};
  std::deque<std::shared_ptr<const moveit::RawScene>> waiting_;
  std::vector<std::unique_ptr<const Cell>> cells_;
  std::vector<std::string> notes_;
};

}  // namespace clearance
