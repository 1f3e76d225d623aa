// The tick: poses in, report out. It knows neither DDS nor a clock; the daemon, the offline replay
// and the tests all drive this one function.
#pragma once

#include <cstdint>
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
  // now - stamp, never negative; 0 for a fixed object; -1: nothing is in use.
  std::int64_t age_ns = -1;
  bool stale = false;           // older than the object's limit, or contradicted
  bool contradicted = false;    // by later samples, which the object or joint cannot have reached
  bool follows_joints = false;  // a link whose pose follows from joints: its age is theirs
  bool absent = false;          // Monitor::set_absent
  // PoseSample::source of the owner, and of the last other source that was refused for that.
  std::uint32_t source = kNoSource, other_source = kNoSource;
};

class Monitor {
 public:
  // Allocates all it will ever need. The scene must outlive the monitor.
  explicit Monitor(const Scene& scene);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  // One cycle: takes in the samples in the given order, those of joints first (refused ones are
  // counted, never used), moves the objects, carries bounds forward, evaluates pairs within the
  // budget, updates zones. The report stays valid until the next tick. Allocates, throws and locks
  // nothing; the same inputs give the same bits.
  const Report& tick(std::span<const PoseSample> samples, std::span<const JointSample> joints,
                     const TickTime& time) noexcept;
  // For a cell without robots.
  const Report& tick(std::span<const PoseSample> samples, const TickTime& time) noexcept {
    return tick(samples, {}, time);
  }

  // Counts a sample that was refused before it came here (a batch made for another scene), in the
  // report from the next tick on. An object that the scene does not have counts in the totals only.
  void refuse(std::uint32_t object, Reject cause) noexcept;

  // Between ticks: from the next tick on, a moving object is known not to be there, or is there
  // again. An absent object has no pose, and samples of it are refused as of an unknown object. Its
  // pairs are kAbsent: they rest on no input, make no zone active, and are left out of the minimum.
  // When it is present again nothing from before its absence is trusted: its pairs are unknown
  // until its next pose. False: the scene has no such object, or it is fixed. Time grows with its
  // pairs.
  bool set_absent(std::uint32_t object, bool absent) noexcept;

  // Any pair as of the last tick, whether it is published or not; all unknown before the first.
  [[nodiscard]] PairReport pair(std::uint32_t pair) const noexcept;

  // Bounds of a pair's distance between the last two ticks: PairReport::swept_lower, and where that
  // is below `level`, m, a closer search until it is decided, without a budget. Changes nothing.
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

  // World from object: the pose in use; meaningless where none is (input_age() is -1).
  [[nodiscard]] const Pose& pose(std::uint32_t object) const noexcept;

  // Stamp of the pose in use; 0: the object is fixed, or no pose is in use.
  [[nodiscard]] std::int64_t stamp_ns(std::uint32_t object) const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clearance
