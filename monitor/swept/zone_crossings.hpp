// Which pairs are outside their zones now, but may have been inside between two ticks? Those are
// looked at closer, until it is decided or the budget ends.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/swept/swept_search.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

// How near a known pair was at any instant since the last tick, looked at closer until `level` is
// decided, m, or the budget ends; for where its objects may have been. Nothing: infinite.
[[nodiscard]] SweptBounds passage_of(std::uint32_t pair, double level,
                                     Evaluation& evaluation) noexcept;

class ZoneCrossings {
 public:
  // `most`: pairs that a tick can look at closer.
  explicit ZoneCrossings(std::size_t most) { decided_.reserve(most); }

  void begin() noexcept { decided_.clear(); }

  // A known pair whose rows are up to date; once a tick.
  void decide(std::uint32_t pair, const Zones& zones, Evaluation& evaluation) noexcept {
    if (!is_far(pair, zones.outside_from(pair), evaluation)) look_at(pair, zones, evaluation);
  }

  // After the last of them.
  void finish() noexcept;

  // What looking closer has told about a pair this tick, for where its objects may have been.
  // Nothing: infinite.
  [[nodiscard]] SweptBounds of(std::uint32_t pair) const noexcept;
  // About any pair.
  [[nodiscard]] bool any() const noexcept { return !decided_.empty(); }

 private:
  // Most pairs are decided by less than what is known.
  [[nodiscard]] static bool is_far(std::uint32_t pair, double outside_from,
                                   const Evaluation& evaluation) noexcept {
    if (outside_from == -kInfinity) return true;  // of what?
    const PairEntry& entry = evaluation.table.entries[pair];
    const TrackedObject& a = evaluation.objects[entry.object_a];
    const TrackedObject& b = evaluation.objects[entry.object_b];
    const double strayed = 2.0 * (a.travel + b.travel) + (a.unseen_since + b.unseen_since);
    return rounded_down(entry.least_lower - rounded_up(strayed)) >= outside_from;
  }
  void look_at(std::uint32_t pair, const Zones& zones, Evaluation& evaluation) noexcept;
  struct Decided {
    std::uint32_t pair;
    SweptBounds bounds;
  };
  std::vector<Decided> decided_;  // by pair, once finished
};

}  // namespace clearance
