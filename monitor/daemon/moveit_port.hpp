// Takes MoveIt's messages to the queue of commands, one after another.
#pragma once

#include <functional>
#include <mutex>

#include "monitor/moveit/scene_keeper.hpp"
#include "monitor/scene_changes/command_queue.hpp"

namespace clearance {

class MoveItPort {
 public:
  // Puts a command into the queue; returns false if too much waits.
  using Put = std::function<bool(QueuedCommand)>;
  explicit MoveItPort(Put put) : put_(std::move(put)) {}

  // Any thread but that of the tick. Nothing is put after close().
  void take(moveit::RawScene message);
  void close();

 private:
  std::mutex mutex_;
  Put put_;                     // empty: closed
  moveit::SceneKeeper keeper_;  // used by the scene thread only
};

}  // namespace clearance
