// What passes from one tick to the next: the scene in force, its monitor, the ids of its inputs,
// the frames of sensors, and the successor of a changed scene while it catches up.
//
// The live loop (monitor/loop), the replay of its recording (monitor/replay) and the tests of
// partners tick this one class. So a replay that is told when scenes and states changed gets the
// same bits.
//
//   between two ticks    begin(), succeed(), give_up(); join()
//   inputs               use(), FrameExchange::put()
//   the tick             tick(), then clear()
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/tick/frame_exchange.hpp"
#include "monitor/tick/joined_state.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/successor.hpp"
#include "monitor/tick/tick_pace.hpp"

namespace clearance {

struct TickStateOptions {
  std::size_t room = 0;             // for the samples of a tick; more of them are allocated
  FrameExchange* frames = nullptr;  // of sensors; null: there are none
  TickPace* pace = nullptr;         // null: no partner
  bool followed = false;            // the scene followed others, which are not known
};

// One thread at a time, that of the tick, except where another one is named. What it calls neither
// throws nor locks, and does not allocate within the room.
class TickState {
 public:
  // Allocates the monitor. Everything given must outlive this.
  explicit TickState(const Scene& scene, const TickStateOptions& options = {});

  // The scene in force and its monitor. A thread that prepares a successor may use both while
  // another one ticks, but not while the scene changes.
  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] const Monitor& monitor() const noexcept { return *monitor_; }
  [[nodiscard]] Monitor& monitor() noexcept { return *monitor_; }
  // The ids of the scene in force. Former scenes, but not the numbers of sources, may be read as
  // the monitor.
  [[nodiscard]] const SceneIds& ids() const noexcept { return ids_; }
  [[nodiscard]] SceneIds& ids() noexcept { return ids_; }
  // The number of the last tick.
  [[nodiscard]] std::uint64_t cycle() const noexcept { return monitor_->cycle(); }

  // The next tick uses the samples of this batch. False: it is of no scene that is known, and is
  // not used.
  [[nodiscard]] bool use(const PoseBatch& batch) noexcept {
    return ids_.append(batch, samples_, joints_);
  }
  [[nodiscard]] std::span<const PoseSample> samples() const noexcept { return samples_; }
  [[nodiscard]] std::span<const JointSample> joints() const noexcept { return joints_; }

  // With a pace: decides on the next tick, and sleeps until it is due. Returns its deadline.
  [[nodiscard]] std::int64_t decide(std::int64_t deadline) noexcept {
    return pace_->decide(deadline, cycle() + 1, scene_->revision);
  }
  // Runs the tick with all that was used since clear(), and the frames of sensors that the pace has
  // chosen, or without a pace the newest ones. With a pace, `time` is its time().
  const Report& tick(const TickTime& time) noexcept;
  // The frames that the tick was shown.
  [[nodiscard]] std::span<const ShownFrame> shown() const noexcept {
    return frames_ == nullptr ? std::span<const ShownFrame>() : frames_->shown();
  }
  // Forgets the inputs of the tick. To be called after each one.
  void clear() noexcept;

  // A successor of the scene begins with the state after the last tick, and gets the ticks that
  // follow. Returns false if both scenes name too many sources: it must then be given up.
  bool begin(Successor& next) noexcept;
  // The successor has run all ticks: from the next one on, it is the one that ticks.
  void succeed() noexcept;
  // The successor gets no more ticks.
  void give_up() noexcept;
  // The one that has begun; null: there is none.
  [[nodiscard]] const Successor* successor() const noexcept { return next_; }

  // True if join() may take over this state now: it is of the scene in force, no successor has
  // begun, the pace agrees, and the frames of sensors that the state rests on have come.
  [[nodiscard]] bool may_join(const JoinedState& joined) const noexcept;
  // The next tick goes on from this state, which must be of the scene in force, while no successor
  // has begun. Frames that it rests on and that have not come stay awaited
  // (Monitor::awaited_frame).
  void join(JoinedState& joined) noexcept;

  // True if the cloud is that of a frame that waits or is in use.
  [[nodiscard]] bool uses(const SeenCloud* cloud) const noexcept;
  // Frames of sensors come through this one from now on.
  void exchange_frames(FrameExchange* frames) noexcept { frames_ = frames; }

 private:
  const Scene* scene_;
  std::unique_ptr<Monitor> monitor_;
  SceneIds ids_;
  Successor* next_ = nullptr;
  FrameExchange* frames_;
  TickPace* pace_;
  std::vector<PoseSample> samples_;
  std::vector<JointSample> joints_;
};

}  // namespace clearance
