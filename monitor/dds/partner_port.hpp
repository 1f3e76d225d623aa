// Joins a daemon's TickPartner with its partner on DDS: notices of ticks, states, the leader's
// cell, and the reports of the partner, which are compared with the daemon's own.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <thread>

#include "config/cell/topics.hpp"
#include "monitor/dds/daemon_identity.hpp"
#include "monitor/dds/leader_lease.hpp"
#include "monitor/dds/partner_reports.hpp"
#include "monitor/loop/tick_partner.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/partner_state.hpp"

namespace clearance {

// The least delay of the partner's notices: what remains of it is the error of the phase. It holds
// for the last 512 to 1024 notices, so that it follows clocks that drift.
class LeastDelay {
 public:
  std::int64_t add(std::int64_t delay_ns) noexcept;
  [[nodiscard]] bool is_known() const noexcept { return count_ > 0; }
  [[nodiscard]] std::int64_t least() const noexcept { return std::min(now_, before_); }
  // The first notices may have waited for this program.
  [[nodiscard]] bool is_settled() const noexcept { return count_ > kWindow; }

 private:
  static constexpr std::uint32_t kWindow = 512;
  std::int64_t now_ = std::numeric_limits<std::int64_t>::max(), before_ = now_;
  std::uint32_t count_ = 0;
};

class PartnerPort {
 public:
  struct Actions {
    std::function<void()> wants_state;  // once per second, while this daemon does not follow
    std::function<void()> send_state;   // the partner asks for the state
    std::function<void(const PartnerStateView&)> take_state;
    std::function<std::uint64_t()> revision = {};  // of the scene in force here
    // The leader has the cell of this text and revision in force, and this daemon has not. Once for
    // a change, and again every second.
    std::function<void(std::string text, std::uint64_t revision)> take_cell = {};
    // The leader tells what it has done with MoveIt's messages. Once for each message of it.
    std::function<void(const clearance_msg_PartnerScene&)> hear_scene = {};
    std::function<void()> update_lead = {};  // every 10 ms, and after each message
  };
  // `identity` names the partner that this daemon is. Everything given must outlive this.
  PartnerPort(Participant& participant, const Topics& topics, const DaemonIdentity& identity,
              TickPartner& ticks);
  ~PartnerPort();
  PartnerPort(const PartnerPort&) = delete;
  PartnerPort& operator=(const PartnerPort&) = delete;

  // Starts both threads.
  void start(Actions actions);
  void stop();
  // After start(): the threads, which the tick waits for.
  [[nodiscard]] std::array<std::thread::native_handle_type, 2> threads();

  // Any thread.
  void request_state(std::uint64_t revision);
  void send_state(const PartnerStateView& state);
  void send_scene(std::span<const clearance_msg_SceneChange> changes,
                  std::span<const std::byte> bytes);

  // The thread that publishes. The tag of the report of this cycle, in the order of reports.
  [[nodiscard]] TickTag tag(std::uint64_t cycle) noexcept;
  // True if this daemon writes what has one leader: it leads, its lease holds, and no other
  // leader's lease lasts.
  [[nodiscard]] bool leads() const;
  void published(const clearance_msg_Distances& report) { reports_.note_own(report); }
  void fill(clearance_msg_PartnerHealth& out);
  // The partner has published in the last half of a second.
  [[nodiscard]] bool hears_partner() { return reports_.hears_any(PartnerReports::kGoneAfterNs); }
  // The partner was heard once, and its reports do not agree with those of this daemon.
  [[nodiscard]] bool disagrees() { return reports_.disagrees(); }
  [[nodiscard]] std::string partner() { return reports_.name(); }
  // The revision of the partner's last report.
  [[nodiscard]] std::uint64_t partner_revision() const noexcept { return partner_revision_; }

 private:
  void write_notices();
  void hear();
  void hear_notices();
  void hear_notice(std::int64_t delay_ns);
  void hear_states();
  void hear_reports();
  void hear_catalogues();
  void hear_scenes();
  void look_for_cell();
  [[nodiscard]] bool is_told(std::uint64_t revision) const;
  void poll();
  [[nodiscard]] bool hears_leader() const;
  static void write(dds_entity_t writer, const void* sample, const char* what);
  void write(Sample<clearance_msg_PartnerState> message, const char* what);

  const DaemonIdentity& identity_;
  TickPartner& ticks_;
  LeaderLease lease_;
  Actions actions_;
  dds_entity_t ticks_writer_, states_writer_, ticks_reader_, states_reader_, reports_reader_,
      catalogues_reader_, scenes_writer_, scenes_reader_;
  DataWait wait_;
  PartnerReports reports_;
  LeastDelay delay_;
  std::atomic<std::uint64_t> partner_revision_{0};
  std::uint64_t leader_ = 0, leader_revision_ = 0;  // of the last notice that was heard
  std::int64_t leader_heard_ns_ = 0;
  std::int64_t passed_ns_ = 0;   // when the last pass of hear_notices() began, CLOCK_MONOTONIC
  std::int64_t went_on_ns_ = 0;  // when this process went on after a stop, CLOCK_REALTIME
  bool is_delay_old_ = true;     // the next notice that did not wait begins a new least delay
  std::uint64_t offered_ = 0;    // the revision that take_cell() got last
  std::int64_t offered_ns_ = 0;
  std::int64_t asked_ns_ = 0, told_ns_ = 0, refusal_told_ns_ = 0;
  std::uint64_t refused_told_ = 0;  // notices
  bool clock_told_ = false, refusal_told_ = false;
  PartnerStanding told_ = PartnerStanding::kStarting;
  Sample<clearance_msg_PartnerTick> heard_, written_;
  Sample<clearance_msg_PartnerState> state_;
  Sample<clearance_msg_Distances> report_;
  Sample<clearance_msg_Catalogue> catalogue_, heard_catalogue_;
  Sample<clearance_msg_PartnerScene> scene_, heard_scene_;
  bool is_scene_new_ = false;
  TickNotice notice_;
  std::atomic<bool> stop_{false};
  std::thread hearing_, writing_;
};

}  // namespace clearance
