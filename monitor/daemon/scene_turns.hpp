// MoveIt's messages that two partners hear, and that the leading one does. The other one keeps them
// until it has the scene to which they lead, and does those that are left when it leads itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "monitor/intake/scene_keeper.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// A change of the leader's scene: `message` is a RawScene::identity().
using DoneSceneChange = clearance_msg_SceneChange;

// The changes up to the last one that led to a scene of this revision. None: no change did.
[[nodiscard]] std::span<const DoneSceneChange> changes_until(
    std::span<const DoneSceneChange> changes, std::uint64_t revision);
[[nodiscard]] bool has_message(std::span<const DoneSceneChange> changes, std::uint64_t message);

// To be used by one thread at a time.
class SceneTurns {
 public:
  using Message = std::shared_ptr<const moveit::RawScene>;
  // Limits of the messages that wait: if one is exceeded, the oldest message goes.
  static constexpr std::size_t kMost = 256, kMostBytes = 128 << 20;

  // A message came. Returns how many others had to go.
  std::size_t add(Message message, std::uint64_t identity);
  // The next message that is not yet in the queue of commands, in order; null: all are. It counts
  // as put there.
  [[nodiscard]] Message to_queue(std::uint64_t& identity);
  // The message's turn in that queue has come. False: it is not to be done now, and counts as not
  // put there, because another one has to come before it.
  [[nodiscard]] bool begins(std::uint64_t identity);
  // The message could not be put into the queue, or its turn came while this daemon does not lead.
  void put_back(std::uint64_t identity);
  // The messages whose files are to be kept, each once.
  [[nodiscard]] std::vector<Message> to_keep();
  [[nodiscard]] bool has_to_keep() const noexcept;
  // The message is done, or refused. It may be wanted again: see go_on_from().
  void end(std::uint64_t identity, bool may_be_wanted = false);
  // Another leader's cell is in force here, and these changes led to it. What was done here and is
  // not among them was lost with the cell before, and has to be done again.
  void go_on_from(std::span<const DoneSceneChange> changes);
  // Both daemons have the scene to which the messages that are done have led.
  void forget_done();
  // Drops what another leader has done, if the scene in force is of this revision: its messages up
  // to the last change that led to it, and what came before those here.
  void drop_done(std::span<const DoneSceneChange> changes, std::uint64_t revision);

  [[nodiscard]] std::size_t waiting() const noexcept;

 private:
  struct Turn {
    Message message;
    std::uint64_t identity = 0;
    bool is_queued = false, is_kept = false, is_done = false;
  };
  [[nodiscard]] Turn* find(std::uint64_t identity) noexcept;  // not among those that are done
  void drop_first();
  template <class Of>
  void erase_if(const Of& of);

  std::deque<Turn> turns_;  // in the order in which they came
  std::size_t bytes_ = 0;
};

}  // namespace clearance
