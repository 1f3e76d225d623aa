// A message is translated in the scene thread when its turn comes: it then finds the cell in force.
#include "monitor/daemon/moveit_port.hpp"

#include <utility>

#include "monitor/app/log_lines.hpp"

namespace clearance {

void MoveItPort::take(moveit::RawScene message) {
  const std::string topic = message.topic;
  QueuedCommand queued;
  queued.is_own = true;
  queued.bytes_to_make = message.cdr.size();
  queued.make = [this, message = std::move(message)](const Cell& cell, const AskPose& pose) {
    moveit::SceneKeeper::Work work = keeper_.take(message, cell, pose);
    for (const std::string& sentence : work.news) log_line(lines::kMoveItLeftOut, sentence);
    Command command;
    command.changes = std::move(work.changes);
    for (moveit::MeshFile& file : work.files)
      command.files.push_back({std::move(file.name), std::move(file.bytes)});
    return command;
  };
  queued.complete = [this](const Scene& changed) { return keeper_.complete(changed); };
  queued.answer = [this, topic](const CommandResult& result) {
    if (result.done()) return;
    keeper_.take_back();
    log_line(lines::kMoveItRefused, topic, result.path.empty() ? "" : result.path + ": ",
             result.reason);
  };
  const std::lock_guard lock(mutex_);
  if (put_ && !put_(std::move(queued)))
    log_line(lines::kMoveItRefused, topic, "", "too many commands wait, so that it is lost");
}

void MoveItPort::close() {
  const std::lock_guard lock(mutex_);
  put_ = nullptr;
}

}  // namespace clearance
