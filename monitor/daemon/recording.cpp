// A thread empties a queue of batches and reports into the recorder. The queue is bounded: when a
// slow disk has filled it, what no longer fits is counted as missing.
#include "monitor/daemon/recording.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "monitor/dds/health.hpp"
#include "monitor/loop/realtime.hpp"

namespace clearance {
namespace {

// How much a disk may stall: a second at 1 kHz for a cell of usual size, less for a huge one.
constexpr std::size_t kMostSlots = 1024, kFewestSlots = 64;
constexpr std::size_t kQueueBytes = std::size_t{64} << 20;

// As many slots as fit into the memory that a queue may use.
std::size_t slots(std::size_t bytes_a_slot) {
  return std::clamp(kQueueBytes / std::max<std::size_t>(bytes_a_slot, 1), kFewestSlots, kMostSlots);
}

// A slot of a report holds at most all pairs, a slot of a batch as many poses as the reader takes.
ReportQueueOptions queue_options(const Scene& scene) {
  const std::size_t samples = PoseReader::samples_a_batch(scene);
  return {.reports = slots(sizeof(PairReport) * scene.pairs.size()),
          .inputs = slots(sizeof(PoseSample) * samples),
          .samples_a_batch = samples};
}

}  // namespace

// The file and its catalogue are written before the first tick, so that errors come at the start.
Recording::Recording(const std::filesystem::path& file, bool over, const Scene& scene,
                     const PoseReader& poses)
    : scene_(scene),
      file_(file.string()),
      poses_(poses),
      queue_(scene, queue_options(scene)),
      recorder_(file, scene, SystemClock().realtime_ns(), over) {
  if (!recorder_.ok()) throw RecordError(fmt::format("recording: {}", recorder_.error()));
  thread_ = std::thread([this] { run(); });
}

Recording::~Recording() { finish(); }

// Ends the thread when the queue is empty. A second call does nothing.
void Recording::finish() {
  if (!thread_.joinable()) return;
  queue_.close();
  thread_.join();
}

// Empties the queue until it is closed. What a report used is in the queue before the report is.
void Recording::run() {
  name_thread("record");
  // A file can wait: no priority over the rest of the machine.
  if (const Refusal refusal = use_fifo_scheduling(0)) spdlog::warn("{}", *refusal);
  for (bool closed = false; !closed;) {
    queue_.wait();
    closed = queue_.closed();  // asked before the last look, so that nothing is left behind
    while (const QueuedReport* queued = queue_.reports().front()) {
      // What this report used is in the queue already; what later ones used may be as well.
      while (const PoseBatch* batch = queue_.inputs().front()) {
        recorder_.poses(*batch);
        queue_.inputs().pop();
      }
      recorder_.report(queued->report, queued->sources());
      queue_.reports().pop();
    }
    while (const LoopStatistics* statistics = queue_.statistics().front()) {
      recorder_.health(*make_health(scene_, *statistics, poses_, queue_.dropped_reports()));
      queue_.statistics().pop();
      log_trouble();
    }
  }
  complete_ = recorder_.close() && queue_.dropped_reports() + queue_.dropped_inputs() == 0;
  log_trouble();
}

// Each new trouble once: at a tick rate the log would be flooded.
void Recording::log_trouble() {
  if (!recorder_.ok() && !std::exchange(error_logged_, true)) {
    spdlog::error("recording stopped: {}", recorder_.error());
  }
  const std::uint64_t dropped = queue_.dropped_reports() + queue_.dropped_inputs();
  if (dropped > dropped_logged_) {
    spdlog::error("recording: the disk is too slow, {} reports and {} batches are missing so far",
                  queue_.dropped_reports(), queue_.dropped_inputs());
    dropped_logged_ = dropped;
  }
}

// On stdout, at the end of a run.
std::string Recording::summary() const {
  return fmt::format("recorded {} messages, {:.1f} MB, in {}{}\n", recorder_.messages(),
                     1e-6 * static_cast<double>(recorder_.bytes()), file_,
                     complete_ ? "" : ": INCOMPLETE, the log says why");
}

}  // namespace clearance
