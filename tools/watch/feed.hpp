// The state of a client of the daemon: the latest sample of every topic, and counts of its losses.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "monitor/client/client.hpp"
#include "monitor/client/share_names.hpp"

namespace clearance::watch {

// Reports that are older than this when they are taken are called old: five frames of the screen.
inline constexpr std::chrono::milliseconds kOldReport(500);

// The smallest distance of all reports, without stale ones.
struct Smallest {
  bool known = false;
  clearance_msg_PairDistance pair{};
  std::string name;  // of the pair: a later cell may give its id to another one
  std::uint64_t cycle = 0;
};

// Reports that were old when they were taken.
struct OldReports {
  std::uint64_t count = 0;
  std::int64_t oldest_ns = 0;  // its age
  std::int64_t last_ns = 0;    // when the last of them was taken, CLOCK_REALTIME
};

// The number of reports that were handed out in each client::PartnerState.
using PartnerCounts = std::array<std::uint64_t, 6>;

// The last state stays while no daemon publishes.
class Feed {
 public:
  explicit Feed(client::Connection& connection);

  // Takes all samples that have arrived; `now_ns` is CLOCK_REALTIME.
  void take(std::int64_t now_ns);

  // True when a report has come, and the time of the last one.
  [[nodiscard]] bool any() const noexcept { return count_ > 0; }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  [[nodiscard]] const clearance_msg_Distances& distances() const noexcept { return *reports_; }
  // Null until a catalogue for the scene of the latest report has arrived.
  [[nodiscard]] const clearance_msg_Catalogue* catalogue() const noexcept;
  [[nodiscard]] const clearance_msg_Health* health() const noexcept;
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& zones() const noexcept {
    return zones_.states();
  }
  // Null if no zone has `separation`, or if no such message of this daemon has come.
  [[nodiscard]] const clearance_msg_Separation* separation() const noexcept {
    const bool is_of_it = separation_->daemon == reports_->daemon || has_partner();
    return separation_->cycle != 0 && is_of_it ? &*separation_ : nullptr;
  }
  [[nodiscard]] const Smallest& smallest() const noexcept { return smallest_; }

  // The check of the latest report.
  [[nodiscard]] const ReportCheck& check() const noexcept { return reports_.check(); }
  [[nodiscard]] const OldReports& old_reports() const noexcept { return old_; }
  [[nodiscard]] std::uint64_t reports() const noexcept { return count_; }
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }  // gaps in the cycles
  [[nodiscard]] std::uint64_t restarts() const noexcept {
    return restarts_;
  }  // cycles that began again
  // The number of writers of distances that are alive: they wrote within their leases. More than
  // one is a mistake.
  [[nodiscard]] std::uint32_t publishers() const { return reports_.daemons(); }
  // The reason why the reports of a present daemon do not come; empty when none is known.
  [[nodiscard]] std::string refusal() const { return reports_.refusal(); }
  // The messages of other topics that are not as the daemon wrote them; empty: none came.
  [[nodiscard]] std::string refused() const {
    return client::text_of({catalogue_.refused(), health_.refused(), zones_.refused()});
  }
  // While no report has come: the shares of a cell whose daemons are there (SHARES.md).
  [[nodiscard]] std::set<std::string> shares() const;
  // Says whether the daemons are partners, whose reports are merged, and whether the two agree. The
  // worst state of a second is shown for as long, since a screen shows few reports.
  [[nodiscard]] bool has_partner() const noexcept { return *reports_->partner != '\0'; }
  [[nodiscard]] const client::PartnerCheck& partner() const noexcept { return partner_; }
  [[nodiscard]] const PartnerCounts& partner_counts() const noexcept { return partner_counts_; }
  // True when there is no daemon any longer, not even one that hangs.
  [[nodiscard]] bool has_ended() const { return reports_.has_ended(); }

  // Names from the catalogue; ids while there is none.
  [[nodiscard]] std::string pair_name(const clearance_msg_PairDistance& pair) const;
  [[nodiscard]] std::string pair_name(std::uint32_t pair) const;
  [[nodiscard]] std::string zone_name(std::uint32_t zone) const;
  [[nodiscard]] std::string robot_name(std::uint32_t robot) const;
  [[nodiscard]] std::string object_name(std::uint32_t object) const;

 private:
  void note_report(std::int64_t now_ns);
  void begin_again();

  client::Reports reports_;
  client::Catalogue catalogue_;
  client::Health health_;
  client::Zones zones_;
  client::Separation separation_;
  Smallest smallest_;
  std::uint64_t count_ = 0, missed_ = 0, restarts_ = 0;
  OldReports old_;
  client::PartnerCheck partner_;
  PartnerCounts partner_counts_{};
  std::int64_t partner_ns_ = 0;                 // when partner_ came
  std::unique_ptr<client::ShareNames> shares_;  // null after a report has come
  std::set<std::uint64_t> daemons_;             // daemons whose reports have come
  std::int64_t last_ns_ = 0;
};

}  // namespace clearance::watch
