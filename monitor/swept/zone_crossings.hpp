// Which pairs are outside their zones now, but may have been inside between two ticks? Those are
// looked at closer, until it is decided or the budget ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/swept/swept_search.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

// How near a known pair was at any instant since the last tick, looked at closer until `level` is
// decided, m, or the budget ends; for where its objects may have been. Nothing: infinite.
[[nodiscard]] SweptBounds swept_bounds_of(std::uint32_t pair, double level,
                                          Evaluation& evaluation) noexcept;

class ZoneCrossings {
 public:
  // `most`: pairs that a tick can look at closer.
  explicit ZoneCrossings(const ZoneLevels& levels, std::size_t most) : levels_(levels) {
    crossings_.reserve(most);
  }

  void begin_tick() noexcept {
    crossings_.clear();
    looked_at_ = 0;
  }

  // Finds those among `seen`, the known pairs whose bounds are of this tick, from where the last
  // call of this tick ended.
  void find(std::span<const std::uint32_t> seen, const Zones& zones,
            const Evaluation& evaluation) noexcept;

  // That deciding them takes at most, where all but one part pair each are clear.
  [[nodiscard]] std::uint32_t queries() const noexcept {
    return static_cast<std::uint32_t>(crossings_.size()) * SweptSearch::kMostQueries;
  }

  // Stage 6 of a tick: finds the rest of them and decides all, as far as the budget goes.
  void sweep(std::span<const std::uint32_t> seen, const Zones& zones,
             Evaluation& evaluation) noexcept;

  // What looking closer has told about a pair this tick, for where its objects may have been.
  // Nothing: infinite.
  [[nodiscard]] SweptBounds of(std::uint32_t pair) const noexcept;
  // About any pair.
  [[nodiscard]] bool any() const noexcept { return !crossings_.empty(); }

 private:
  // A pair that is outside its zones with `now`, m, but not with the swept bound that is known.
  struct Crossing {
    std::uint32_t pair;
    double now;
    SweptBounds bounds;
  };
  // Most pairs are decided by less than what is known.
  [[nodiscard]] static bool is_far(std::uint32_t pair, double threshold,
                                   const Evaluation& evaluation) noexcept {
    if (threshold == -kInfinity) return true;  // of what?
    const PairEntry& entry = evaluation.table.entries[pair];
    const TrackedObject& a = evaluation.objects[entry.object_a];
    const TrackedObject& b = evaluation.objects[entry.object_b];
    const double displaced =
        2.0 * (a.displacement + b.displacement) + (a.unseen_since + b.unseen_since);
    return rounded_down(entry.least_lower - rounded_up(displaced)) >= threshold;
  }
  void look_at(std::uint32_t pair, const Zones& zones, const Evaluation& evaluation) noexcept;
  static void decide(const Zones& zones, Evaluation& evaluation, Crossing& crossing) noexcept;

  const ZoneLevels& levels_;
  std::size_t looked_at_ = 0;        // of the pairs seen in this tick
  std::vector<Crossing> crossings_;  // by pair, once swept
};

}  // namespace clearance
