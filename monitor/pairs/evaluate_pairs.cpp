#include "monitor/pairs/evaluate_pairs.hpp"

#include <algorithm>

namespace clearance {
namespace {

// A claim is about 2 us of queries; what is over before another thread has woken, which takes 5 to
// 50 us, is not worth sharing.
constexpr WorkerPool::Share kShare{.claim = 16, .least = 128};

// How many of them the budget covers whatever each of them takes.
std::size_t covered(std::span<const std::uint32_t> pairs, const Evaluation& evaluation) noexcept {
  std::uint32_t left = evaluation.budget.left();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t part_pairs = evaluation.table.part_pairs_of(pairs[i]);
    if (part_pairs > left) return i;
    left -= part_pairs;
  }
  return pairs.size();
}

// That evaluating a pair once took.
std::uint32_t queries_of(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (table.part_pairs_of(pair) == 1) return 1;
  const auto first = table.part_pair_evaluated_cycle.begin() + table.entries[pair].first_part_pair;
  const auto end = table.part_pair_evaluated_cycle.begin() + table.entries[pair].end_part_pair;
  return static_cast<std::uint32_t>(std::count(first, end, evaluation.cycle));
}

}  // namespace

std::size_t evaluate(std::span<const std::uint32_t> pairs, WorkerPool& pool,
                     Evaluation& evaluation) noexcept {
  std::size_t done = 0;
  while (done < pairs.size() && evaluation.budget.left() > 0) {
    const auto batch = pairs.subspan(done, covered(pairs.subspan(done), evaluation));
    if (batch.empty()) {  // whether the budget lasts for this one will be seen
      evaluate(pairs[done++], evaluation);
      continue;
    }
    const auto one = [&evaluation, batch](std::uint32_t i) noexcept {
      Evaluation own = evaluation;
      evaluate(batch[i], own);
    };
    pool.run(static_cast<std::uint32_t>(batch.size()), kShare, one);
    for (const std::uint32_t pair : batch) evaluation.budget.spend(queries_of(pair, evaluation));
    done += batch.size();
  }
  return done;
}

}  // namespace clearance
