// Puts MoveIt's messages into the queue of commands, one after another. Only the leading partner of
// the first share does so. Other daemons get the changed cell from it, and keep the files that it
// names. The leader tells its partner which message or command of a client led to which scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "monitor/app/line_limit.hpp"
#include "monitor/daemon/scene_turns.hpp"
#include "monitor/intake/scene_keeper.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/requests/scene_task.hpp"

namespace clearance {

class MoveItPort {
 public:
  // Puts a command into the queue; returns false if too much waits.
  using Put = std::function<bool(SceneTask)>;
  // A daemon needs this if other daemons hear the messages, too.
  struct Sharing {
    std::function<bool()> leads;              // this daemon, at the moment; empty: it never leads
    std::function<std::uint64_t()> revision;  // of the scene in force
    // Tells the partner of the last changes, and of what is kept between messages. Empty: there is
    // no partner.
    std::function<void(std::span<const DoneSceneChange>, std::span<const std::byte>)> tell = {};
    // The partner has the scene in force here, or is gone: what was done here is not lost any more.
    // Empty: there is no partner.
    std::function<bool()> both_have = {};
  };
  explicit MoveItPort(Put put) : put_(std::move(put)) {}

  // Before the first message.
  void share(Sharing sharing) { sharing_ = std::move(sharing); }

  // Any thread but that of the tick. Nothing is put after close().
  void take(moveit::RawScene message);
  void close();

  // The next six functions do nothing unless the messages are shared. The scene thread calls the
  // first four. coming() announces a revision that comes into force, by this command of a client,
  // or by none (0). ended() follows when the command is answered. took_over() follows when the
  // leader's cell, of this revision there, is in force here. is_done() returns whether this daemon
  // or a former leader has done the command, and its change is in force here.
  void coming(std::uint64_t revision, std::uint64_t command);
  void ended(std::uint64_t command, const CommandResult& result);
  void took_over(std::uint64_t revision);
  [[nodiscard]] bool is_done(std::uint64_t command);
  // The leading partner tells of this. Any thread but that of the tick.
  void hear(const clearance_msg_PartnerScene& scene);
  // Has to be called every few milliseconds, by any thread but that of the tick: this daemon may
  // begin to lead, or have the leader's scene.
  void update_lead();

 private:
  static constexpr std::size_t kMostChanges = 64;  // kMaxSceneChanges in idl/partners.idl
  struct Heard {
    std::vector<DoneSceneChange> changes = {};
    std::vector<std::byte> bytes = {};
    bool is_new = false;  // it was heard since this daemon led
  };

  [[nodiscard]] MadeCommand command(const SceneTurns::Message& message, std::uint64_t identity);
  [[nodiscard]] Command translated(const moveit::RawScene& message, const Cell& cell,
                                   const AskPose& pose);
  void log_refusal(const std::string& topic, const std::string& path, const std::string& reason);
  [[nodiscard]] bool leads() const REQUIRES(mutex_) { return sharing_->leads && sharing_->leads(); }
  void put_waiting() REQUIRES(mutex_);
  void keep_files() REQUIRES(mutex_);
  // In the scene thread.
  [[nodiscard]] bool begins(std::uint64_t identity, std::uint64_t revision);
  void go_on_from_heard(std::uint64_t revision);
  void ended(std::uint64_t identity, std::uint64_t revision);
  void add(const DoneSceneChange& change);
  void note(std::uint64_t identity, std::uint64_t revision);

  LineLimit refusal_lines_{lines::kMoveItLinesLeftOut}, left_out_lines_{lines::kMoveItLinesLeftOut};
  std::optional<Sharing> sharing_;  // none: this daemon applies all messages at once
  Mutex mutex_;
  GUARDED_BY(mutex_) Put put_;  // empty: closed
  GUARDED_BY(mutex_) SceneTurns turns_;
  GUARDED_BY(mutex_) Heard heard_;         // from another leader, the last one
  GUARDED_BY(mutex_) bool leads_ = false;  // when last looked at
  GUARDED_BY(mutex_) bool keeps_ = false;  // a command to keep files waits
  // For the scene thread.
  moveit::SceneKeeper keeper_;
  // The changes that led to the scene in force, by whichever daemon led; then those to come.
  std::vector<DoneSceneChange> changes_;
  std::uint64_t current_ = 0;  // the message whose changes are being made; 0: none
};

}  // namespace clearance
