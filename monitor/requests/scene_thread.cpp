#include "monitor/requests/scene_thread.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>
#include <variant>

#include "config/text/sentences.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/tick/present_body.hpp"

namespace clearance {
namespace {

// How long a task that waits for a pose waits until it is tried again, and how soon one whose
// meshes were read goes on.
constexpr std::chrono::milliseconds kPatience{5};

}  // namespace

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
  while (auto task = next()) {
    if (!perform(*std::move(task))) return;
  }
}

// The tasks of senders that wait do not overtake each other.
std::optional<SceneTask> SceneThread::next() {
  while (true) {
    if (auto task = next_of_lanes()) return task;
    auto task = lanes_.empty() ? queue_.next() : queue_.next_within(kPatience);
    if (!task && queue_.is_closed()) return std::nullopt;
    if (!task) continue;
    const auto lane = lanes_.find(sender_of(*task));
    if (lane == lanes_.end()) return task;
    if (lane->second.tasks.size() < SceneQueue::kMost) {
      lane->second.tasks.push_back(*std::move(task));
      continue;
    }
    const AnswerCommand* const answer = answer_of(*task);
    if (answer != nullptr && *answer) {
      (*answer)({.status = CommandStatus::kBusy,
                 .reason = fmt::format("{} of this sender wait already; expected fewer",
                                       counted(SceneQueue::kMost, "command"))});
    }
  }
}

std::optional<SceneTask> SceneThread::next_of_lanes() {
  for (auto& [sender, lane] : lanes_) {
    const bool waits =
        lane.reading ? !lane.reading->is_done : std::chrono::steady_clock::now() < lane.again;
    if (waits) continue;
    commander_.set_read_meshes(lane.reading ? lane.reading->meshes : nullptr);
    lane.reading.reset();
    SceneTask task = std::move(lane.tasks.front());
    lane.tasks.pop_front();
    return task;
  }
  commander_.set_read_meshes(nullptr);
  return std::nullopt;
}

bool SceneThread::perform(SceneTask task) {
  if (const auto* const work = std::get_if<OtherWork>(&task)) {
    work->run();
    return true;
  }
  if (!enter(Phase::kReading)) return false;
  has_to_wait_ = false;
  const std::optional<CommandResult> result = std::visit(
      [this](const auto& each) -> std::optional<CommandResult> {
        if constexpr (requires { result_of(each); }) return result_of(each);
        return std::nullopt;
      },
      task);
  if (!enter(Phase::kChanging)) return false;
  if (has_to_wait_) {
    wait(std::move(task));
    return true;
  }
  const auto lane = lanes_.find(sender_of(task));
  if (lane != lanes_.end() && lane->second.tasks.empty()) lanes_.erase(lane);
  const AnswerCommand* const answer = answer_of(task);
  if (result && answer != nullptr && *answer) (*answer)(*result);
  return true;
}

// Gives each reading a thread that nothing waits for, since a disk may never answer.
void SceneThread::wait(SceneTask task) {
  Lane& lane = lanes_[sender_of(task)];
  lane.tasks.push_front(std::move(task));
  lane.again = std::chrono::steady_clock::now() + kPatience;
  if (commander_.wanted().empty()) return;
  lane.reading = std::make_shared<Reading>();
  ++*readings_;
  std::thread([reading = lane.reading, count = readings_, read = commander_.reader_of_wanted()] {
    name_thread("meshes");
    try {
      reading->meshes = read();
    } catch (const std::exception&) {
      // The scene thread then reads them itself, and says why that fails.
    }
    reading->is_done = true;
    --*count;
  }).detach();
}

std::optional<CommandResult> SceneThread::execute(const Command& command, bool is_own,
                                                  const CompleteChanges& complete) {
  CommandResult result = commander_.execute(
      command, is_own, [this] { return enter(Phase::kChanging); }, complete);
  has_to_wait_ = !commander_.wanted().empty();
  return result;
}

std::optional<CommandResult> SceneThread::result_of(const GivenCommand& given) {
  const Command& command = given.command;
  switch (given.turn ? given.turn() : CommandTurn::kDo) {
    case CommandTurn::kDo:
      break;
    case CommandTurn::kDone:
      return execute({.client = command.client, .request = command.request}, given.is_own, {});
    case CommandTurn::kOfPartner:
      return CommandResult{.client = command.client,
                           .request = command.request,
                           .status = CommandStatus::kBusy,
                           .reason =
                               "found that the partner leads; expected that the same command "
                               "is sent again"};
  }
  in_hand_ = given.identity;
  std::optional<CommandResult> result = execute(command, given.is_own, {});
  in_hand_ = 0;
  return result;
}

// A message of another program may have any size.
std::optional<CommandResult> SceneThread::result_of(const MadeCommand& made) {
  Command command;
  try {
    command = made.make(commander_.cell(), [&](const std::string& name) -> std::optional<Pose> {
      const auto pose = commander_.present_pose(name);
      if (!pose) return std::nullopt;
      return pose_or_late(name, commander_.cell().scene, *pose);
    });
  } catch (const PoseIsLate&) {
    if (made.put_off) made.put_off();
    has_to_wait_ = true;
    return std::nullopt;
  } catch (const std::exception& error) {
    return CommandResult{.status = CommandStatus::kFailed, .reason = error.what()};
  }
  if (command.changes.empty()) return std::nullopt;
  std::optional<CommandResult> result = execute(command, true, made.complete);
  if (has_to_wait_ && made.put_off) made.put_off();
  return result;
}

std::optional<CommandResult> SceneThread::result_of(const KeptFiles& files) {
  try {
    return commander_.keep_files(files.make(commander_.cell()));
  } catch (const std::exception& error) {
    return CommandResult{.status = CommandStatus::kFailed, .reason = error.what()};
  }
}

bool SceneThread::enter(Phase phase) {
  const Lock lock(mutex_);
  if (phase_ == Phase::kEnded || (is_ending_ && phase == Phase::kReading)) return false;
  phase_ = phase;
  return true;
}

bool SceneThread::end() {
  queue_.close();
  bool is_reading = false;
  {
    const Lock lock(mutex_);
    is_ending_ = true;
    is_reading = phase_ == Phase::kReading;
    if (is_reading) phase_ = Phase::kEnded;
  }
  if (is_reading && thread_.joinable()) {
    thread_.detach();
    return false;
  }
  if (thread_.joinable()) thread_.join();
  return *readings_ == 0;
}

}  // namespace clearance
