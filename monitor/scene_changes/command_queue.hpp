// Commands that wait until the scene thread applies them. DDS, SIGHUP and MoveIt's messages all
// enter here.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "config/cell/cell.hpp"
#include "config/edit/cell_editor.hpp"
#include "core/pose.hpp"
#include "monitor/command.hpp"
#include "monitor/loop/request_queue.hpp"

namespace clearance {

// Returns where an object or a link of the scene in force is now, in the world; nothing: its pose
// is not usable.
using AskPose = std::function<std::optional<Pose>(const std::string& name)>;

struct QueuedCommand {
  Command command = {};
  // The daemon's own: `client` is not checked, and files may lie anywhere.
  bool is_own = false;
  // Gets the result, in the scene thread.
  std::function<void(const CommandResult&)> answer = {};
  // Makes the command when its turn comes, in the scene thread, if it depends on the cell in force.
  // One without changes is not done, and has no result.
  std::function<Command(const Cell& cell, const AskPose& pose)> make = {};
  std::size_t bytes_to_make = 0;  // the bytes that `make` holds
  // Another daemon does the command, and this one keeps the files that it sends along. The result
  // says whether it could.
  bool only_keeps_files = false;
  // Other work of the daemon that must not meet a change of the scene. The rest is then not read.
  std::function<void()> task = {};
  // Adds changes that depend on the scene to which the others lead. All are done, or none.
  CompleteChanges complete = {};
};

// The bytes of the texts and files of a command, roughly.
[[nodiscard]] std::size_t bytes_of(const Command& command);
[[nodiscard]] inline std::size_t bytes_of(const QueuedCommand& queued) {
  return bytes_of(queued.command) + queued.bytes_to_make;
}

class CommandQueue : public RequestQueue<QueuedCommand> {
 public:
  // The number of commands that may wait, and the bytes of their texts and files.
  static constexpr std::size_t kMost = 64, kMostBytes = 128 << 20;
  CommandQueue() : RequestQueue(kMost, kMostBytes) {}
};

}  // namespace clearance
