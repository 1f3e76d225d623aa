// Carries reports out of the tick thread: copies each into a slot made beforehand and wakes the
// thread that publishes or records it. It never blocks: when the other side is too slow, reports
// are dropped and counted.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/semaphore.hpp"
#include "monitor/tick/spsc_ring.hpp"

namespace clearance {

// A slot: the report and the batches that its tick used.
struct QueuedReport {
  Report report;
  std::array<SourceUse, kMaxSources> sources_used;
  std::size_t source_count = 0;
  std::int64_t handed_over_ns = 0;  // time of the handing over, CLOCK_REALTIME
  std::uint64_t lineage = 0;        // of partners; 0: of a daemon on its own
  std::uint64_t joined = 0;         // ReportSink::joined(); 0: it goes on from the tick before
  ReportStart start;

  [[nodiscard]] std::span<const SourceUse> sources() const noexcept {
    return std::span(sources_used).first(source_count);
  }
};

struct ReportQueueOptions {
  std::size_t reports = 64;
  std::size_t inputs = 0;           // slots for batches; 0: batches are not kept
  std::size_t samples_a_batch = 0;  // a larger batch is dropped and counted
  std::size_t joints_a_batch = 0;   // the same for a batch of joint states
  bool awaits = false;              // after expect(), the consumer stays awake for the report
};

// One producer, the tick thread, and one consumer. Each of the three rings is lock-free.
class ReportQueue final : public ReportSink {
 public:
  ReportQueue(const Scene& scene, const ReportQueueOptions& options);

  // Tick thread. Prefetches the memory of the next report. If the queue `awaits`, this call also
  // wakes the consumer, which then stays awake until the report comes. The consumer stops waiting
  // once the time since the deadline equals the time from this call to the deadline.
  void expect(std::int64_t deadline_ns) noexcept override;
  void input(const PoseBatch& batch) noexcept override;
  void lineage(std::uint64_t lineage) noexcept override { lineage_ = lineage; }
  void joined(std::uint64_t lineage) noexcept override { joined_ = lineage; }
  void start(const ReportStart& start) noexcept override { start_ = start; }
  [[nodiscard]] std::int64_t longest_delay(std::int64_t now_ns) noexcept override;
  void report(const Report& report, std::span<const SourceUse> sources) noexcept override;
  void statistics(const LoopStatistics& statistics) noexcept override;

  // Called by any one thread after the last tick: the consumer's wait ends, and closed() is true.
  void close() noexcept;

  // Any thread: ends the consumer's wait for another reason than a report.
  void wake() noexcept { ready_.post(); }

  // For the one consuming thread. The inputs of a report are in the queue before the report.
  void wait() noexcept;
  [[nodiscard]] bool closed() const noexcept { return closed_.load(std::memory_order_acquire); }
  SpscRing<QueuedReport>& reports() noexcept { return reports_; }
  // The consumer has published the first report of the queue within this time of its `told_ns`.
  // kNotMeasured: it leaves the report out. A consumer that does not publish calls neither.
  void published(std::int64_t delay_ns) noexcept;
  SpscRing<PoseBatch>& inputs() noexcept { return inputs_; }
  SpscRing<LoopStatistics>& statistics() noexcept { return statistics_; }

  // Any thread.
  [[nodiscard]] std::uint64_t dropped_reports() const noexcept { return dropped_reports_.load(); }
  [[nodiscard]] std::uint64_t dropped_inputs() const noexcept { return dropped_inputs_.load(); }

 private:
  SpscRing<QueuedReport> reports_;
  SpscRing<PoseBatch> inputs_;
  SpscRing<LoopStatistics> statistics_;
  bool keeps_inputs_, awaits_;
  std::uint64_t lineage_ = 0, joined_ = 0;  // of the next report
  ReportStart start_;                       // likewise
  Semaphore ready_;
  std::atomic<bool> closed_{false};
  std::atomic<std::int64_t> awake_until_ns_{0};  // CLOCK_MONOTONIC; 0: no report is expected
  std::atomic<bool> awake_{false};               // the consumer looks for a report all the time
  std::atomic<std::int64_t> longest_delay_ns_{TickTime::kNotMeasured};
  std::vector<std::int64_t> told_ns_;  // of the last reports that were handed over, in turn
  std::uint64_t handed_over_ = 0;
  std::atomic<std::uint64_t> published_{0};
  std::atomic<std::uint64_t> dropped_reports_{0};
  std::atomic<std::uint64_t> dropped_inputs_{0};
};

}  // namespace clearance
