// `--record`: a thread of its own that hands the recorder what the ticks used and reported.
#pragma once

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "config/scene.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/recording/recorder.hpp"

namespace clearance {

// The file cannot be created. Errors after that do not stop the daemon; see complete().
class RecordError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Batches and reports go into the file in the order in which the ticks used and made them, so that
// an offline replay gives the same reports. A slow disk never holds up a tick or a report: what
// finds the queue full is missing from the file, is counted, and makes complete() false.
class Recording {
 public:
  // Throws RecordError when the file cannot be made, or is there already and not to be written
  // over.
  Recording(const std::filesystem::path& file, bool over, const Scene& scene,
            const PoseReader& poses);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] ReportSink& sink() noexcept { return queue_; }
  // After the last tick: writes what is queued and closes the file.
  void finish();
  // After finish().
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // After finish(): one line for a person.
  [[nodiscard]] std::string summary() const;

 private:
  void run();
  void log_trouble();

  const Scene& scene_;
  std::string file_;
  const PoseReader& poses_;
  ReportQueue queue_;
  Recorder recorder_;
  bool error_logged_ = false;
  std::uint64_t dropped_logged_ = 0;
  bool complete_ = false;
  std::thread thread_;
};

}  // namespace clearance
