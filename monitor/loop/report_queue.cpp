// Every slot has its final size before the first tick, so that copying a report into it allocates
// nothing. One semaphore wakes the consumer for reports and statistics alike.
#include "monitor/loop/report_queue.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "monitor/interface/gradient_rows.hpp"

namespace clearance {
namespace {

constexpr std::size_t kStatisticsSlots = 4;  // one a second

// The order is relaxed, since no other data depends on the numbers.
void count(std::atomic<std::uint64_t>& counter) noexcept {
  counter.fetch_add(1, std::memory_order_relaxed);
}

// Brings memory that is written soon into the caches of this processor, up to a bound.
template <class T>
void fetch(const T* first, std::size_t count) noexcept {
  constexpr std::size_t kLine = 64, kMost = 1 << 15;
  const auto* const bytes = reinterpret_cast<const char*>(first);
  const std::size_t size = std::min(count * sizeof(T), kMost);
  for (std::size_t i = 0; i < size; i += kLine) __builtin_prefetch(bytes + i, 1);
}

}  // namespace

// The sizes are those of the largest report, health and batch of this scene.
ReportQueue::ReportQueue(const Scene& scene, const ReportQueueOptions& options)
    : reports_(options.reports),
      inputs_(std::max<std::size_t>(options.inputs, 1)),
      statistics_(kStatisticsSlots),
      keeps_inputs_(options.inputs > 0),
      awaits_(options.awaits),
      told_ns_(options.reports + 1) {
  const auto published = std::count_if(scene.pairs.begin(), scene.pairs.end(),
                                       [](const ObjectPair& pair) { return pair.publish; });
  const SeparatedCount separated = separated_count(scene);
  const std::size_t contacts = contact_pairs(scene).size();
  const std::size_t hidden = hidden_pairs(scene).size();
  const Gradients gradients = unknown_gradients(gradient_rows(scene));
  reports_.prepare([&](QueuedReport& slot) {
    slot.report.pairs.resize(static_cast<std::size_t>(published));
    slot.report.zones.resize(scene.zones.size());
    slot.report.separated_zones.resize(separated.zones);
    slot.report.separated_pairs.resize(separated.pairs);
    slot.report.stops.resize(separated.stops);
    slot.report.gradients = gradients;
    slot.report.contacts.resize(contacts);
    slot.report.hidden.resize(hidden);
  });
  statistics_.prepare([&](LoopStatistics& slot) { slot = LoopStatistics(scene); });
  if (keeps_inputs_) {
    inputs_.prepare([&](PoseBatch& slot) {
      slot.samples.resize(options.samples_a_batch);
      slot.joints.resize(options.joints_a_batch);
    });
  }
}

void ReportQueue::expect(std::int64_t deadline_ns) noexcept {
  if (const QueuedReport* const slot = reports_.back()) {
    fetch(slot, 1);
    fetch(slot->report.pairs.data(), slot->report.pairs.size());
    fetch(slot->report.zones.data(), slot->report.zones.size());
  }
  if (!awaits_) return;
  awake_until_ns_.store(2 * deadline_ns - SystemClock().monotonic_ns(), std::memory_order_relaxed);
  ready_.post();
}

// A wake-up takes a system call, so a consumer that is awake is not woken. While it is awake, it
// yields to threads of its own priority, which may be reading inputs. Both sides exchange `awake_`.
// If the consumer is first, the tick thread wakes it. Otherwise the consumer sees the report, which
// was pushed before the tick thread's exchange.
void ReportQueue::wait() noexcept {
  ready_.wait();
  const std::int64_t until = awake_until_ns_.exchange(0, std::memory_order_relaxed);
  if (until == 0) return;
  awake_.store(true, std::memory_order_release);
  while (reports_.front() == nullptr && !closed() && SystemClock().monotonic_ns() < until)
    std::this_thread::yield();
  awake_.exchange(false, std::memory_order_acq_rel);
}

// Does not wake the consumer; the report that follows does.
void ReportQueue::input(const PoseBatch& batch) noexcept {
  if (!keeps_inputs_) return;
  PoseBatch* slot = inputs_.back();
  if (slot == nullptr || batch.samples.size() > slot->samples.capacity() ||
      batch.joints.size() > slot->joints.capacity()) {
    count(dropped_inputs_);
    return;
  }
  *slot = batch;
  inputs_.push();
}

// The exchange of the tick thread and the maximum here lose nothing: a delay that comes in between
// is told with the next call.
void ReportQueue::published(std::int64_t delay_ns) noexcept {
  std::int64_t longest = longest_delay_ns_.load(std::memory_order_relaxed);
  while (delay_ns > longest &&
         !longest_delay_ns_.compare_exchange_weak(longest, delay_ns, std::memory_order_relaxed)) {
  }
  published_.fetch_add(1, std::memory_order_release);
}

// While the consumer hangs, the oldest report that waits tells for how long.
std::int64_t ReportQueue::longest_delay(std::int64_t now_ns) noexcept {
  const std::uint64_t published = published_.load(std::memory_order_acquire);
  const std::int64_t longest =
      longest_delay_ns_.exchange(TickTime::kNotMeasured, std::memory_order_relaxed);
  if (published == 0 || published == handed_over_) return longest;
  return std::max(longest, now_ns - told_ns_[published % told_ns_.size()]);
}

// Copies into a slot that was made beforehand; a full queue drops the report and counts it.
void ReportQueue::report(const Report& report, std::span<const SourceUse> sources) noexcept {
  QueuedReport* slot = reports_.back();
  if (slot == nullptr) {
    count(dropped_reports_);
    return;
  }
  slot->report = report;
  std::copy(sources.begin(), sources.end(), slot->sources_used.begin());
  slot->source_count = sources.size();
  slot->handed_over_ns = SystemClock().realtime_ns();
  slot->lineage = lineage_;
  slot->joined = std::exchange(joined_, 0);
  slot->start = start_;
  told_ns_[handed_over_++ % told_ns_.size()] = start_.told_ns;
  reports_.push();
  if (!awake_.exchange(false, std::memory_order_acq_rel)) ready_.post();
}

// A loss is harmless, since all figures are totals.
void ReportQueue::statistics(const LoopStatistics& statistics) noexcept {
  LoopStatistics* slot = statistics_.back();
  if (slot == nullptr) return;  // the next statistics contain these
  *slot = statistics;
  statistics_.push();
  ready_.post();
}

// Wakes the consumer, who then finds the queue closed.
void ReportQueue::close() noexcept {
  closed_.store(true, std::memory_order_release);
  ready_.post();
}

}  // namespace clearance
