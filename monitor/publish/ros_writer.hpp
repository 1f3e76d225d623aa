// The output of a cell for ROS 2: the markers, diagnostics, numbers and scenes that the cell asks
// for.
//
// A thread of its own makes and writes them. The thread that reports, mostly that of the tick,
// copies a number in each tick, a report as often as markers are drawn, and statistics once per
// second. It never waits: a full queue loses its newest entry, and the next one replaces it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <thread>

#include "config/cell/cell.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/cell_diagnostics.hpp"
#include "monitor/publish/monitored_scene.hpp"
#include "monitor/publish/ros_writes.hpp"
#include "monitor/tick/spsc_ring.hpp"
#include "monitor/visual/ros_types.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// True when the cell writes anything for ROS 2, except its messages (RosMessages).
[[nodiscard]] bool writes_ros(const Cell& cell) noexcept;

class RosWriter final : public ReportSink {
 public:
  // Returns the health for these statistics. If it returns none, no diagnostics are written. The
  // writer's thread calls it.
  using MakeHealth =
      std::function<std::optional<Sample<clearance_msg_Health>>(const LoopStatistics&)>;

  // Joins the topics that the scene names and starts the thread. The scaling of speeds is left out,
  // with a line in the log, if the cell has no zone. The cell, the participant and what
  // `make_health` refers to must outlive this. Nothing is written while `leads` is false.
  RosWriter(const Cell& cell, Participant& participant, MakeHealth make_health,
            RosWrites::Leads leads = {});
  ~RosWriter() override;
  RosWriter(const RosWriter&) = delete;
  RosWriter& operator=(const RosWriter&) = delete;

  // Tick thread.
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse> sources) noexcept override;
  void statistics(const LoopStatistics& statistics) noexcept override;

  // After the last tick, or when another daemon publishes this cell: nothing more is written.
  void finish();

 private:
  // The numbers of one tick.
  struct Numbers {
    double minimum_distance = 0.0, speed_scaling = 0.0;
  };

  void run();
  void write_numbers();
  void write_markers(const QueuedReport& queued);
  void write_diagnostics(const LoopStatistics& statistics);
  void write_log();

  const Scene& scene_;
  const RosSettings& settings_;
  const MakeHealth make_health_;
  dds_entity_t markers_, diagnostics_, minimum_distance_, speed_scaling_, planning_scene_,
      log_;  // 0: not asked for
  ReportQueue queue_;
  SpscRing<Numbers> numbers_;
  std::int64_t period_ns_,
      next_ns_ = 0;  // tick thread: the time of the next report for this thread
  std::atomic<bool> scene_waits_{false};  // for a report that holds for it

  // Used by the thread only.
  CellDiagnostics cell_diagnostics_;
  Report last_;
  Sample<clearance_msg_Distances> distances_;
  std::optional<Sample<ros::MarkerArray>> bodies_;  // made for the first reader
  bool bodies_due_ = false;                         // a reader has come
  std::int64_t bodies_written_ns_ = 0;
  // The present scene, until the first report holds for it.
  std::optional<Sample<moveit_msgs_msg_dds__PlanningScene_>> unwritten_scene_;
  RosWrites writes_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
