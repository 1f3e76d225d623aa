// The thread that does the tasks of its queue, one after another. A task that has to wait, for
// meshes that a thread of its own reads or for a pose, lets those of other senders overtake.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "monitor/interface/mutex.hpp"
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

  // Only the scene thread may call this. Returns the identity of the command in progress; 0: none.
  [[nodiscard]] std::uint64_t in_hand() const noexcept { return in_hand_; }

  // Once `loop_ended` is set: drops what waits, and waits for the change that is in progress.
  // Returns false if a cell is still being read, which may take long. The thread then goes on, and
  // the program must end without destroying this or anything that the thread uses.
  bool end();

 private:
  enum class Phase { kReading, kChanging, kEnded };
  // What a thread of its own has read; it may outlive this.
  struct Reading {
    std::atomic<bool> is_done = false;
    std::shared_ptr<const ReadMeshes> meshes;
  };
  // Holds the tasks of one sender. The first one waits for a reading, or until `again`.
  struct Lane {
    std::deque<SceneTask> tasks;
    std::chrono::steady_clock::time_point again;
    std::shared_ptr<Reading> reading;  // null: none
  };
  void run();
  std::optional<SceneTask> next();
  [[nodiscard]] std::optional<SceneTask> next_of_lanes();
  // Returns false after end().
  bool perform(SceneTask task);
  void wait(SceneTask task);
  // Each returns the result; nothing: there is none.
  std::optional<CommandResult> result_of(const GivenCommand& given);
  std::optional<CommandResult> result_of(const MadeCommand& made);
  std::optional<CommandResult> result_of(const KeptFiles& files);
  std::optional<CommandResult> execute(const Command& command, bool is_own,
                                       const CompleteChanges& complete);
  // Returns false after end(); then nothing may be read any more.
  bool enter(Phase phase);

  SceneQueue queue_;
  SceneCommander commander_;
  std::map<std::string, Lane> lanes_;  // by sender
  bool has_to_wait_ = false;           // the task in hand
  std::uint64_t in_hand_ = 0;
  std::shared_ptr<std::atomic<int>> readings_ = std::make_shared<std::atomic<int>>(0);
  Mutex mutex_;
  // kReading: the thread may take long, and changes nothing.
  GUARDED_BY(mutex_) Phase phase_ = Phase::kChanging;
  GUARDED_BY(mutex_) bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace clearance
