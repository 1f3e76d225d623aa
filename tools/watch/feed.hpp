// The state of a client of the daemon: the latest sample of every topic, and counts of what it
// missed.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "config/scene.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::watch {

// The smallest distance that any report has shown.
struct Smallest {
  bool known = false;
  clearance_msg_PairDistance pair{};
  std::uint64_t cycle = 0;
};

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

  [[nodiscard]] std::uint64_t reports() const noexcept { return reports_; }
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }  // gaps in the cycles
  [[nodiscard]] std::uint64_t restarts() const noexcept {
    return restarts_;
  }  // cycles that began again
  [[nodiscard]] std::uint32_t publishers()
      const;  // of distances, right now; more than one is a mistake

  // Names from the catalogue, or ids as long as there is none.
  [[nodiscard]] std::string pair_name(const clearance_msg_PairDistance& pair) const;

 private:
  void take_distances(std::int64_t now_ns);
  void note_report();
  void begin_again();
  [[nodiscard]] std::string part_name(std::uint32_t object, std::uint32_t part) const;

  dds_entity_t distances_reader_, catalogue_reader_, health_reader_, zones_reader_;
  Sample<clearance_msg_Distances> distances_;
  Sample<clearance_msg_Catalogue> catalogue_;
  Sample<clearance_msg_Health> health_;
  bool has_catalogue_ = false, has_health_ = false;
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;
  Smallest smallest_;
  std::uint64_t reports_ = 0, missed_ = 0, restarts_ = 0;
  std::uint64_t cycle_ = 0, revision_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace clearance::watch
