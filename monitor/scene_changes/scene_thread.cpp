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
  while (auto next = queue_.next()) {
    {
      const std::lock_guard lock(mutex_);
      if (phase_ == Phase::kEnded) return;
      phase_ = Phase::kReading;
    }
    const CommandResult result =
        commander_.execute(next->command, next->is_own, [this] { return begin_change(); });
    {
      const std::lock_guard lock(mutex_);
      if (phase_ == Phase::kEnded) return;
      phase_ = Phase::kChanging;
    }
    if (next->answer) next->answer(result);
  }
}

bool SceneThread::begin_change() {
  const std::lock_guard lock(mutex_);
  if (phase_ == Phase::kEnded) return false;
  phase_ = Phase::kChanging;
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
