// Decides whether some pair of a zone is too near, with hysteresis, by lower bounds less margins.
#pragma once

#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

// Lower bounds of the distance of one pair or of several, m.
struct Clearance {
  double now = kInfinity;
  double since = kInfinity;  // at every instant since the last tick
};

// Updates a zone's report from the last tick's to this tick's, pair by pair. The zone becomes
// active when some pair's clearance since the last tick is below enter_below. It becomes inactive
// when every pair's is above leave_above.
class ZoneHysteresis {
 public:
  ZoneHysteresis(const Zone& zone, const ZoneReport& before) noexcept;

  // Adds one of the zone's pairs. `margins`: the sum for both objects, rounded up, m.
  void add(std::uint32_t pair, const PairBounds& bounds, double margins) noexcept;

  // Adds pairs together that are not added one by one. Each of them has at least this clearance.
  // `pair` is one of them.
  void add_rest(const Clearance& clearance, std::uint32_t pair) noexcept;

  // Changes `report` from the last tick's to this tick's.
  void finish(std::uint64_t cycle, ZoneReport& report) const noexcept;

  // A pair with this clearance or more is outside, m.
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

 private:
  // A pair with this clearance neither enters the zone nor keeps it active.
  [[nodiscard]] bool outside(double clearance) const noexcept { return clearance >= threshold_; }
  [[nodiscard]] bool proves(const Clearance& clearance, double margins,
                            const PairBounds& bounds) const noexcept;
  void take(const Clearance& clearance, std::uint32_t pair) noexcept;

  bool was_active_;
  double threshold_;
  bool proved_ = true;
  Clearance least_;
  std::uint32_t pair_, swept_pair_;  // the pairs that have these clearances
};

}  // namespace clearance
