// The state of a client of the daemon: the latest sample of every topic, and counts of what it
// missed.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "config/scene.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/report_check.hpp"

namespace clearance::watch {

// Reports that are older than this when they are taken are called old: five frames of the screen.
inline constexpr std::int64_t kOldReportNs = 500'000'000;

// The smallest distance that any report has shown; stale ones do not count.
struct Smallest {
  bool known = false;
  clearance_msg_PairDistance pair{};
  std::uint64_t cycle = 0;
};

// Reports that were old when they were taken.
struct OldReports {
  std::uint64_t count = 0;
  std::int64_t oldest_ns = 0;  // its age
  std::int64_t last_ns = 0;    // when the last of them was taken, CLOCK_REALTIME
};

// What is shown stays as it was last while no daemon publishes.
class Feed {
 public:
  Feed(Participant& participant, const Topics& topics);

  // Takes all samples that have arrived; `now_ns` is CLOCK_REALTIME.
  void take(std::int64_t now_ns);

  // Whether a report ever came, and when the last one did.
  [[nodiscard]] bool any() const noexcept { return reports_ > 0; }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  [[nodiscard]] const clearance_msg_Distances& distances() const noexcept { return *distances_; }
  // Null until a catalogue for the scene of the latest report has arrived.
  [[nodiscard]] const clearance_msg_Catalogue* catalogue() const noexcept;
  [[nodiscard]] const clearance_msg_Health* health() const noexcept;
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  [[nodiscard]] const Smallest& smallest() const noexcept { return smallest_; }

  // What is to be known of the latest report itself.
  [[nodiscard]] const ReportCheck& check() const noexcept { return check_; }
  [[nodiscard]] const OldReports& old_reports() const noexcept { return old_; }
  [[nodiscard]] std::uint64_t reports() const noexcept { return reports_; }
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }  // gaps in the cycles
  [[nodiscard]] std::uint64_t restarts() const noexcept {
    return restarts_;
  }  // cycles that began again
  // Writers of distances that are alive: they have written within their leases. More than one is a
  // mistake.
  [[nodiscard]] std::uint32_t publishers() const;
  // None is there any longer, not even one that stands still.
  [[nodiscard]] bool has_ended() const;

  // Names from the catalogue, or ids as long as there is none.
  [[nodiscard]] std::string pair_name(const clearance_msg_PairDistance& pair) const;
  [[nodiscard]] std::string object_name(std::uint32_t object) const;

 private:
  void take_distances(std::int64_t now_ns);
  void note_report(std::int64_t now_ns);
  void begin_again();
  [[nodiscard]] std::string part_name(std::uint32_t object, std::uint32_t part) const;

  dds_entity_t distances_reader_, catalogue_reader_, health_reader_, zones_reader_;
  // The latest, and what the next is taken into: Cyclone clears a sample when a writer leaves.
  Sample<clearance_msg_Distances> distances_, next_distances_;
  Sample<clearance_msg_Catalogue> catalogue_, next_catalogue_;
  Sample<clearance_msg_Health> health_, next_health_;
  bool has_catalogue_ = false, has_health_ = false;
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;
  Smallest smallest_;
  std::uint64_t reports_ = 0, missed_ = 0, restarts_ = 0;
  ReportChecker checker_{kOldReportNs};
  ReportCheck check_;
  OldReports old_;
  std::set<std::uint64_t> daemons_;  // whose reports have come
  std::int64_t last_ns_ = 0;
};

}  // namespace clearance::watch
