// Checks that zones change at the same ticks as recorded, and for the same reason.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Only changes between active and inactive count: a recording repeats states that did not change.
// Zones are those of one name, also where the scene was changed. A zone that a scene lacks is
// inactive.
class ZoneDifference {
 public:
  struct Found {
    std::uint64_t cycle;  // as recorded
    std::int64_t now_ns;
    std::string what;
  };

  // Scenes must outlive this.
  explicit ZoneDifference(const Scene& scene) { change(scene, 0); }

  // Another scene is in force from this recorded cycle on.
  void change(const Scene& scene, std::uint64_t from);

  // Every tick's report; its recorded cycle number is `cycle_offset` larger.
  void replayed(const Report& report, std::uint64_t cycle_offset);

  // The earliest change that only one side has, or that differs in any field but those of
  // `not_recorded` (DifferenceOptions).
  [[nodiscard]] std::optional<Found> first(const std::vector<clearance_msg_ZoneState>& recorded,
                                           const std::set<std::string>& not_recorded = {}) const;

 private:
  using States = std::vector<clearance_msg_ZoneState>;
  struct InForce {
    const Scene* scene;
    std::uint64_t from;  // the first recorded cycle
  };

  [[nodiscard]] const Scene& scene_at(std::uint64_t cycle) const;
  [[nodiscard]] bool is_of(const clearance_msg_ZoneState& state, const std::string& zone) const;
  [[nodiscard]] std::optional<Found> first_of(const std::string& zone, const States& ours,
                                              const States& theirs,
                                              const std::set<std::string>& not_recorded) const;
  [[nodiscard]] States changes_of(const States& recorded, const std::string& zone) const;
  [[nodiscard]] std::string described(const clearance_msg_ZoneState& state) const;

  std::vector<InForce> scenes_;
  struct Replayed {
    States changes = {};
    bool active = false;  // as every monitor begins
  };
  std::map<std::string, Replayed> replayed_;  // by zone
};

}  // namespace clearance
