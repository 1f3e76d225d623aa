// The loop's ports for tests: a list of batches, a clock that the test moves, a list of reports.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "monitor/loop/ports.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

// Time advances only in sleep_until and where a test states that work takes long.
class TurnedClock final : public Clock {
 public:
  std::int64_t realtime_ns() noexcept override { return kStart + now_; }
  std::int64_t monotonic_ns() noexcept override { return now_; }
  std::int64_t steady_ns() noexcept override { return now_; }
  void sleep_until(std::int64_t monotonic_ns) noexcept override {
    if (monotonic_ns > now_) ++rests_;
    now_ = std::max(now_, monotonic_ns + late_);
    ++sleeps_;
    if (while_asleep) while_asleep(sleeps_);
  }
  void stay_awake_until(std::int64_t monotonic_ns) noexcept override {
    now_ = std::max(now_, monotonic_ns);
  }
  void pass(std::int64_t ns) noexcept { now_ += ns; }
  void wake_late_by(std::int64_t ns) noexcept { late_ = ns; }
  [[nodiscard]] int sleeps() const noexcept { return sleeps_; }
  // Sleeps whose end was still to come: only these leave the processor to others.
  [[nodiscard]] int rests() const noexcept { return rests_; }
  // Does the work of other threads before the tick of this number, counted from 1.
  std::function<void(int)> while_asleep;

 private:
  std::int64_t now_ = 0, late_ = 0;
  int sleeps_ = 0, rests_ = 0;
};

class ListedPoses final : public PoseSource {
 public:
  void add(std::string_view source, std::uint64_t sequence_number, std::size_t samples,
           std::uint64_t revision = 0) {
    PoseBatch& batch = batches_.emplace_back();
    batch.source = SourceName(source);
    batch.sequence_number = sequence_number;
    batch.scene_revision = revision;
    for (std::size_t i = 0; i < samples; ++i) {
      batch.samples.push_back(sample(0, at(1, 0, 0), kStart));
    }
  }
  void add(std::string_view source, std::uint64_t sequence_number,
           std::span<const JointSample> joints) {
    PoseBatch& batch = batches_.emplace_back();
    batch.source = SourceName(source);
    batch.sequence_number = sequence_number;
    batch.joints.assign(joints.begin(), joints.end());
  }
  // The one that was added last.
  [[nodiscard]] PoseBatch& last() { return batches_.back(); }
  const PoseBatch* next() noexcept override {
    return given_ == batches_.size() ? nullptr : &batches_[given_++];
  }

 private:
  std::deque<PoseBatch> batches_;
  std::size_t given_ = 0;
};

class ListedReports final : public ReportSink {
 public:
  explicit ListedReports(TurnedClock& clock) : clock_(clock) { cycles.reserve(100); }
  void input(const PoseBatch& batch) noexcept override { inputs.push_back(batch.sequence_number); }
  void report(const Report& report, std::span<const SourceUse> sources) noexcept override {
    cycles.push_back(report.cycle);
    times_ns.push_back(report.now_ns - kStart);
    used.emplace_back(sources.begin(), sources.end());
    inputs_before.push_back(inputs.size());
    rejected = report.rejected;
    if (report.cycle == slow_cycle || all_slow) clock_.pass(slow_ns);
  }
  void statistics(const LoopStatistics& statistics) noexcept override {
    all_statistics.push_back(statistics);
  }

  std::uint64_t slow_cycle = 0;
  bool all_slow = false;
  std::int64_t slow_ns = 0;
  std::vector<std::uint64_t> cycles, inputs;
  std::vector<std::size_t> inputs_before;
  std::vector<std::int64_t> times_ns;
  std::vector<std::vector<SourceUse>> used;
  std::vector<LoopStatistics> all_statistics;
  std::array<std::uint64_t, kRejects> rejected{};

 private:
  TurnedClock& clock_;
};

}  // namespace clearance::test
