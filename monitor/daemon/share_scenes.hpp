// One scene for a cell in shares that takes MoveIt's messages: the daemon of the first share
// applies the messages, and those of all others take over its scene. So all make the same changes
// in the same order, whatever messages each of them got, and when. Without a daemon of the first
// share no lists of bodies are applied, and all persons are unknown.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/checked_reader.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/requests/scene_task.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Decides whose scene a daemon takes over, by what the daemons of other shares say of theirs. One
// thread uses this, with times of one steady clock.
//  - A daemon of the first share that has changed nothing since its start takes the scene that most
//    others have changed to: it was away while they did. After that it takes none.
//  - Any other daemon follows a daemon of the first share with which it has agreed once. Before it
//    has agreed with any, it follows whichever it hears. A restarted daemon of the first share may
//    have lost the scene. A share that has agreed before does not follow it until it has that scene
//    again.
class SceneToFollow {
 public:
  struct Told {
    std::uint64_t daemon = 0;    // 0: nothing was heard
    std::uint64_t revision = 0;  // of the scene in force there
    bool has_changed = false;    // it is not the one with which that daemon began
  };
  // `own`: index of this daemon's share among `shares`.
  SceneToFollow(std::uint32_t own, std::size_t shares, std::int64_t now_ns)
      : own_(own), told_(shares), start_ns_(now_ns) {}

  void hear(std::size_t share, const Told& told) { told_[share] = told; }
  // Returns the share whose scene this daemon is to take over now, if any. A new scene of another
  // share is returned at once, but to the first share after 200 ms. After a change of this daemon's
  // own scene, it is returned after a second. While the scenes differ, it is returned again every
  // second. `in_force` is the revision here. `has_changed`: this daemon did not begin with it.
  [[nodiscard]] std::optional<std::size_t> find(std::uint64_t in_force, bool has_changed,
                                                std::int64_t now_ns);
  // True once the first share may apply messages. It then has no scene to take over, and has heard
  // all others or has run for a second. After 3 s it is true in any case.
  [[nodiscard]] bool is_settled() const noexcept { return is_settled_; }

 private:
  [[nodiscard]] std::optional<std::size_t> share_that_counts(std::uint64_t in_force,
                                                             bool has_changed);

  const std::uint32_t own_;
  std::vector<Told> told_;          // by share
  std::set<std::uint64_t> agreed_;  // daemons of the first share
  const std::int64_t start_ns_;
  std::uint64_t theirs_ = 0, ours_ = 0;  // the revisions that were compared last
  std::int64_t due_ns_ = 0;              // when they are to be equal
  bool is_settled_ = false;
};

// On DDS: reads the catalogues of other shares in a thread of its own.
class ShareScenes {
 public:
  struct Actions {
    std::function<bool(SceneTask)> put;       // the entry for changes of the cell
    std::function<std::uint64_t()> revision;  // of the scene in force
    std::function<bool()> changes;            // false: a partner makes the changes of this share
    std::function<void()> update_lead;        // every 10 ms
  };
  // The cell is that of one share. The participant must outlive this. Throws DdsError.
  ShareScenes(const Cell& cell, Participant& participant, Actions actions);
  ~ShareScenes();
  ShareScenes(const ShareScenes&) = delete;
  ShareScenes& operator=(const ShareScenes&) = delete;

  void start();
  void stop();

  // Any thread. The scene in force is not the one with which this daemon began.
  void note_change() noexcept { has_changed_ = true; }
  [[nodiscard]] bool is_first() const noexcept { return own_ == 0; }
  // The name of the first share.
  [[nodiscard]] const std::string& first() const noexcept { return names_.front(); }
  // This daemon applies MoveIt's messages.
  [[nodiscard]] bool does_messages() const noexcept { return does_messages_; }

 private:
  // The catalogues of one share; the last of them.
  struct Heard {
    std::size_t share;
    client::CheckedReader reader;
    Sample<clearance_msg_Catalogue> last = {};
    std::uint64_t next_told = 1;  // the number of refused messages at which the log says so again
  };
  struct Wanted {
    std::size_t share = 0;
    std::uint64_t revision = 0;
    std::string text = {};
  };
  void run();
  void hear();
  void look_for_first(std::int64_t now_ns);
  void note_told(const Heard& heard);
  void take_over(const Heard& heard);
  [[nodiscard]] MadeCommand command();

  const std::uint32_t own_;
  const std::vector<std::string> names_;
  const bool follows_bodies_;
  const Actions actions_;
  std::int64_t first_alive_ns_, unknown_ns_ = 0;  // CLOCK_MONOTONIC
  std::atomic<bool> is_alone_{false};             // no daemon of the first share has been there
  std::vector<Heard> heard_;
  Sample<clearance_msg_Catalogue> taken_;
  SceneToFollow to_follow_;
  std::unique_ptr<DataWait> wait_;
  Mutex mutex_;
  GUARDED_BY(mutex_) Wanted wanted_;  // the scene that a queued command takes over
  GUARDED_BY(mutex_) bool is_queued_ = false;
  std::uint64_t refused_ = 0;  // the last scene that was refused; for the scene thread
  std::atomic<bool> has_changed_{false}, does_messages_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace clearance
