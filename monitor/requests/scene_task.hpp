// What the scene thread does, one task after another: commands, and other work that must not meet a
// change of the scene. DDS, SIGHUP, MoveIt's messages and partners all put their tasks here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/edit/cell_editor.hpp"
#include "core/pose.hpp"
#include "monitor/interface/command.hpp"
#include "monitor/loop/request_queue.hpp"

namespace clearance {

// Returns where an object or a link of the scene in force is now, in the world; nothing: its pose
// is not usable.
using AskPose = std::function<std::optional<Pose>(const std::string& name)>;

// Gets the result of a task, in the scene thread. May be empty.
using AnswerCommand = std::function<void(const CommandResult&)>;

// What becomes of a client's command when its turn comes.
enum class CommandTurn : std::uint8_t {
  kDo,
  kDone,       // it was done before, and its change is in force here: it is only answered
  kOfPartner,  // this daemon leads no more: the client is to send it again
};

struct GivenCommand {
  Command command = {};
  // The daemon's own: `client` is not checked, and files may lie anywhere.
  bool is_own = false;
  AnswerCommand answer = {};
  std::uint64_t identity = 0;  // the hash of the client's message; 0: the command came in none
  std::function<CommandTurn()> turn = {};  // is called when its turn comes; empty: it is to be done
};

// A command of the daemon's own that depends on the cell in force when its turn comes.
struct MadeCommand {
  // The tasks of one sender are done in their order. If make() throws PoseIsLate, or the command
  // names meshes that are not read yet, it waits with those that follow, while tasks of others are
  // done. Not empty.
  std::string sender;
  // To be called if it waits: make() will be called again, and the scene may be another one by
  // then. May be empty.
  std::function<void()> put_off = {};
  // A command without changes is not done, and has no result.
  std::function<Command(const Cell& cell, const AskPose& pose)> make = {};
  std::size_t bytes = 0;  // that `make` holds
  // Adds changes that depend on the scene to which the others lead. All are done, or none.
  CompleteChanges complete = {};
  AnswerCommand answer = {};
};

// The files of a command that another daemon does. The result says whether they could be kept.
struct KeptFiles {
  std::function<std::vector<SentFile>(const Cell& cell)> make;
  std::size_t bytes = 0;  // that `make` holds
  AnswerCommand answer = {};
};

struct OtherWork {
  std::function<void()> run;
};

using SceneTask = std::variant<GivenCommand, MadeCommand, KeptFiles, OtherWork>;

// Tasks of the same sender are done in the order in which they came. Empty: it has none.
[[nodiscard]] std::string sender_of(const SceneTask& task);

// Null: the task has no result.
[[nodiscard]] AnswerCommand* answer_of(SceneTask& task) noexcept;

// The bytes of the texts and files that a task holds, roughly.
[[nodiscard]] std::size_t bytes_of(const SceneTask& task);

class SceneQueue : public RequestQueue<SceneTask> {
 public:
  // The number of tasks that may wait, and the bytes of their texts and files.
  static constexpr std::size_t kMost = 64, kMostBytes = 128 << 20;
  SceneQueue() : RequestQueue(kMost, kMostBytes) {}
};

}  // namespace clearance
