// `--record`: a thread of its own that hands the recorder what the ticks used and reported.
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

// Batches and reports go into the file in the order in which the ticks used and made them, so that
// an offline replay gives the same reports. A disk that is slow, full or gone never holds up a tick
// or a report: what finds the queue full or the file failed is missing, is counted, is told in the
// log and in the health topic, and makes complete() false.
class Recording {
 public:
  // Throws RecordError when the file cannot be made, is no regular file, or is there already and
  // not to be written over.
  Recording(const std::filesystem::path& file, const RecordingOptions& options, const Cell& cell,
            const PoseReader& poses, RecordingHealth& health);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] ReportSink& sink() noexcept { return queue_; }
  // To be called now and then by a thread that may wait for nothing: tells the log and the health
  // topic what went wrong since the last call.
  void watch();
  // After the last tick: writes what is queued and closes the file. Waits as long as the disk takes
  // something at least every two seconds.
  void finish();
  // After finish().
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // After finish(): the thread still waits for the disk. This object must then be left as it is.
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
  std::string file_;         // the first
  std::uint64_t files_ = 1;  // that the log knows of
  const PoseReader& poses_;
  RecordingHealth& health_;
  ReportQueue queue_;
  Recorder recorder_;
  std::atomic<std::uint64_t> steps_{0};      // messages handed to the recorder
  std::atomic<std::uint64_t> unwritten_{0};  // of them reports and batches that came after an error
  std::atomic<bool> ended_{false};           // the thread's work
  bool failure_logged_ = false;
  std::uint64_t dropped_logged_ = 0;
  std::int64_t logged_ns_ = 0;  // when a slow disk was last logged
  bool complete_ = false, hangs_ = false;
  std::thread thread_;
};

}  // namespace clearance
