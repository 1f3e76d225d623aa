// Stage 'cull' of a tick: decides which pairs must be updated, and bounds all others.
//
// Keeps the broad phase's decisions and its horizon. Updates the active pairs: their bounds are
// carried to this tick. Bounds the pairs that have just become active by the models of their
// objects, from coarse to fine. A pair that these models prove far is culled again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/bodies/displacements.hpp"
#include "monitor/pairs/hull_bound.hpp"
#include "monitor/pairs/known_pairs.hpp"
#include "monitor/schedule/broad_phase.hpp"
#include "monitor/schedule/untouched_pairs.hpp"

namespace clearance {

class Culling {
 public:
  // `urgent` and `left_out` are passed on to BroadPhase, whose constructor explains them, and
  // `known` to HullBound.
  Culling(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
          const ZoneLevels& zone_levels, std::vector<double> urgent,
          std::span<const std::uint32_t> left_out, const RefreshShare& share,
          const KnownHulls& known = {});

  [[nodiscard]] std::span<const BoundingHull> hulls() const noexcept { return hulls_.hulls(); }

  // Call this between ticks when an object has become absent.
  void forget_object(std::uint32_t object, PairTable& table) noexcept {
    broad_phase_.forget_object(object, table);
  }

  // The stage. `changed` is that of Displacements. `last_minimum`: the smallest upper bound of any
  // pair at the last tick, m, which the horizon follows.
  void cull(std::span<const std::uint32_t> changed, double last_minimum, const OpenTick& tick,
            Budget& budget) noexcept;
  // The end of the tick's evaluations: culls the active pairs whose bounds are good enough now.
  void cull_active(const TickView& view) noexcept;

  // True if no untouched pair can be closer than `minimum`, m, or if there is no horizon to raise.
  [[nodiscard]] bool covers(double minimum) const noexcept;
  // Raises the horizon to just above `minimum`, by no more than `step`, m, and decides about the
  // pairs that this activates, as the stage does.
  void raise_horizon(double minimum, double step, const OpenTick& tick, Budget& budget) noexcept;
  // The height of the horizon above the minimum, m.
  static constexpr double kHeadroom = 0.02;

  // Carries a known pair's bounds to this tick.
  void update(std::uint32_t pair, const OpenTick& tick) noexcept;
  // Records that a pair's bounds have been brought to this tick.
  void mark_updated(std::uint32_t pair) noexcept;
  // Proves by its objects' models that a known pair is neither the minimum nor in a zone. The
  // queries leave `kept` of the budget. False: the models do not prove it.
  [[nodiscard]] bool prove_far(std::uint32_t pair, std::uint32_t kept, const OpenTick& tick,
                               Budget& budget) noexcept;

  // The pairs whose bounds are of this tick, each once.
  [[nodiscard]] std::span<const std::uint32_t> updated() const noexcept { return updated_; }
  // The bounds of all other known pairs.
  [[nodiscard]] UntouchedPairs untouched(const Displacements& displaced) const noexcept;
  // Pairs that are not culled and not left out: updated if they are known.
  [[nodiscard]] std::span<const std::uint32_t> active() const noexcept { return active_; }

  // An activated pair that the last cull() or raise_horizon() has decided about.
  struct Decided {
    std::uint32_t pair : 31;
    std::uint32_t proved_far : 1;  // by models of its objects, for the poses of this tick
  };
  [[nodiscard]] std::span<const Decided> decided() const noexcept { return decided_; }

  [[nodiscard]] const BroadPhase& broad_phase() const noexcept { return broad_phase_; }
  [[nodiscard]] const KnownPairs& known_pairs() const noexcept { return known_; }

 private:
  template <class Enough>
  [[nodiscard]] bool bound_by_models(std::uint32_t pair, std::uint32_t kept, const OpenTick& tick,
                                     Budget& budget, const Enough& enough) noexcept;
  void follow(double minimum) noexcept;
  void set_first_horizon() noexcept;
  void decide_activated(const OpenTick& tick, Budget& budget) noexcept;

  const std::uint32_t least_left_;  // of the budget, by queries of models
  KnownPairs known_;
  BroadPhase broad_phase_;
  HullBound hulls_;
  LargeColumn<std::uint8_t> is_updated_;  // by pair
  // Each with capacity for all pairs.
  std::vector<std::uint32_t> active_, updated_;
  std::vector<Decided> decided_;
};

}  // namespace clearance
