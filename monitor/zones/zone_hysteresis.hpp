// Is some pair of the zone too near? With hysteresis, on what is certain: lower bounds less
// margins.
#pragma once

#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

// Lower bounds of one pair's distance or of several, m.
struct Clearance {
  double now = kInfinity;
  double since = kInfinity;  // at every instant since the last tick
};

// Takes a zone's report from the last tick to this one, pair by pair. Active when some pair's
// clearance since the last tick is below enter_below; no longer when every pair's is above
// leave_above.
class ZoneHysteresis {
 public:
  ZoneHysteresis(const Zone& zone, const ZoneReport& before) noexcept;

  // One of the zone's pairs, and what both its margins are at most, m.
  void add(std::uint32_t pair, const PairBounds& bounds, double margins) noexcept;

  // Pairs of the zone that need not be named one by one: each has at least this clearance. `pair`
  // is one of them.
  void add_rest(const Clearance& clearance, std::uint32_t pair) noexcept;

  // `report`: that of the last tick becomes that of this one.
  void finish(std::uint64_t cycle, ZoneReport& report) const noexcept;

  // The least clearance that is outside, m.
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

 private:
  // The pair could neither enter the zone nor keep it active.
  [[nodiscard]] bool outside(double clearance) const noexcept { return clearance >= threshold_; }
  [[nodiscard]] bool proves(const Clearance& clearance, double margins,
                            const PairBounds& bounds) const noexcept;
  void take(const Clearance& clearance, std::uint32_t pair) noexcept;

  bool was_active_;
  double threshold_;
  bool proved_ = true;
  Clearance least_;
  std::uint32_t pair_, swept_pair_;  // whose clearances those are
};

}  // namespace clearance
