// Stage 3 of a tick: which pairs must be looked at, and what holds of all others?
//
// Keeps the broad phase's decisions and its horizon, looks at the pairs that are active (their
// bounds are carried to this tick), and bounds those that have just become active by the models of
// their objects, from coarse to fine: one that these prove far is culled again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/broad_phase/broad_phase.hpp"
#include "monitor/broad_phase/unseen_pairs.hpp"
#include "monitor/objects/displacements.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/hull_bound.hpp"
#include "monitor/pairs/known_pairs.hpp"

namespace clearance {

class Culling {
 public:
  // `urgent` and `left_out`: as BroadPhase has them.
  Culling(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
          const ZoneLevels& zone_levels, std::vector<double> urgent,
          std::span<const std::uint32_t> left_out, const RefreshShare& share);

  // The stage. `changed`: as Displacements has it. `last_minimum`: the smallest upper bound of any
  // pair at the last tick, m, which the horizon follows.
  void cull(std::span<const std::uint32_t> changed, double last_minimum,
            Evaluation& evaluation) noexcept;

  // No unseen pair can be closer than `minimum`, m, or there is no horizon to raise.
  [[nodiscard]] bool covers(double minimum) const noexcept;
  // Raises the horizon to just above `minimum`, by no more than `step`, m, and looks at the pairs
  // that this activates, as the stage does.
  void raise_horizon(double minimum, double step, Evaluation& evaluation) noexcept;
  // How far the horizon is kept above the minimum, m.
  static constexpr double kHeadroom = 0.02;

  // A pair's bounds have been brought to this tick.
  void see(std::uint32_t pair) noexcept;
  // Carries a known pair's bounds to this tick.
  void look_at(std::uint32_t pair, const Evaluation& evaluation) noexcept;
  // Proves a known pair out of question by its objects' models, its queries leaving `kept` of the
  // budget. False: they do not tell.
  [[nodiscard]] bool refresh_by_models(std::uint32_t pair, std::uint32_t kept,
                                       Evaluation& evaluation) noexcept;
  // Culls the active pairs whose bounds are good enough now.
  void cull_active(const Evaluation& evaluation) noexcept;

  // Of this tick: pairs whose bounds are up to date, each once;
  [[nodiscard]] std::span<const std::uint32_t> seen() const noexcept { return seen_; }
  // what holds of all others that are known.
  [[nodiscard]] UnseenPairs unseen(const Displacements& displaced) const noexcept;
  // Not culled and not left out: seen if they are known.
  [[nodiscard]] std::span<const std::uint32_t> active() const noexcept { return active_; }

  // An activated pair that has been decided about, by the last cull() or raise_horizon().
  struct Decided {
    std::uint32_t pair;
    bool proved_far;  // by models of its objects, afresh
  };
  [[nodiscard]] std::span<const Decided> decided() const noexcept { return decided_; }

  [[nodiscard]] const BroadPhase& broad_phase() const noexcept { return broad_phase_; }
  [[nodiscard]] const KnownPairs& known_pairs() const noexcept { return known_; }

 private:
  template <class Enough>
  [[nodiscard]] bool by_models(std::uint32_t pair, std::uint32_t kept, Evaluation& evaluation,
                               const Enough& enough) noexcept;
  void follow(double minimum) noexcept;
  void find_horizon() noexcept;
  void decide_activated(Evaluation& evaluation) noexcept;

  const std::uint32_t least_left_;  // of the budget, by queries of models
  KnownPairs known_;
  BroadPhase broad_phase_;
  HullBound hulls_;
  std::vector<std::uint8_t> is_seen_;  // by pair
  // Each with room for all pairs.
  std::vector<std::uint32_t> active_, seen_;
  std::vector<Decided> decided_;
};

}  // namespace clearance
