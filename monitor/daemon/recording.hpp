// `--record`: a thread of its own gives the recorder the inputs and reports of the ticks.
#pragma once

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "config/cell/cell.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/dds/recording_health.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/recording/recorder.hpp"

namespace clearance {

// The file cannot be created. Errors after that do not stop the daemon; see complete().
class RecordError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Batches and reports go into the file in the order in which the ticks used and made them. So an
// offline replay gives the same reports. A slow, full or missing disk never delays a tick or a
// report. Messages that find the queue full or the file failed are missing: they are counted, log
// and health name them, and complete() is false.
class Recording {
 public:
  // Throws RecordError when the file cannot be made, is no regular file, or exists and may not be
  // overwritten.
  Recording(const std::filesystem::path& file, const RecordingOptions& options, const Cell& cell,
            const PoseReader& poses, RecordingHealth& health);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] ReportSink& sink() noexcept { return queue_; }
  // Updates log and health with the faults since the last call. It is called regularly, by a thread
  // that may not wait.
  void watch();
  // After the last tick: writes the queue and closes the file. Waits while the disk takes something
  // at least every two seconds.
  void finish();
  // After finish().
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // After finish(): true when the thread still waits for the disk. This object must then not be
  // destroyed.
  [[nodiscard]] bool hangs() const noexcept { return hangs_; }
  // After finish(): one line for a person.
  [[nodiscard]] std::string summary() const;

 private:
  void run();
  void record_all();
  void wait_for_the_disk() const;
  void count(std::uint64_t messages);
  void tell_of_new_files();
  [[nodiscard]] std::uint64_t missing() const noexcept;

  const Scene& scene_;
  std::string file_;         // the first one
  std::uint64_t files_ = 1;  // files that the log has named
  const PoseReader& poses_;
  RecordingHealth& health_;
  ReportQueue queue_;
  Recorder recorder_;
  std::atomic<std::uint64_t> steps_{0};      // messages given to the recorder
  std::atomic<std::uint64_t> unwritten_{0};  // reports and batches after an error
  std::atomic<bool> ended_{false};           // the thread has finished
  bool failure_logged_ = false;
  std::uint64_t dropped_logged_ = 0;
  std::int64_t logged_ns_ = 0;  // time of the last log line about a slow disk
  bool complete_ = false, hangs_ = false;
  std::thread thread_;
};

}  // namespace clearance
