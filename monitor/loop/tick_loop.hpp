// The fixed-rate loop: on each deadline it takes the batches that have arrived, runs Monitor::tick
// and hands the report over. It knows neither DDS nor the kernel's clocks: both come through ports.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "monitor/inputs/simulated_time.hpp"
#include "monitor/loop/loop_question.hpp"
#include "monitor/loop/phase_lock.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/report_delay.hpp"
#include "monitor/loop/steady_time.hpp"
#include "monitor/tick/tick_state.hpp"

namespace clearance {

struct TickLoopOptions {
  std::uint64_t max_ticks = 0;  // 0: until told to stop
  std::size_t max_samples =
      4096;  // samples that one tick can use; the rest waits for the next tick
  // The loop wakes this long before each deadline and stays awake until the deadline. It is cut to
  // half a period, and is not used with a pace.
  std::int64_t ahead_ns = 0;
  TickPace* pace = nullptr;         // null: the loop alone decides when it ticks
  FrameExchange* frames = nullptr;  // of sensors; null: there are none
  SimulatedTime* time = nullptr;    // null: the steady time of the clock. Not with a pace
};

// A successor with what else of the loop belongs to one scene.
class SceneOffer final : public Successor {
 public:
  // `sinks` get the reports of the changed scene, from the first one on.
  SceneOffer(const TickState& running, const Scene& scene, std::vector<ReportSink*> sinks,
             TickRecords& records)
      : Successor(running, scene, records), statistics_(scene), sinks_(std::move(sinks)) {}

  // Returns the figures of the former scene. Only the preparing thread calls this, once it has
  // succeeded.
  [[nodiscard]] const LoopStatistics& statistics() const noexcept { return statistics_; }

 private:
  friend class TickLoop;

  LoopStatistics statistics_;
  std::vector<ReportSink*> sinks_;
};

// Deadlines are absolute: start + k * period, unless ticks follow a robot (phase_lock.hpp). A tick
// that ends after the next deadline is an overrun, and the next tick starts at once. Deadlines
// missed by a whole period or more are skipped and counted, so that the loop returns to its grid.
// Cycle numbers count ticks and have no gaps.
class TickLoop {
 public:
  // Allocates all memory of the loop. Everything given must outlive the loop.
  TickLoop(const Scene& scene, PoseSource& source, std::vector<ReportSink*> sinks, Clock& clock,
           const TickLoopOptions& options = {});

  // Any one thread: offers the monitor of a changed scene. The loop begins with it before its next
  // tick, and ticks it as soon as it has caught up. From then on, SceneIds decides which batches of
  // former scenes are still used. Returns false while another one is in progress. The offer must
  // live until the next one has succeeded, or the loop has ended.
  bool offer(SceneOffer& offer) noexcept;
  // True while an offer is in progress.
  [[nodiscard]] bool busy() const noexcept {
    return offered_.load(std::memory_order_acquire) != nullptr;
  }
  // The preparing thread, as TickState says: to construct an offer, and to save what it took over.
  [[nodiscard]] const TickState& state() const noexcept { return state_; }

  // Any one thread: offers the state of a partner, which the loop ticks from its next tick on.
  // Returns false while another one waits. It must live until has_joined(), or the loop has ended.
  bool offer(JoinedState& joined) noexcept;
  // True once the loop has let go of the state that was offered last.
  [[nodiscard]] bool has_joined() const noexcept {
    return joined_.load(std::memory_order_acquire) == nullptr;
  }

  // Any thread but that of the tick: asks, and waits until the tick thread has answered between two
  // ticks, without a lock and without memory. Several threads are answered one after another, one
  // in a tick. Returns false if the loop has ended meanwhile: `loop_ended` is set once its thread
  // has ended.
  [[nodiscard]] bool ask(LoopQuestion& question, const std::atomic<bool>& loop_ended);

  // Runs in the calling thread until `stop` is set, `max_ticks` are done, or the self-test of the
  // monitor has failed.
  void run(const std::atomic<bool>& stop) noexcept;

  // The figures that the sinks got last; after run(), the final ones.
  [[nodiscard]] const LoopStatistics& statistics() const noexcept { return statistics_; }

 private:
  void between_ticks() noexcept;
  void follow_offer() noexcept;
  void join() noexcept;
  [[nodiscard]] std::int64_t wait(std::int64_t deadline) noexcept;
  void get_ready(std::int64_t deadline) noexcept;
  void answer_question() noexcept;
  void change_scene(SceneOffer& offer) noexcept;
  void take_in() noexcept;
  [[nodiscard]] bool tick_once(std::int64_t deadline) noexcept;
  [[nodiscard]] TickTime tick_time() noexcept;
  [[nodiscard]] bool use(const PoseBatch& batch) noexcept;
  void note_source(const PoseBatch& batch) noexcept;
  void note_phase(const PoseBatch& batch) noexcept;
  void note_stamps() noexcept;
  void note_delay() noexcept;
  void start_report(std::int64_t told_ns, const Report& report) noexcept;
  void note_minimum(const Report& report) noexcept;
  void hand_over_statistics() noexcept;
  [[nodiscard]] std::int64_t next_deadline(std::int64_t deadline, std::int64_t ended) noexcept;

  TickState state_;
  std::atomic<SceneOffer*> offered_{nullptr};
  std::atomic<JoinedState*> joined_{nullptr};
  std::atomic<LoopQuestion*> asked_{nullptr};
  SteadyTime time_;
  PoseSource& source_;
  std::vector<ReportSink*> sinks_;
  Clock& clock_;
  TickLoopOptions options_;
  std::int64_t period_ns_;
  std::uint64_t ticks_a_second_;
  PhaseLock phase_;
  ReportDelay delay_;
  std::array<std::int64_t, kMaxSources> stamps_ns_;  // oldest of the last samples of each source
  ReportStart start_;

  const PoseBatch* waiting_ = nullptr;  // taken from the source, but did not fit into the last tick
  std::array<SourceUse, kMaxSources> used_;
  std::size_t used_count_ = 0;
  LoopStatistics statistics_;
};

}  // namespace clearance
