// A message is translated in the scene thread when its turn comes: it then finds the cell in force.
#include "monitor/daemon/moveit_port.hpp"

#include <utility>

#include "monitor/app/log_lines.hpp"

namespace clearance {

void MoveItPort::take(moveit::RawScene message) {
  const std::string topic = message.topic;
  QueuedCommand queued;
  queued.is_own = true;
  queued.make = [this, message = std::move(message)](const Cell& cell, const AskPose& pose) {
    moveit::SceneKeeper::Work work = keeper_.take(message, cell, pose);
    for (const std::string& sentence : work.news) log_line(lines::kMoveItLeftOut, sentence);
    Command command;
    command.changes = std::move(work.changes);
    for (moveit::MeshFile& file : work.files)
      command.files.push_back({std::move(file.name), std::move(file.bytes)});
    if (command.changes.empty()) follow_matrix(message.topic);
    return command;
  };
  queued.answer = [this, topic](const CommandResult& result) {
    log_result(result, topic);
    follow_matrix(topic);
  };
  put(std::move(queued), topic);
}

// The exceptions from pairs are those of the changed cell.
void MoveItPort::follow_matrix(const std::string& topic) {
  QueuedCommand queued;
  queued.is_own = true;
  queued.make = [this](const Cell& cell, const AskPose&) {
    Command command;
    command.changes = keeper_.exceptions(cell);
    return command;
  };
  queued.answer = [topic](const CommandResult& result) { log_result(result, topic); };
  put(std::move(queued), topic);
}

void MoveItPort::log_result(const CommandResult& result, const std::string& topic) {
  if (result.done()) return;
  log_line(lines::kMoveItRefused, topic, result.path.empty() ? "" : result.path + ": ",
           result.reason);
}

void MoveItPort::put(QueuedCommand command, const std::string& topic) {
  const std::lock_guard lock(mutex_);
  if (!put_) return;
  if (!put_(std::move(command)))
    log_line(lines::kMoveItRefused, topic, "", "too many commands wait, so that it is lost");
}

void MoveItPort::close() {
  const std::lock_guard lock(mutex_);
  put_ = nullptr;
}

}  // namespace clearance
