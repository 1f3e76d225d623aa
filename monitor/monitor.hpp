// The tick: poses in, report out. Knows neither DDS nor a clock; the daemon, the offline replay and
// the tests all drive this one function.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "config/scene/scene.hpp"
#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/report.hpp"
#include "monitor/swept/swept_bounds.hpp"

namespace clearance {

struct InputAge {
  std::int64_t age_ns = -1;     // now - stamp, never negative; 0 for a fixed object, -1: never seen
  bool stale = false;           // older than the object's limit, or contradicted
  bool contradicted = false;    // by what came since and the object or joint cannot have
  bool follows_joints = false;  // a link whose pose follows from joints: its age is theirs
  // PoseSample::source of who sends it, and of the last other one that was refused for that.
  std::uint32_t source = kNoSource, other_source = kNoSource;
};

struct MonitorOptions {
  unsigned workers = 1;  // threads that evaluate pairs, the one that calls tick() included
  std::function<void()> on_worker_start = {};  // runs first in each of the others
};

class Monitor {
 public:
  // Allocates all it will ever need. The scene must outlive the monitor.
  explicit Monitor(const Scene& scene, const MonitorOptions& options = {});
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  // One cycle: takes in the samples in the given order, those of joints first (refused ones are
  // counted, never used), moves the objects, carries every bound forward, evaluates what is due
  // within the budget, updates zones. The report stays valid until the next tick. Allocates, throws
  // and locks nothing; same inputs, same bits, with one worker or several.
  const Report& tick(std::span<const PoseSample> samples, std::span<const JointSample> joints,
                     const TickTime& time) noexcept;
  // Of a cell without robots.
  const Report& tick(std::span<const PoseSample> samples, const TickTime& time) noexcept {
    return tick(samples, {}, time);
  }

  // Counts a sample that was refused before it came here (a batch made for another scene). In the
  // report from the next tick on; an object that the scene does not have counts in the totals only.
  void refuse(std::uint32_t object, Reject cause) noexcept;

  // Any pair as of the last tick, whether it is published or not; all unknown before the first.
  [[nodiscard]] PairReport pair(std::uint32_t pair) const noexcept;

  // How near a pair came between the last two ticks: PairReport::swept_lower, and where that is
  // below `level`, m, looked at closer until it is decided, whatever that takes. Changes nothing.
  [[nodiscard]] SweptBounds sweep(std::uint32_t pair, double level) const noexcept;

  // How old an object's pose was at the last tick.
  [[nodiscard]] InputAge input_age(std::uint32_t object) const noexcept;

  // The same of a joint's variable.
  [[nodiscard]] InputAge joint_age(std::uint32_t variable) const noexcept;

  // Refused samples of one variable, by cause.
  [[nodiscard]] const std::array<std::uint64_t, kRejects>& rejected_joints(
      std::uint32_t variable) const noexcept;

  // Refused samples of one object, by cause (for the health topic).
  [[nodiscard]] const std::array<std::uint64_t, kRejects>& rejected(
      std::uint32_t object) const noexcept;

  // World from object: the pose in use, meaningless of a moving object that was never seen.
  [[nodiscard]] const Pose& pose(std::uint32_t object) const noexcept;

  // Stamp of the pose in use; 0: fixed, or never seen.
  [[nodiscard]] std::int64_t stamp_ns(std::uint32_t object) const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clearance
