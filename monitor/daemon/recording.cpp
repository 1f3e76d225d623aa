// A thread empties a queue of batches and reports into the recorder. The queue is bounded: when a
// slow disk has filled it, further messages are counted as missing.
#include "monitor/daemon/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "monitor/app/log_lines.hpp"
#include "monitor/dds/health.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

// The queue covers a stalled disk for a second at 1 kHz with a cell of usual size, and less with a
// huge one.
constexpr std::size_t kMostSlots = 1024, kFewestSlots = 64;
constexpr std::size_t kQueueBytes = std::size_t{64} << 20;

// The time for which the disk may take nothing at the end.
constexpr int kDiskPatienceMs = 2000;
// The time between two log lines about a slow disk.
constexpr std::int64_t kLogEveryNs = 1'000'000'000;

// The number of slots that fit into the memory for a queue.
std::size_t slots(std::size_t bytes_a_slot) {
  return std::clamp(kQueueBytes / std::max<std::size_t>(bytes_a_slot, 1), kFewestSlots, kMostSlots);
}

// A slot of a report holds at most all pairs, a slot of a batch as many poses as the reader takes.
ReportQueueOptions queue_options(const Cell& cell) {
  const Scene& scene = cell.scene;
  const std::size_t samples = PoseReader::samples_a_batch(cell);
  const std::size_t joints = PoseReader::joints_a_batch(cell);
  return {.reports = slots(sizeof(PairReport) * scene.pairs.size() +
                           sizeof(PairSeparation) * separated_count(scene).pairs),
          .inputs = slots(sizeof(PoseSample) * samples + sizeof(JointSample) * joints),
          .samples_a_batch = samples,
          .joints_a_batch = joints};
}

}  // namespace

// The file and its catalogue are written before the first tick, so that errors show at the start.
Recording::Recording(const std::filesystem::path& file, const RecordingOptions& options,
                     const Cell& cell, const PoseReader& poses, RecordingHealth& health)
    : scene_(cell.scene),
      file_(file.string()),
      poses_(poses),
      health_(health),
      queue_(cell.scene, queue_options(cell)),
      recorder_(file, cell, SystemClock().realtime_ns(), options) {
  if (!recorder_.ok()) throw RecordError(fmt::format("recording: {}", recorder_.error()));
  if (!recorder_.without_files().empty()) {
    log_line(lines::kRecordingWithoutFiles, recorder_.without_files());
  }
  health_.begin(file_);
  thread_ = std::thread([this] { run(); });
}

Recording::~Recording() { finish(); }

// Ends the thread when the queue is empty. A second call does nothing.
void Recording::finish() {
  if (!thread_.joinable()) return;
  queue_.close();
  wait_for_the_disk();
  hangs_ = !ended_;
  if (hangs_) {
    thread_.detach();
    log_line(lines::kDiskHangs, file_);
  } else {
    thread_.join();
  }
  watch();
  complete_ = !hangs_ && !health_.failed() && missing() == 0;
}

// Waits until the thread has ended, or has given nothing to the disk for kDiskPatienceMs.
void Recording::wait_for_the_disk() const {
  std::uint64_t steps = steps_;
  for (int waited_ms = 0; !ended_ && waited_ms < kDiskPatienceMs; ++waited_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (steps_ != steps) waited_ms = 0;
    steps = steps_;
  }
}

// Empties the queue until it is closed.
void Recording::run() {
  name_thread("record");
  // A file can wait: this thread needs no priority.
  if (const Refusal refusal = use_fifo_scheduling(0)) log_line(lines::kSystemRefuses, *refusal);
  for (bool closed = false; !closed;) {
    queue_.wait();
    closed = queue_.closed();  // read before the queue, so that nothing remains in it
    record_all();
  }
  recorder_.close();
  count(0);
  ended_ = true;
}

// The batches that a report used are in the queue before it; batches for later reports may be there
// as well.
void Recording::record_all() {
  while (const QueuedReport* queued = queue_.reports().front()) {
    while (const PoseBatch* batch = queue_.inputs().front()) {
      recorder_.poses(*batch);
      queue_.inputs().pop();
      count(1);
    }
    recorder_.report(queued->report, queued->sources(), queued->handed_over_ns);
    queue_.reports().pop();
    count(1);
    tell_of_new_files();
  }
  while (const LoopStatistics* statistics = queue_.statistics().front()) {
    recorder_.health(*make_health(scene_, *statistics, poses_, queue_.dropped_reports(), health_));
    queue_.statistics().pop();
    recorder_.check();
    count(0);
  }
}

void Recording::tell_of_new_files() {
  if (recorder_.files() == files_) return;
  files_ = recorder_.files();
  log_line(lines::kRecordingContinues, recorder_.file().string());
}

// Called after the recorder was given so many reports or batches. If it has failed by then, they
// count as missing.
void Recording::count(std::uint64_t messages) {
  ++steps_;
  if (recorder_.ok()) return;
  if (!health_.failed()) health_.fail(recorder_.error());
  unwritten_ += messages;
}

// Messages that found the queue full, and messages after the file had failed.
std::uint64_t Recording::missing() const noexcept {
  return queue_.dropped_reports() + queue_.dropped_inputs() + unwritten_;
}

// Logs a failure once, and a slow disk once a second while messages are lost.
void Recording::watch() {
  health_.set_missing(missing());
  if (health_.failed()) {
    if (!std::exchange(failure_logged_, true)) log_line(lines::kRecordingStopped, health_.state());
    return;
  }
  const std::uint64_t dropped = queue_.dropped_reports() + queue_.dropped_inputs();
  const std::int64_t now_ns = SystemClock().monotonic_ns();
  if (dropped == dropped_logged_ || now_ns - logged_ns_ < kLogEveryNs) return;
  log_line(lines::kDiskTooSlow, counted(queue_.dropped_reports(), "report"),
           counted(queue_.dropped_inputs(), "batch", "batches"));
  dropped_logged_ = dropped;
  logged_ns_ = now_ns;
}

// Returns the lines for stdout at the end of a run. If the thread still waits for the disk, the
// recorder's state is not known.
std::string Recording::summary() const {
  if (complete_) {
    const std::string last =
        recorder_.files() > 1
            ? fmt::format(" and {} more, to {}", recorder_.files() - 1, recorder_.file().string())
            : "";
    return fmt::format("recorded {} messages, {:.1f} MB, in {}{}\n", recorder_.messages(),
                       1e-6 * static_cast<double>(recorder_.bytes()), file_, last);
  }
  const std::string why = hangs_             ? "the disk takes nothing"
                          : health_.failed() ? health_.state()
                                             : "the disk was too slow";
  return fmt::format("recording INCOMPLETE in {}: {}; {} reports and batches are missing\n", file_,
                     why, missing());
}

}  // namespace clearance
