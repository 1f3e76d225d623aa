// Compares every figure of a report with an oracle: bounds now and since the last tick, counts,
// ages, the minimum and zones.
#pragma once

#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/adversary/adversary.hpp"
#include "tests/monitor/adversary/oracle.hpp"

namespace clearance::test {

class Judge {
 public:
  // `budget_is_ample`: the budget covers all queries of any tick.
  Judge(const Scene& scene, const Oracle& oracle, Style style, bool budget_is_ample);

  // Checks one tick. If the report is false, the running test fails and the function returns false.
  [[nodiscard]] bool accepts(const Report& report, const Monitor& monitor, Adversary& adversary);

  // The number of zone states, counted per tick from the thirtieth on, that are active only as a
  // precaution.
  [[nodiscard]] int uncertain_zones() const { return uncertain_zones_; }

 private:
  void find_truth(Adversary& adversary);
  void judge_pairs(const Report& report, const Monitor& monitor);
  [[nodiscard]] bool is_bounded(std::uint32_t pair) const;
  void judge_bounds(std::uint32_t pair, const PairReport& report) const;
  void judge_age(std::uint32_t pair, const PairReport& report, std::uint64_t cycle);
  void judge_counts(const Report& report) const;
  void judge_minimum(const Report& report) const;
  void judge_zone(const Zone& zone, const ZoneReport& report, bool all_fresh);
  void judge_turns(const Report& report) const;

  const Scene& scene_;
  const Oracle& oracle_;
  const Style style_;
  const bool ample_;
  const RefreshShare share_;
  const long double rounding_;  // rounding of poses and of the oracle, m
  int tick_ = -1;
  // Distances by pair, m: in this tick, and the least at the tried instants since the last tick.
  std::vector<long double> now_, since_;
  // by pair: number of consecutive ticks in which it was known
  std::vector<std::uint64_t> known_for_;
  // numbers of evaluated, carried, stale and unknown pairs
  std::array<std::uint32_t, 4> counted_{};
  std::uint64_t stalest_ = 0;  // ticks
  int uncertain_zones_ = 0;
};

}  // namespace clearance::test
