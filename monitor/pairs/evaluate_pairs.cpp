#include "monitor/pairs/evaluate_pairs.hpp"

#include <algorithm>

namespace clearance {
namespace {

// A claim is about 2 us of queries. Another thread takes 5 to 50 us to wake, so loops that end
// before that are not shared.
constexpr WorkerPool::Share kShare{.claim = 16, .least = 128};

// How many of the first pairs the budget covers, whatever each of them takes.
std::size_t covered(std::span<const std::uint32_t> pairs, const PairTable& table,
                    const Budget& budget) noexcept {
  std::uint32_t left = budget.left();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t part_pairs = table.part_pairs_of(pairs[i]);
    if (part_pairs > left) return i;
    left -= part_pairs;
  }
  return pairs.size();
}

// How many queries the evaluation of a pair took.
std::uint32_t queries_of(std::uint32_t pair, const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  if (table.part_pairs_of(pair) == 1) return 1;
  const auto first = table.part_pair_evaluated_cycle.begin() + table.entries[pair].first_part_pair;
  const auto end = table.part_pair_evaluated_cycle.begin() + table.entries[pair].end_part_pair;
  return static_cast<std::uint32_t>(std::count(first, end, view.cycle));
}

}  // namespace

std::size_t evaluate_pairs(std::span<const std::uint32_t> pairs, WorkerPool& pool,
                           const OpenTick& tick, Budget& budget) noexcept {
  std::size_t done = 0;
  while (done < pairs.size() && budget.left() > 0) {
    const auto batch = pairs.subspan(done, covered(pairs.subspan(done), tick.pairs, budget));
    if (batch.empty()) {  // the budget may end within this pair
      evaluate_pair(pairs[done++], tick, budget);
      continue;
    }
    const auto one = [&tick, &budget, batch](std::uint32_t i) noexcept {
      Budget enough = budget;
      evaluate_pair(batch[i], tick, enough);
    };
    pool.run(static_cast<std::uint32_t>(batch.size()), kShare, one);
    for (const std::uint32_t pair : batch) budget.spend(queries_of(pair, tick));
    done += batch.size();
  }
  return done;
}

}  // namespace clearance
