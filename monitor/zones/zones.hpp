// The states of all zones from tick to tick, by the pairs that a tick has updated and by what is
// known of all others.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "config/scene/scene_map.hpp"
#include "monitor/bodies/tracked_object.hpp"
#include "monitor/inputs/state_bytes.hpp"
#include "monitor/zones/contacts.hpp"
#include "monitor/zones/zone_hysteresis.hpp"

namespace clearance {

class Zones {
 public:
  // Scene, levels and contacts must outlive it. Pairs that the contacts allow make no zone active.
  Zones(const Scene& scene, const ZoneLevels& levels, const Contacts& contacts);

  // Before the first tick: zones that the scene before had are as active as they were there. `map`
  // has the zones of both scenes.
  void take_over(const Zones& before, const SceneMap& map) noexcept;
  // The same through bytes, for the same scene.
  void save(StateWriter& out) const;
  void restore(StateReader& in) noexcept;

  // States after the last finish(), in scene order.
  [[nodiscard]] std::span<const ZoneReport> reports() const noexcept { return reports_; }

  // True if the pair belongs to a zone.
  [[nodiscard]] bool watch(std::uint32_t pair) const noexcept { return levels_.has(pair); }

  // Considers the zones of the pair that it is outside by `lower` but not by `swept_lower`. Returns
  // the largest of their thresholds, m, or -infinity if there is no such zone. While a contact of
  // the pair is in force, minus its depth takes the place of all thresholds.
  [[nodiscard]] double undecided(std::uint32_t pair, double lower,
                                 double swept_lower) const noexcept;

  // Call this between ticks when objects have become absent or present. A pair belongs to no zone
  // while one of its objects is absent.
  void count_absent(std::span<const TrackedObject> objects) noexcept;

  // Adds an updated pair. Call it once per tick for each.
  void add(std::uint32_t pair, const PairBounds& bounds) noexcept;

  // Ends the tick. A pair that was not added is in one of three states. It is absent or unknown; or
  // it was outside its zones since the last tick; or it waits. `waiting` is a lower bound of the
  // distance of pairs that wait, margins not subtracted. `any_lost`: an object is not known or has
  // made a discontinuity.
  void finish(std::span<const TrackedObject> objects, const Clearance& waiting, bool any_lost,
              std::uint64_t cycle) noexcept;
  // After finish(), with all objects: finds why each zone is active.
  void explain(std::span<const TrackedObject> objects) noexcept;

 private:
  void begin_tick() noexcept;
  void add_lost(std::uint32_t zone, std::span<const TrackedObject> objects) noexcept;
  [[nodiscard]] std::optional<std::uint32_t> present_pair(
      std::uint32_t zone, std::uint32_t preferred, std::uint32_t object,
      std::span<const TrackedObject> objects) const noexcept;

  const Scene& scene_;
  const ZoneLevels& levels_;
  const Contacts& contacts_;
  // By zone.
  std::vector<ZoneReport> reports_;      // of the last tick: whether it was active, and since when
  std::vector<ZoneHysteresis> updates_;  // from there to this tick
  std::vector<std::uint32_t> added_;     // pairs, in this tick
  std::vector<std::uint32_t> absent_;    // pairs with an absent object
};

}  // namespace clearance
