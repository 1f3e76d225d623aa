#include "monitor/scene_changes/scene_thread.hpp"

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
    if (!enter(Phase::kReading)) return;
    if (next->make) {
      next->command = next->make(commander_.cell(), [this](const std::string& name) {
        return commander_.present_pose(name);
      });
    }
    const bool is_empty = next->make && next->command.changes.empty();
    const CommandResult result =
        is_empty ? CommandResult{}
                 : commander_.execute(
                       next->command, next->is_own, [this] { return enter(Phase::kChanging); },
                       next->complete);
    if (!enter(Phase::kChanging)) return;
    if (is_empty) continue;
    if (next->answer) next->answer(result);
  }
}

bool SceneThread::enter(Phase phase) {
  const std::lock_guard lock(mutex_);
  if (phase_ == Phase::kEnded) return false;
  phase_ = phase;
  return true;
}

bool SceneThread::end() {
  queue_.close();
  bool is_reading = false;
  {
    const std::lock_guard lock(mutex_);
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
