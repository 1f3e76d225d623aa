// The states of all zones, from tick to tick: from the pairs that a tick has looked at and what is
// known of the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/objects/tracked_object.hpp"
#include "monitor/zones/zone_hysteresis.hpp"

namespace clearance {

class Zones {
 public:
  // Scene and levels must outlive it.
  Zones(const Scene& scene, const ZoneLevels& levels);

  // As of the last finish(), in scene order.
  [[nodiscard]] std::span<const ZoneReport> reports() const noexcept { return reports_; }

  // The farthest distance below which the pair is inside a zone, of the zones that it is outside of
  // with `lower`, m, but not with `swept_lower`. -infinity: there is none.
  [[nodiscard]] double undecided(std::uint32_t pair, double lower,
                                 double swept_lower) const noexcept;

  // A pair that this tick has looked at; once.
  void add(std::uint32_t pair, const PairBounds& bounds) noexcept;

  // What was not added: farther than its zones watch for since the last tick, at least `waiting`
  // apart where that is less (margins not subtracted), or unknown. `objects`: none where all are
  // known and none has made a discontinuity. Ends the tick.
  void finish(std::span<const TrackedObject> objects, const Clearance& waiting,
              std::uint64_t cycle) noexcept;
  // After finish(), with all objects: why each zone is active.
  void explain(std::span<const TrackedObject> objects) noexcept;

 private:
  void begin_tick() noexcept;

  const Scene& scene_;
  const ZoneLevels& levels_;
  // By zone.
  std::vector<ZoneReport> reports_;      // of the last tick: whether it was active, and since when
  std::vector<ZoneHysteresis> updates_;  // from there to this tick
  std::vector<std::uint32_t> added_;
};

}  // namespace clearance
