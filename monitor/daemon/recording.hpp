// `--record`: a thread of its own gives the recorder the inputs and reports of the ticks.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/daemon/frame_uses.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/loop/response_times.hpp"
#include "monitor/publish/recording_health.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/wire/partner_state.hpp"

namespace clearance {

// The file cannot be created. Errors after that do not stop the daemon; see complete().
class RecordError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Batches and reports go into the file in the order in which the ticks used and made them. So an
// offline replay gives the same reports. Where the cell changes, its description stands in front of
// its first report. A slow, full or missing disk never delays a tick or a
// report. Messages that find the queue full or the file failed are missing: they are counted, log
// and health name them, and complete() is false.
class Recording {
 public:
  // Throws RecordError when the file cannot be made, is no regular file, or exists and may not be
  // overwritten.
  Recording(const std::filesystem::path& file, const RecordingOptions& options,
            std::shared_ptr<const Cell> cell, PoseReader& poses, RecordingHealth& health,
            const ResponseTimes* responses = nullptr);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Takes the reports of the first cell.
  [[nodiscard]] ReportSink& sink() noexcept {
    const Lock lock(mutex_);
    return parts_.front()->queue;
  }
  // Takes the frames of sensors that ticks are shown, of every cell. It stands before that sink.
  [[nodiscard]] ReportSink& frames() noexcept { return uses_; }
  // The cell may change: returns the sink of the changed one. Null if the disk is so slow that the
  // reports of kMostWaiting cells wait for it: the recording then ends with those. The preparing
  // thread calls these three.
  [[nodiscard]] ReportSink* prepare(std::shared_ptr<const Cell> cell);
  // The cell has changed: what comes into that sink follows in the file. Does not wait for the
  // disk.
  void follow(const SceneInForce& since);
  // The cell has not changed.
  void abandon() { prepared_ = nullptr; }
  // The loop may go on from this state of a partner: it then stands in the file in front of the
  // first report that does. To be called before the loop has it, by any one thread.
  void note_state(const PartnerStateView& state);
  // A command was answered, which is an event for a recording by event. Any thread.
  void note_command() noexcept { command_came_ = true; }
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
  static constexpr std::size_t kMostWaiting = 4;
  static constexpr std::size_t kMostStates = 8;

  // The queue of one cell.
  struct Part {
    explicit Part(std::shared_ptr<const Cell> the_cell);
    std::shared_ptr<const Cell> cell;
    SceneInForce since;
    ReportQueue queue;
  };

  void run();
  void record_all(Part& part);
  void record_frames(std::uint64_t cycle);
  void record_state(std::uint64_t lineage);
  [[nodiscard]] bool next_part();
  void fail(const std::string& why);
  void tell_of_missing_files() const;
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> dropped() const;
  void wait_for_the_disk() const;
  void count(std::uint64_t messages);
  void tell_of_new_files();
  [[nodiscard]] std::string files_text() const;
  [[nodiscard]] std::uint64_t missing() const;

  std::string file_;  // the first one
  bool by_event_;
  std::uint64_t files_, events_ = 0;  // those that the log has named
  std::uint64_t clouds_every_, frames_ = 0;
  const PoseReader& poses_;
  FrameUses uses_;
  BuiltFrames* built_;  // null: the cell has no sensors
  CdrEncoder encoder_;
  RecordingHealth& health_;
  const ResponseTimes* const responses_;  // null: not known
  // States that the loop went on from, or may go on from, by lineage: the last kMostStates.
  GUARDED_BY(mutex_) std::deque<std::pair<std::uint64_t, std::vector<std::byte>>> states_;
  mutable Mutex mutex_;
  // The first one is being recorded, and the loop writes to the last one.
  GUARDED_BY(mutex_) std::deque<std::unique_ptr<Part>> parts_;
  // Counts of queues that are gone.
  GUARDED_BY(mutex_) std::uint64_t reports_dropped_before_ = 0, inputs_dropped_before_ = 0;
  std::unique_ptr<Part> prepared_;
  std::atomic<bool> command_came_{false};
  std::atomic<bool> failing_{false};  // the first one to set it says why
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
