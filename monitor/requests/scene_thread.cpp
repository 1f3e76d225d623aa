#include "monitor/requests/scene_thread.hpp"

#include <exception>
#include <variant>

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
  while (auto task = queue_.next()) {
    if (const auto* const work = std::get_if<OtherWork>(&*task)) {
      work->run();
      continue;
    }
    if (!enter(Phase::kReading)) return;
    const std::optional<CommandResult> result = std::visit(
        [this](const auto& each) -> std::optional<CommandResult> {
          if constexpr (requires { perform(each); }) return perform(each);
          return std::nullopt;
        },
        *task);
    if (!enter(Phase::kChanging)) return;
    const AnswerCommand* const answer = answer_of(*task);
    if (result && answer != nullptr && *answer) (*answer)(*result);
  }
}

std::optional<CommandResult> SceneThread::execute(const Command& command, bool is_own,
                                                  const CompleteChanges& complete) {
  return commander_.execute(
      command, is_own, [this] { return enter(Phase::kChanging); }, complete);
}

std::optional<CommandResult> SceneThread::perform(const GivenCommand& given) {
  return execute(given.command, given.is_own, {});
}

// A message of another program may have any size.
std::optional<CommandResult> SceneThread::perform(const MadeCommand& made) {
  Command command;
  try {
    command = made.make(commander_.cell(),
                        [this](const std::string& name) { return commander_.present_pose(name); });
  } catch (const std::exception& error) {
    return CommandResult{.status = CommandStatus::kFailed, .reason = error.what()};
  }
  if (command.changes.empty()) return std::nullopt;
  return execute(command, true, made.complete);
}

std::optional<CommandResult> SceneThread::perform(const KeptFiles& files) {
  try {
    return commander_.keep_files(files.make(commander_.cell()));
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
