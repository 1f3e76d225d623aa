// Lets two daemons tick the same cycles with the same inputs. README.md here has the method.
//
// One of the two leads: somewhat before each of its ticks it chooses the inputs and names them in a
// notice. The other follows: it waits for the notice, takes the same batches and ticks at the same
// time. If no notice comes it leads itself, in the same tick.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "monitor/loop/batch_store.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/semaphore.hpp"
#include "monitor/loop/steady_time.hpp"
#include "monitor/loop/tick_notice.hpp"
#include "monitor/tick/frame_exchange.hpp"
#include "monitor/tick/spsc_ring.hpp"
#include "monitor/tick/tick_pace.hpp"

namespace clearance {

struct TickPartnerOptions {
  std::int64_t period_ns = 1'000'000;
  std::uint64_t daemon = 0;   // identity of this run, not 0
  std::int64_t start_ns = 0;  // its start, CLOCK_REALTIME
  BatchStore::Size batch;
  // A daemon that hears no partner for this time after its start has none.
  std::int64_t alone_after_ns = 1'000'000'000;
  // A leader that was heard no more for this time, and for two periods at least, is gone for a
  // daemon that does not follow it. It is five times as long for one that publishes nothing.
  std::int64_t lost_after_ns = 20'000'000;
  FrameExchange* frames = nullptr;  // of sensors; null: there are none
  // A leader is shown a frame that the partner has not built after this time.
  std::int64_t frame_patience_ns = 20'000'000;
};

// The marks of a report for its partner, beside its content.
struct TickTag {
  std::uint64_t cycle = 0, lineage = 0, state_checksum = 0;
  PartnerStanding standing = PartnerStanding::kStarting;
  bool publishes = false;  // false: only the daemon's own recording gets it
};

// The port of partners calls what is not for the tick thread. Nothing that the tick thread calls
// allocates, locks or throws.
class TickPartner final : public PoseSource, public TickPace {
 public:
  // Both must outlive this.
  TickPartner(PoseSource& source, Clock& clock, const TickPartnerOptions& options);

  // The thread that hears the partner: a notice, with `due_ns` in CLOCK_MONOTONIC of this machine.
  // Returns false if the tick thread is too slow for it.
  bool hear(const TickNotice& notice) noexcept;
  // The thread that hears has handed over all that had come when it looked.
  void end_pass() noexcept { passes_.fetch_add(1, std::memory_order_release); }
  // Whether the partner was heard a moment ago.
  void set_partner_present(bool present) noexcept { partner_present_ = present; }
  // The thread that writes notices: waits for one, or for wake().
  void wait_for_notice() noexcept { noticed_.wait(); }
  void wake() noexcept { noticed_.post(); }
  [[nodiscard]] SpscRing<TickNotice>& notices() noexcept { return notices_; }
  // The thread that publishes reports: a tag for each report, in their order.
  [[nodiscard]] SpscRing<TickTag>& tags() noexcept { return tags_; }

  // Any thread.
  [[nodiscard]] std::int64_t period_ns() const noexcept { return options_.period_ns; }
  [[nodiscard]] PartnerStanding standing() const noexcept { return shown_standing_.load(); }
  // This daemon does not follow a partner whose ticks of the same scene it hears, and has had the
  // inputs that one of them names.
  [[nodiscard]] bool wants_state() const noexcept { return wants_state_.load(); }
  // The lineage that a successor takes over, from Successor::begin() to its end; otherwise 0.
  [[nodiscard]] std::uint64_t becoming() const noexcept { return shown_becoming_.load(); }
  // The number of notices that no leader can have written.
  [[nodiscard]] std::uint64_t refused_notices() const noexcept { return refused_notices_.load(); }
  // When this daemon took the lead the last time, CLOCK_MONOTONIC.
  [[nodiscard]] std::int64_t leads_since_ns() const noexcept { return leads_since_ns_.load(); }

  // Tick thread.
  const PoseBatch* next() noexcept override { return store_.next(); }
  [[nodiscard]] std::int64_t ahead_ns() const noexcept override { return options_.period_ns / 4; }
  void note_report_delay(std::int64_t ns) noexcept override { report_delay_ns_ = ns; }
  std::int64_t decide(std::int64_t deadline, std::uint64_t cycle,
                      std::uint64_t revision) noexcept override;
  [[nodiscard]] TickTime time() noexcept override { return time_; }
  void ticked(const Monitor& monitor) noexcept override;
  [[nodiscard]] std::uint64_t lineage() const noexcept override { return lineage_; }
  [[nodiscard]] bool is_behind() noexcept override;
  void successor_begins(bool same_scene) noexcept override;
  void successor_gave_up() noexcept override { become(0); }
  void successor_followed() noexcept override;
  [[nodiscard]] bool may_join() const noexcept override {
    return standing_ == PartnerStanding::kStarting || standing_ == PartnerStanding::kApart;
  }
  void joined(std::uint64_t lineage, std::uint64_t cycle) noexcept override;

 private:
  static constexpr std::size_t kKnown = 256;  // notices: those of a quarter of a second

  void listen() noexcept;
  // Returns false, and counts the notice as refused, if no leader can have written it.
  [[nodiscard]] bool is_possible(const TickNotice& notice) noexcept;
  // The lead of the leader's time over this daemon's own, at that tick.
  [[nodiscard]] std::int64_t ahead_of_own(const TickNotice& notice) noexcept;
  // A leader that stalls for a moment keeps its lead over a daemon that counts lower: clients would
  // see cycles again.
  [[nodiscard]] std::int64_t lost_after() const noexcept {
    return is_silent_ ? 5 * options_.lost_after_ns : options_.lost_after_ns;
  }
  void hear_out(std::int64_t late_ns) noexcept;
  void yield() noexcept;
  [[nodiscard]] const TickNotice* known(std::uint64_t cycle) const noexcept;
  [[nodiscard]] bool outranks_this(const TickNotice& notice) const noexcept;
  [[nodiscard]] bool continues_here(const TickNotice& notice) const noexcept;
  std::int64_t lead(std::int64_t deadline) noexcept;
  std::int64_t take_the_lead(std::int64_t deadline, bool goes_on) noexcept;
  std::int64_t follow(std::int64_t deadline) noexcept;
  std::int64_t follow(const TickNotice& notice) noexcept;
  std::int64_t part(std::int64_t deadline) noexcept;
  std::int64_t tick_apart(std::int64_t deadline) noexcept;
  // The frames of sensors that a tick chooses wait until the partner has answered that it has built
  // them, or has named them in a notice.
  enum class FramesWait : std::uint8_t { kNot, kForAnswer, kForNotice };
  void choose_frames(FramesWait wait) noexcept;
  [[nodiscard]] bool hears_leader() noexcept;
  // Joints that came before a change of the cell have the ids of the former one, and a source may
  // be one that the leader alone hears. A daemon that joined then would lack what is named next.
  [[nodiscard]] bool has_inputs_of_leader() noexcept {
    const TickNotice* const newest = known(newest_cycle_);
    return newest != nullptr && store_.has(newest->used());
  }
  [[nodiscard]] bool has_frames(const TickNotice& notice) noexcept;
  [[nodiscard]] TickTime own_time(std::int64_t due) noexcept;
  void approach_own_clock() noexcept;
  void stand(PartnerStanding standing) noexcept;
  void begin_lineage(std::uint64_t lineage, std::uint64_t before) noexcept;
  void become(std::uint64_t lineage) noexcept;
  [[nodiscard]] std::uint64_t fresh() noexcept;

  Clock& clock_;
  TickPartnerOptions options_;
  BatchStore store_;
  SteadyTime steady_;
  std::int64_t began_ns_;

  PartnerStanding standing_ = PartnerStanding::kStarting;
  bool is_silent_ = true;
  std::uint64_t cycle_ = 0, revision_ = 0;  // of the tick that is decided on
  std::int64_t deadline_ = 0;               // of the last tick
  std::uint64_t term_ = 0;
  std::uint64_t lineage_, before_ = 0, since_cycle_ = 0, becoming_ = 0;
  std::uint64_t seed_;
  TickTime time_;
  // The lead of the leader's time over this daemon's own, and the offsets of both at that tick.
  std::int64_t ahead_of_own_ns_ = 0, offset_ns_ = 0, own_offset_ns_ = 0;
  std::int64_t told_late_ns_ = 0;                          // see TickNotice
  std::int64_t report_delay_ns_ = TickTime::kNotMeasured;  // of this daemon
  bool has_joined_ = false;                                // and has followed no notice since

  std::array<TickFrame, kMaxSensors> frames_;      // that the next tick is shown
  std::array<std::int64_t, kMaxSensors> waits_{};  // by sensor: since when a frame waits; 0: none
  std::size_t frame_count_ = 0;
  std::array<std::uint64_t, kMaxSensors> named_{};  // by sensor: the last frame in a notice

  std::vector<TickNotice> known_;  // by cycle
  std::uint64_t newest_cycle_ = 0, newest_daemon_ = 0, newest_revision_ = 0, newest_term_ = 0;
  std::uint64_t newest_becoming_ = 0;
  std::int64_t newest_due_ns_ = 0, heard_ns_ = 0;  // heard_ns_ is 0 before the first

  SpscRing<TickNotice> heard_, notices_;
  SpscRing<TickTag> tags_;
  Semaphore noticed_;
  std::atomic<PartnerStanding> shown_standing_{PartnerStanding::kStarting};
  std::atomic<bool> wants_state_{false}, partner_present_{false};
  std::atomic<std::uint64_t> shown_becoming_{0}, refused_notices_{0};
  std::atomic<std::int64_t> leads_since_ns_{0};
  std::atomic<std::uint64_t> passes_{0};
};

}  // namespace clearance
