// The thread that does the tasks of its queue, one after another.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "monitor/requests/scene_commander.hpp"
#include "monitor/requests/scene_task.hpp"

namespace clearance {

class SceneThread {
 public:
  SceneThread(SceneChanger& changer, TickLoop& loop, const std::atomic<bool>& loop_ended,
              CommanderOptions options)
      : commander_(changer, loop, loop_ended, std::move(options)) {}
  ~SceneThread();
  SceneThread(const SceneThread&) = delete;
  SceneThread& operator=(const SceneThread&) = delete;

  void start();
  // Any thread but that of the tick: the one entry for tasks. Returns false if too much waits,
  // or after end(). Otherwise the answer comes, unless the program ends.
  [[nodiscard]] bool put(SceneTask task) { return queue_.put(std::move(task)); }

  // Once `loop_ended` is set: drops what waits, and waits for the change that is in progress.
  // Returns false if a cell is still being read, which may take long. The thread then goes on, and
  // the program must end without destroying this or anything that the thread uses.
  bool end();

 private:
  enum class Phase { kReading, kChanging, kEnded };
  void run();
  // Each returns the result; nothing: there is none.
  std::optional<CommandResult> perform(const GivenCommand& given);
  std::optional<CommandResult> perform(const MadeCommand& made);
  std::optional<CommandResult> perform(const KeptFiles& files);
  std::optional<CommandResult> execute(const Command& command, bool is_own,
                                       const CompleteChanges& complete);
  // Returns false after end(); then nothing may be read any more.
  bool enter(Phase phase);

  SceneQueue queue_;
  SceneCommander commander_;
  std::mutex mutex_;
  Phase phase_ = Phase::kChanging;  // kReading: the thread may take long, and changes nothing
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace clearance
