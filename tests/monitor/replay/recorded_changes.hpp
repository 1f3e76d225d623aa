// A run of a loop whose cell changes, recorded as the daemon records it.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/tick/successor.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

class RecordedChanges : public testing::Test {
 protected:
  // Runs the loop through all cells. A change is offered before each of the ticks `offered`, and
  // catches up `lag` ticks later.
  void record(PoseSource& poses, int ticks, const std::vector<int>& offered,
              const RecordingOptions& options, int lag) {
    recorder = std::make_unique<Recorder>(run, cells.front(), kStart, options);
    changes.clear();
    std::list<Sink> sinks;
    sinks.emplace_back(*this, cells.front());
    clock.emplace();
    TickLoop loop(cells.front().scene, poses, {&sinks.front()}, *clock,
                  {.max_ticks = static_cast<std::uint64_t>(ticks)});
    TickRecords records;
    std::list<SceneOffer> successors;
    clock->while_asleep = [&](int tick) {
      now = tick;
      const std::size_t made = successors.size();
      if (made < offered.size() && tick == offered[made]) {
        sinks.emplace_back(*this, cells[made + 1]);
        sinks.back().successor = &successors.emplace_back(
            loop.state(), cells[made + 1].scene, std::vector<ReportSink*>{&sinks.back()}, records);
        ASSERT_TRUE(loop.offer(successors.back()));
      }
      if (made > 0 && tick >= offered[made - 1] + lag) successors.back().catch_up();
    };
    std::atomic<bool> stop{false};
    loop.run(stop);
    EXPECT_TRUE(recorder->close()) << recorder->error();
    for (const SceneOffer& each : successors) changes.push_back(each.in_force());
    ASSERT_EQ(changes.size(), offered.size());
    for (const SceneInForce& change : changes)
      EXPECT_GE(change.from, change.began_after + static_cast<std::uint64_t>(lag));
  }

  // The files after the first one, in their order.
  [[nodiscard]] std::vector<std::filesystem::path> later_files() const {
    std::vector<std::filesystem::path> files;
    for (int part = 2;; ++part) {
      const auto file = folder / ("run-" + std::to_string(part) + ".mcap");
      if (!std::filesystem::exists(file)) return files;
      files.push_back(file);
    }
  }

  // The recorder's thread in the daemon: the description stands in front of the first report.
  class Sink final : public ReportSink {
   public:
    Sink(RecordedChanges& test, const Cell& cell) : test_(test), cell_(cell) {}
    void input(const PoseBatch& batch) noexcept override {
      begin();
      test_.recorder->poses(batch);
    }
    void report(const Report& report, std::span<const SourceUse> sources) noexcept override {
      begin();
      test_.recorder->report(report, sources, report.now_ns);
      if (test_.on_report) test_.on_report(report);
    }
    void statistics(const LoopStatistics&) noexcept override {}

    Successor* successor = nullptr;

   private:
    void begin() {
      if (successor != nullptr) test_.recorder->change(cell_, successor->in_force());
      successor = nullptr;
    }
    RecordedChanges& test_;
    const Cell& cell_;
  };

  ScratchFolder folder;
  std::filesystem::path run = folder / "run.mcap";
  std::vector<Cell> cells;  // in their order
  std::optional<TurnedClock> clock;
  int now = 0;  // the tick that is due
  std::unique_ptr<Recorder> recorder;
  std::vector<SceneInForce> changes;
  std::function<void(const Report&)> on_report;
};

}  // namespace clearance::test
