#include "monitor/daemon/tick_loop.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {

TickLoop::TickLoop(const Scene& scene, PoseSource& source, std::vector<ReportSink*> sinks,
                   Clock& clock, const TickLoopOptions& options)
    : scene_(scene),
      monitor_(scene, options.monitor),
      source_(source),
      sinks_(std::move(sinks)),
      clock_(clock),
      options_(options),
      period_ns_(std::llround(1e9 / scene.rate_hz)),
      ticks_a_second_(std::max<std::uint64_t>(1, std::llround(scene.rate_hz))) {
  samples_.reserve(options_.max_samples);
  vitals_.rejected.resize(scene.objects.size());
  vitals_.ages.resize(scene.objects.size());
}

void TickLoop::run(const std::atomic<bool>& stop) noexcept {
  std::int64_t deadline = clock_.monotonic_ns() + period_ns_;
  std::uint64_t ticks = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    clock_.sleep_until(deadline);
    const std::int64_t started = clock_.monotonic_ns();
    tick_once();
    const std::int64_t ended = clock_.monotonic_ns();

    vitals_.wakeup.add(started - deadline);
    vitals_.tick.add(ended - started);
    vitals_.wakeup_second_max_ns = std::max(vitals_.wakeup_second_max_ns, started - deadline);
    vitals_.tick_second_max_ns = std::max(vitals_.tick_second_max_ns, ended - started);
    deadline = next_deadline(deadline, ended);
    ++ticks;
    if (options_.max_ticks != 0 && ticks == options_.max_ticks) break;
    if (ticks % ticks_a_second_ == 0) hand_over_vitals();
  }
  hand_over_vitals();
}

std::int64_t TickLoop::next_deadline(std::int64_t deadline, std::int64_t ended) noexcept {
  const std::int64_t next = deadline + period_ns_;
  if (ended <= next) return next;
  ++vitals_.overruns;
  const std::int64_t missed = (ended - next) / period_ns_;
  vitals_.skipped_cycles += static_cast<std::uint64_t>(missed);
  return next + missed * period_ns_;
}

void TickLoop::tick_once() noexcept {
  take_in();
  const Report& report = monitor_.tick(samples_, clock_.realtime_ns());
  vitals_.cycle = report.cycle;
  vitals_.now_ns = report.now_ns;
  vitals_.rejected_total = report.rejected;
  note_minimum(report);
  for (ReportSink* sink : sinks_) sink->report(report, std::span(used_).first(used_count_));
}

void TickLoop::take_in() noexcept {
  samples_.clear();
  used_count_ = 0;
  for (;;) {
    if (waiting_ == nullptr) waiting_ = source_.next();
    if (waiting_ == nullptr) return;
    if (samples_.size() + waiting_->samples.size() > options_.max_samples) return;
    use(*waiting_);
    for (ReportSink* sink : sinks_) sink->input(*waiting_);
    waiting_ = nullptr;
  }
}

void TickLoop::use(const PoseBatch& batch) noexcept {
  note_source(batch);
  if (!made_for(batch, scene_.revision)) {
    for (const PoseSample& sample : batch.samples) {
      monitor_.refuse(sample.object, Reject::kWrongRevision);
    }
    return;
  }
  samples_.insert(samples_.end(), batch.samples.begin(), batch.samples.end());
}

void TickLoop::note_source(const PoseBatch& batch) noexcept {
  const auto end = used_.begin() + static_cast<std::ptrdiff_t>(used_count_);
  const auto found = std::find_if(
      used_.begin(), end, [&batch](const SourceUse& use) { return use.source == batch.source; });
  if (found == used_.end()) return;  // the port lets no more than kMaxSources in
  if (found == end) ++used_count_;
  *found = {.source = batch.source, .sequence_number = batch.sequence_number};
}

void TickLoop::note_minimum(const Report& report) noexcept {
  MinimumSeen& seen = vitals_.minimum;
  if (!report.minimum_known) return;
  if (seen.known && !(report.minimum.distance < seen.pair.distance)) return;
  seen = {.known = true, .pair = report.minimum, .cycle = report.cycle, .now_ns = report.now_ns};
}

void TickLoop::hand_over_vitals() noexcept {
  for (std::uint32_t object = 0; object < scene_.objects.size(); ++object) {
    vitals_.rejected[object] = monitor_.rejected(object);
    vitals_.ages[object] = monitor_.input_age(object);
  }
  for (ReportSink* sink : sinks_) sink->statistics(vitals_);
  vitals_.tick_second_max_ns = 0;
  vitals_.wakeup_second_max_ns = 0;
}

}  // namespace clearance
