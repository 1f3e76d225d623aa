#include "monitor/replay/moveit_changes.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "monitor/tick/present_body.hpp"

namespace clearance {

bool MoveItChanges::open() {
  if (editor_) return true;
  auto opened = CellEditor::open(cell_->yaml, cell_->file);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&opened)) {
    notes_.push_back(
        fmt::format("messages of MoveIt change nothing, since the cell cannot be read again: {}",
                    errors->front().text));
    return false;
  }
  editor_.emplace(std::get<CellEditor>(std::move(opened)));
  return true;
}

const Cell* MoveItChanges::next(const Monitor& monitor) {
  if (waiting_.empty() || !open()) {
    waiting_.clear();
    return nullptr;
  }
  while (!waiting_.empty()) {
    const std::shared_ptr<const moveit::RawScene> message = waiting_.front();
    moveit::SceneKeeper::Work work;
    try {
      work = keeper_.take(*message, *cell_, [&](const std::string& name) -> std::optional<Pose> {
        const auto body = find_body(name, cell_->scene);
        if (!body) return std::nullopt;
        return pose_or_late(name, cell_->scene, present_pose(*body, monitor));
      });
    } catch (const PoseIsLate&) {
      keeper_.take_back();
      return nullptr;  // it waits for a later tick
    }
    waiting_.pop_front();
    for (const std::string& sentence : work.news) notes_.push_back("MoveIt's " + sentence);
    if (work.changes.empty()) continue;
    auto proposed = editor_->propose(
        work.changes, [this](const Scene& changed) { return keeper_.complete(changed); });
    if (const auto* refused = std::get_if<EditRefusal>(&proposed)) {
      keeper_.take_back();
      notes_.push_back(fmt::format("a message of MoveIt on {} changes nothing: {}{}{}",
                                   message->topic, refused->path, refused->path.empty() ? "" : ": ",
                                   refused->reason));
      continue;
    }
    editor_->keep();
    auto& cell = std::get<Cell>(proposed);
    if (cell.scene.revision == cell_->scene.revision) continue;
    adapt_(cell.scene);
    cells_.push_back(std::make_unique<const Cell>(std::move(cell)));
    cell_ = cells_.back().get();
    return cell_;
  }
  return nullptr;
}

}  // namespace clearance
