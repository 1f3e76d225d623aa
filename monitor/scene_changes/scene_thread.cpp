#include "monitor/scene_changes/scene_thread.hpp"

#include <exception>

#include "monitor/loop/realtime.hpp"

namespace clearance {

SceneThread::~SceneThread() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void SceneThread::start() {
  thread_ = std::thread([this] { run(); });
}

void SceneThread::run() {
  name_thread("scene");
  if (!enter(Phase::kReading)) return;
  commander_.read_ahead();
  if (!enter(Phase::kChanging)) return;
  while (auto next = queue_.next()) {
    if (next->task) {
      next->task();
      continue;
    }
    if (!enter(Phase::kReading)) return;
    std::optional<CommandResult> result;
    if (next->make) result = make(*next);
    const bool is_empty = next->make && !result && next->command.changes.empty();
    if (!result && next->only_keeps_files) {
      result = commander_.keep_files(next->command);
    } else if (!result && !is_empty) {
      result = commander_.execute(
          next->command, next->is_own, [this] { return enter(Phase::kChanging); }, next->complete);
    }
    if (!enter(Phase::kChanging)) return;
    if (result && next->answer) next->answer(*result);
  }
}

// A message of another program may have any size.
std::optional<CommandResult> SceneThread::make(QueuedCommand& queued) {
  try {
    queued.command = queued.make(commander_.cell(), [this](const std::string& name) {
      return commander_.present_pose(name);
    });
    return std::nullopt;
  } catch (const std::exception& error) {
    return CommandResult{.status = CommandStatus::kFailed, .reason = error.what()};
  }
}

bool SceneThread::enter(Phase phase) {
  const std::lock_guard lock(mutex_);
  if (phase_ == Phase::kEnded || (is_ending_ && phase == Phase::kReading)) return false;
  phase_ = phase;
  return true;
}

bool SceneThread::end() {
  queue_.close();
  bool is_reading = false;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    is_reading = phase_ == Phase::kReading;
    if (is_reading) phase_ = Phase::kEnded;
  }
  if (is_reading && thread_.joinable()) {
    thread_.detach();
    return false;
  }
  if (thread_.joinable()) thread_.join();
  return true;
}

}  // namespace clearance
