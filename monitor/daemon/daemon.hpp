// The daemon as one object: the tick loop in a thread of its own, the DDS ports around it, and an
// optional recording.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "config/cell/cell.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/daemon/recording.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/dds/report_writer.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/ros/ros_writer.hpp"

namespace clearance {

struct DaemonOptions {
  DdsOptions dds;
  std::uint64_t max_ticks = 0;  // 0: until a signal comes
  int fifo_priority = 0;        // of the tick thread; the other threads get one less; 0: ordinary
  std::filesystem::path record_file;  // empty: no recording
  RecordingOptions recording = {.overwrite = false};
  std::optional<int> cpu;  // processor that the tick thread is pinned to
};

// The order of the members matters: ports and queues outlive the loop that uses them.
class Daemon {
 public:
  // Joins DDS and announces the catalogue. Throws DdsError, and RecordError when the
  // recording cannot be made.
  Daemon(const Cell& cell, const DaemonOptions& options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Ticks until a signal comes, `max_ticks` are done, or an older daemon of this cell is found.
  // Then it writes everything that is queued.
  void run(StopSignal& signal);

  // True when the daemon ends because an older one publishes this cell.
  [[nodiscard]] bool gave_way() const noexcept { return reports_.gives_way(); }
  // After run(): a summary for a person.
  [[nodiscard]] std::string summary() const;
  // After run(): true when nothing was to be recorded, or when the file holds all of it.
  [[nodiscard]] bool recording_complete() const noexcept;
  // After run(): true when the recording thread still waits for the disk. The program must then end
  // without destroying this object.
  [[nodiscard]] bool recording_hangs() const noexcept;

 private:
  void tick_thread(std::atomic<bool>& done);

  const Cell& cell_;
  const Scene& scene_;
  DaemonOptions options_;
  Participant participant_;
  PoseReader poses_;
  ReportQueue publish_queue_;
  RecordingHealth recording_health_;
  ReportWriter reports_;
  std::unique_ptr<Recording> recording_;
  std::unique_ptr<RosWriter> ros_;
  SystemClock clock_;
  std::unique_ptr<TickLoop> loop_;
  std::atomic<bool> stop_{false};
  double seconds_ = 0.0;
};

}  // namespace clearance
