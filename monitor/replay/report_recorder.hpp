// Writes replayed ticks as a recording: catalogues, reports and zone changes. The bytes depend on
// nothing but the replayed recording, the cell and the build.
#pragma once

#include <filesystem>
#include <string>

#include "monitor/recording/recorder.hpp"
#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// Overwrites the file. Without a tick, close() still writes the catalogue, stamped 0.
class ReportRecorder {
 public:
  ReportRecorder(const std::filesystem::path& file, const Cell& cell) : file_(file), cell_(cell) {}

  void add(const ReplayedTick& tick) {
    // The catalogue is stamped with the first tick: nothing else here has a time.
    if (!recorder_) recorder_.emplace(file_, cell_, tick.report.now_ns, RecordingOptions{});
    if (tick.cell.scene.revision != revision_) recorder_->change(tick.cell, tick.since);
    revision_ = tick.cell.scene.revision;
    recorder_->report(tick.report, tick.sources);
  }
  bool close() {
    if (!recorder_) recorder_.emplace(file_, cell_, 0, RecordingOptions{});
    return recorder_->close();
  }
  // The reason why the recording does not hold the cell's files, if it does not.
  [[nodiscard]] std::string without_files() const {
    return recorder_ ? recorder_->without_files() : "";
  }
  [[nodiscard]] std::string error() const { return recorder_ ? recorder_->error() : ""; }

 private:
  std::filesystem::path file_;
  const Cell& cell_;
  std::uint64_t revision_ = cell_.scene.revision;  // of the last tick
  std::optional<Recorder> recorder_;
};

}  // namespace clearance
