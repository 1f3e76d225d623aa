// Finds the pairs that are outside their zones now but may have been inside between two ticks. Each
// of them is searched more closely, until that is decided or the budget ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/pairs/budget.hpp"
#include "monitor/schedule/swept_bounds.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

// Bounds of a known pair's distance at any instant since the last tick, for where its objects may
// have been. The search ends when `level`, m, is decided, or the budget ends. Infinite: no bounds
// were found.
[[nodiscard]] SweptBounds swept_bounds_of(std::uint32_t pair, double level, const TickView& view,
                                          Budget& budget) noexcept;

class ZoneCrossings {
 public:
  // `most`: the largest number of pairs that a tick can search more closely.
  explicit ZoneCrossings(const ZoneLevels& levels, std::size_t most) : levels_(levels) {
    crossings_.reserve(most);
  }

  // Stage 'cross' of a tick: begins the tick's list with those among the `updated` pairs.
  void find(std::span<const std::uint32_t> updated, const Zones& zones,
            const TickView& view) noexcept;

  // The number of queries to keep for the sweep of the pairs found so far. It is the most that they
  // take if in each pair only one part pair needs a search.
  [[nodiscard]] std::uint32_t queries() const noexcept;

  // Stage 'sweep' of a tick: adds the pairs that have been updated since find(), and decides all of
  // them, as far as the budget goes.
  void sweep(std::span<const std::uint32_t> updated, const Zones& zones, const TickView& view,
             Budget& budget) noexcept;

  // The bounds that this tick's sweep has found for a pair; infinite where it found none.
  [[nodiscard]] SweptBounds of(std::uint32_t pair) const noexcept;
  // The sweep has searched some pair.
  [[nodiscard]] bool any() const noexcept { return !crossings_.empty(); }

 private:
  // A pair that is outside its zones by its bound of now, `now`, m, but not by its swept bound.
  struct Crossing {
    std::uint32_t pair;
    double now;
    SweptBounds bounds;
  };
  void find_more(std::span<const std::uint32_t> updated, const Zones& zones,
                 const TickView& view) noexcept;
  void examine(std::uint32_t pair, const Zones& zones, const TickView& view) noexcept;
  static void decide(const Zones& zones, const TickView& view, Budget& budget,
                     Crossing& crossing) noexcept;

  const ZoneLevels& levels_;
  std::size_t examined_ = 0;         // how many of the updated pairs
  std::vector<Crossing> crossings_;  // in ascending order of pairs after the sweep
};

}  // namespace clearance
