// Creates the ports, the queues and the loop in the order of their dependencies. Runs the loop in a
// thread of its own, and empties the queues after the last tick. Scheduling is set before the
// threads that inherit it are created.
#include "monitor/daemon/daemon.hpp"

#include <algorithm>

#include "monitor/app/log_lines.hpp"
#include "monitor/intake/tracked_frames.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"

namespace clearance {
namespace {

// 64 ms of reports at 1 kHz; DDS writes seldom take longer.
constexpr std::size_t kQueuedReports = 64;
// The number of full-size batches that one tick takes in; more wait for the next tick.
constexpr std::size_t kBatchesATick = 64;
// The largest delay with which the end after --ticks is noticed.
constexpr std::int64_t kSignalPollMs = 50;

// The text of a Refusal says how to get what was refused.
void log_refusal(const Refusal& refusal) {
  if (refusal) log_line(lines::kSystemRefuses, *refusal);
}

// Cyclone's threads and ours inherit the scheduling of the thread that makes them, so this runs
// first.
DdsOptions prepare_threads(const DaemonOptions& options) {
  use_precise_timers();
  if (options.fifo_priority > 0) {
    log_refusal(use_fifo_scheduling(std::max(1, options.fifo_priority - 1)));
  }
  return options.dds;
}

std::unique_ptr<Recording> open_recording(const Cell& cell, const DaemonOptions& options,
                                          const PoseReader& poses, RecordingHealth& health) {
  if (options.record_file.empty()) return nullptr;
  return std::make_unique<Recording>(options.record_file, options.recording, cell, poses, health);
}

std::unique_ptr<RosWriter> open_ros(const Cell& cell, Participant& participant,
                                    const PoseReader& poses, const ReportQueue& published,
                                    const RecordingHealth& health) {
  if (!writes_ros(cell)) return nullptr;
  return std::make_unique<RosWriter>(cell, participant, poses, published, health);
}

// ROS 2 knows the default partition only.
void warn_of_partition(const Cell& cell, const DdsOptions& options) {
  const bool wants_ros = writes_ros(cell) || TrackedFrames(cell).any();
  if (options.partition.empty() || !wants_ros) return;
  log_line(lines::kPartitionWithoutRos, options.partition);
}

}  // namespace

// Members are made in the order of their dependencies: ports before the loop that uses them.
Daemon::Daemon(const Cell& cell, const DaemonOptions& options)
    : cell_(cell),
      scene_(cell.scene),
      options_(options),
      participant_(prepare_threads(options)),
      poses_(cell, participant_),
      publish_queue_(cell.scene, {.reports = kQueuedReports}),
      reports_(cell, participant_, publish_queue_, poses_, recording_health_),
      recording_(open_recording(cell, options, poses_, recording_health_)),
      ros_(open_ros(cell, participant_, poses_, publish_queue_, recording_health_)) {
  const TickLoopOptions loop{
      .max_ticks = options.max_ticks,
      .max_samples = kBatchesATick * (PoseReader::samples_a_batch(cell.scene) +
                                      PoseReader::joints_a_batch(cell.scene))};
  std::vector<ReportSink*> sinks{&publish_queue_};
  if (recording_) sinks.push_back(&recording_->sink());
  if (ros_) sinks.push_back(ros_.get());
  loop_ = std::make_unique<TickLoop>(cell.scene, poses_, std::move(sinks), clock_, loop);
}

// The loop ticks in its own thread; this one waits for signals and watches the recording.
// Afterwards the queues are emptied, so that the last report is published and recorded.
void Daemon::run(StopSignal& signal) {
  if (options_.fifo_priority > 0) log_refusal(lock_memory());
  log_line(lines::kStarted, scene_.name, scene_.revision, scene_.rate_hz, participant_.where());
  log_line(lines::kHowToReach, participant_.how_to_reach());
  for (const Robot& robot : scene_.robots) {
    for (const std::string& note : robot.notes) log_line(lines::kRobotNote, robot.name, note);
  }
  warn_of_partition(cell_, options_.dds);

  std::atomic<bool> done{false};
  const std::int64_t started = clock_.monotonic_ns();
  poses_.start();
  std::thread ticking([&] { tick_thread(done); });
  // The thread that waits for signals needs no priority of its own.
  if (options_.fifo_priority > 0) log_refusal(use_fifo_scheduling(0));
  while (!done && !gave_way() && !signal.wait(kSignalPollMs)) {
    if (signal.hung_up()) log_line(lines::kNoReload);
    if (recording_) recording_->watch();
  }
  stop_ = true;
  ticking.join();
  seconds_ = 1e-9 * static_cast<double>(clock_.monotonic_ns() - started);

  reports_.finish();
  if (ros_) ros_->finish();
  if (recording_) recording_->finish();
  log_line(lines::kStopped, counted(loop_->statistics().cycle, "tick"));
}

// A refusal (no privilege) is logged and the daemon runs without it.
void Daemon::tick_thread(std::atomic<bool>& done) {
  name_thread("tick");
  if (options_.fifo_priority > 0) log_refusal(use_fifo_scheduling(options_.fifo_priority));
  if (options_.cpu) log_refusal(pin_to_cpu(*options_.cpu));
  loop_->run(stop_);
  done = true;
}

// Reports that DDS refused count as dropped, too.
std::string Daemon::summary() const {
  const std::uint64_t dropped = publish_queue_.dropped_reports() + reports_.failed_writes();
  return run_summary(scene_, loop_->statistics(), seconds_, dropped) +
         (recording_ ? recording_->summary() : "");
}

bool Daemon::recording_complete() const noexcept { return !recording_ || recording_->complete(); }
bool Daemon::recording_hangs() const noexcept { return recording_ && recording_->hangs(); }

}  // namespace clearance
