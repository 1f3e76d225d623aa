// Statistics of the tick thread, which the health topic publishes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// The smallest distance that any report has shown.
struct MinimumSeen {
  bool known = false;
  PairReport pair;
  std::uint64_t cycle = 0;
  std::int64_t now_ns = 0;
};

[[nodiscard]] inline bool is_less(const MinimumSeen& a, const MinimumSeen& b) noexcept {
  return a.known && (!b.known || a.pair.distance < b.pair.distance);
}

// The figures that a change of the scene leaves as they are. All are since the start unless they
// say otherwise.
struct RunStatistics {
  std::uint64_t cycle = 0;
  std::int64_t now_ns = 0;
  std::uint64_t clock_steps = 0;        // steps of CLOCK_REALTIME,
  std::int64_t clock_offset_ns = 0;     // and their sum: TickTime
  Histogram tick;                       // from the wake-up to the handing over of the report
  Histogram wakeup;                     // delays of the tick thread's wake-ups
  std::int64_t tick_second_max_ns = 0;  // since the previous statistics
  std::int64_t wakeup_second_max_ns = 0;
  std::uint64_t overruns = 0;                            // ticks that ended after the next deadline
  std::uint64_t skipped_cycles = 0;                      // deadlines that passed without a tick
  std::uint64_t late_responses = 0;                      // ticks: Monitor::response_is_late()
  std::array<std::uint64_t, kRejects> rejected_total{};  // unknown ids included
  std::array<SourceName, kMaxSources> sources;           // by number: InputAge::source
};

// These figures are since the scene was last changed.
struct LoopStatistics : RunStatistics {
  static constexpr std::int64_t kPeriodNs = 1'000'000'000;  // of their messages

  LoopStatistics() = default;
  // Has its final size: filling or copying it allocates nothing.
  explicit LoopStatistics(const Scene& scene)
      : rejected(scene.objects.size()),
        ages(scene.objects.size()),
        rejected_joints(scene.variables.size()),
        joint_ages(scene.variables.size()),
        refused_poses(scene.objects.size()),
        refused_positions(scene.variables.size()) {}

  // Continues the counts of the scene before a change.
  void continue_from(const RunStatistics& before) noexcept { RunStatistics::operator=(before); }

  MinimumSeen minimum;
  std::vector<std::array<std::uint64_t, kRejects>> rejected;         // per object, by cause
  std::vector<InputAge> ages;                                        // per object
  std::vector<std::array<std::uint64_t, kRejects>> rejected_joints;  // per variable of a joint
  std::vector<InputAge> joint_ages;                                  // per variable of a joint
  // The last ones, per object and per variable.
  std::vector<RefusedValue> refused_poses, refused_positions;
};

}  // namespace clearance
