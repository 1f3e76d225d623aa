// The daemon as one object: the tick loop in a thread of its own, DDS on either side of it, and a
// recording if asked for.
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
  int fifo_priority = 0;  // of the tick thread; the threads around it get one less; 0: ordinary
  std::filesystem::path record_file;  // empty: no recording
  RecordingOptions recording = {.overwrite = false};
  std::optional<int> cpu;  // that the tick thread is pinned to
  unsigned workers = 1;    // threads that evaluate pairs, the tick thread included; same scheduling
};

// The order of the members matters: ports and queues outlive the loop that uses them.
class Daemon {
 public:
  // Joins DDS and announces the catalogue. Throws DdsError, and RecordError when the
  // recording cannot be made.
  Daemon(const Cell& cell, const DaemonOptions& options);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Ticks until a signal comes, `max_ticks` are done, or another daemon turns out to have published
  // this cell before; then everything that was queued is written.
  void run(StopSignal& signal);

  // Ended, or about to, because another daemon publishes this cell.
  [[nodiscard]] bool gave_way() const noexcept { return reports_.gives_way(); }
  // After run(): what happened, for a person.
  [[nodiscard]] std::string summary() const;
  // After run(): nothing was to be recorded, or all of it is in the file.
  [[nodiscard]] bool recording_complete() const noexcept;
  // After run(): the disk took nothing any more, so that the thread that records waits for it
  // still. Then the program can only be ended without the end of this object.
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
