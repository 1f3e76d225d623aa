// Detects whether another daemon publishes the same cell: it listens on this daemon's topic for
// reports of other writers.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "monitor/dds/daemon_identity.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

// When two daemons publish, the one that started later stops at the first report that it hears from
// the other. A silent writer does not displace this daemon: its process may be dead, stopped or
// hung. A partner publishes beside this daemon; of three partners, the one that started last stops.
// One thread calls poll(), have_just_left() and are_present(); any thread may call the rest.
class OtherDaemons {
 public:
  // `own` publishes on the distances topic of this name through this participant, whose writers are
  // ignored.
  OtherDaemons(Participant& participant, const std::string& topic, DaemonIdentity own);
  ~OtherDaemons();
  OtherDaemons(const OtherDaemons&) = delete;
  OtherDaemons& operator=(const OtherDaemons&) = delete;

  // Takes the reports that came since the last call. Without any, it costs 0.2 us and no system
  // call.
  void poll();
  // True once after other writers have left: latched topics then hold their last samples.
  [[nodiscard]] bool have_just_left() noexcept { return std::exchange(left_, false); }

  // Whether a writer that is not of a partner is there, a silent one included.
  [[nodiscard]] bool are_present() const noexcept { return met_.size() > partners_.size(); }

  // Another daemon started first, so nothing more may be published.
  [[nodiscard]] bool yields() const noexcept { return yields_.load(); }
  // Reports of other daemons since the start.
  [[nodiscard]] std::uint64_t reports() const noexcept { return reports_.load(); }
  // The number of other writers since the start, silent ones included.
  [[nodiscard]] std::uint64_t writers() const noexcept { return writers_.load(); }

 private:
  void note_writers();
  void meet(dds_instance_handle_t writer, bool heard);
  void note_partner(dds_instance_handle_t writer, const DaemonIdentity& partner);
  [[nodiscard]] bool has_met(dds_instance_handle_t writer) const;

  DaemonIdentity own_;
  std::string topic_;
  std::atomic<bool> changed_{false};  // writers have come or left
  dds_entity_t reader_;
  std::vector<CdrSample> taken_;
  std::vector<dds_instance_handle_t> met_;  // those that are still present
  struct Partner {
    dds_instance_handle_t writer;
    DaemonIdentity identity;
  };
  std::vector<Partner> partners_;  // of those
  bool left_ = false;
  std::atomic<std::uint64_t> reports_{0}, writers_{0};
  std::atomic<bool> yields_{false};
};

}  // namespace clearance
