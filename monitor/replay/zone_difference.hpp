// Checks that zones change at the same ticks as recorded, and for the same reason.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/report.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Only changes between active and inactive count: a recording repeats states that did not change.
class ZoneDifference {
 public:
  struct Found {
    std::uint64_t cycle;  // as recorded
    std::int64_t now_ns;
    std::string what;
  };

  explicit ZoneDifference(const Scene& scene) : scene_(scene), changes_(scene.zones.size()) {}

  // Every tick's report; its recorded cycle number is `cycle_offset` larger.
  void replayed(const Report& report, std::uint64_t cycle_offset);

  // The earliest change that only one side has, or that differs in any field but those of
  // `not_recorded` (DifferenceOptions).
  [[nodiscard]] std::optional<Found> first(const std::vector<clearance_msg_ZoneState>& recorded,
                                           const std::set<std::string>& not_recorded = {}) const;

 private:
  [[nodiscard]] std::optional<Found> first_of(std::uint32_t zone,
                                              const std::vector<clearance_msg_ZoneState>& theirs,
                                              const std::set<std::string>& not_recorded) const;

  const Scene& scene_;
  std::vector<std::vector<clearance_msg_ZoneState>> changes_;  // by zone
};

}  // namespace clearance
