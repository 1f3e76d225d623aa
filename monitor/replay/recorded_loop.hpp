// The daemon's loop again, in one thread: it ticks what the daemon ticked, through every change of
// its scene.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/replay/frame_map.hpp"
#include "monitor/replay/moveit_changes.hpp"
#include "monitor/replay/scene_history.hpp"
#include "monitor/replay/tick_feed.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/tick/tick_state.hpp"

namespace clearance {

// A daemon changes its scene in two steps, and a recording has the cycles of both (SceneInForce).
// After the first one, the monitor of the changed scene takes over what the running one knows, and
// both run the same ticks. From the second one on, the changed scene is the one that is reported.
class RecordedLoop {
 public:
  // The history must outlive this, and `moveit`, too. It is null unless messages of MoveIt in a log
  // change the scene. A message changes it as a command does that the daemon gets between this tick
  // and the next.
  explicit RecordedLoop(SceneHistory& history, MoveItChanges* moveit = nullptr);

  // Null, and error() says why: the cell of a change cannot be read. The report is valid until the
  // next call.
  [[nodiscard]] const Report* tick(const TickInput& input);
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // The frames of the cell's sensors so far; null: it has none.
  [[nodiscard]] const Sensors* sensors() const noexcept { return sensors_.get(); }

  // The cell of the last tick, and the monitor that ran it.
  [[nodiscard]] const Cell& cell() const noexcept { return *cell_; }
  [[nodiscard]] const Monitor& monitor() const noexcept { return state_->monitor(); }
  // Since when that cell is in force, in the cycles of this replay.
  [[nodiscard]] SceneInForce since() const noexcept { return since_; }
  // Says on what the daemon's last tick rested and this one did not; null: on nothing.
  // A batch may be missing that was made for a scene before the recording began. Another build
  // cannot use the state of a partner, and a replay with another cell cannot either.
  [[nodiscard]] const char* missing() const noexcept;
  static constexpr const char* kPosesMissing = "poses that this tick used are not in the recording";
  // The number of batches that were made for no scene that is known.
  [[nodiscard]] std::uint64_t of_other_scenes() const noexcept { return of_other_scenes_; }

 private:
  // The changed scene, while another one is still reported.
  struct Next {
    const Cell* cell;
    std::uint64_t from;  // the daemon's cycle
    Successor successor;
  };

  void start(const Cell& cell, bool followed);
  void begin_with(const clearance_msg_Distances& report);
  void join(const TickInput& input);
  void use(const PoseBatch& batch);
  void take_frames(const TickInput& input);
  void rebuild_frames(const TickInput& input);
  [[nodiscard]] std::optional<BuiltFrame> translated(const BuiltFrame& frame);
  void exchange_frames_of(const Cell& cell);
  void restart(const clearance_msg_Distances& report);
  [[nodiscard]] bool begin(const DescribedScene& change);
  [[nodiscard]] bool begin(const Cell& cell, std::uint64_t from);
  [[nodiscard]] bool follow_moveit(const TickInput& input);
  void succeed();
  [[nodiscard]] bool change_before(const clearance_msg_Distances& report);
  [[nodiscard]] bool change_after(const clearance_msg_Distances& report);

  SceneHistory& history_;
  MoveItChanges* moveit_;
  const Cell* cell_ = nullptr;
  std::unique_ptr<Sensors> sensors_;
  std::optional<FrameNames> names_;  // of recorded frames
  std::unique_ptr<FrameExchange> frames_;
  std::map<std::uint64_t, std::optional<FrameMap>> frame_maps_;  // by the recorded revision
  std::unique_ptr<TickState> state_;
  TickRecords records_{TickRecords::kNoRoom};
  std::unique_ptr<Next> next_;
  SceneInForce since_;
  bool begun_ = false;
  std::uint64_t from_ = 0;  // changes up to this cycle of the daemon are made, or were before
  std::set<std::string> unclear_;  // sources whose last batch is of an unknown scene
  std::set<std::uint32_t> blind_;  // sensors whose frame in use is not in the recording
  std::uint64_t joined_ = 0;       // TickInput::joined of the last one
  bool lacks_state_ = false;       // the last one of them could not be used
  std::uint64_t of_other_scenes_ = 0;
  std::string error_;
};

}  // namespace clearance
