// The part of triage that gives everybody a turn in time.
#include <algorithm>

#include "monitor/schedule/scheduler.hpp"
#include "monitor/schedule/sparing.hpp"

namespace clearance {
namespace {

// Pairs out of sight, of which there may be millions, a tick.
constexpr std::uint32_t kMostSetAside = 2'000;
// As many times more when some are overdue, having been out of sight.
constexpr std::uint32_t kCatchUp = 4;

}  // namespace

// Pairs asked for that outnumber the budget must not starve the rest, nor these those.
void Scheduler::evaluate_in_turn(Evaluation& evaluation) noexcept {
  const bool covered = asked_done_ || asked_.pairs().size() <= evaluation.queries_left;
  if (covered) sparing(others_pace_.kept(), evaluation, [&] { evaluate_asked(evaluation); });
  const std::uint32_t kept = covered ? 0 : asked_pace_.kept();
  sparing(kept, evaluation, [&] { refresh_stalest(evaluation); });
  if (!covered) evaluate_asked(evaluation);
}

// As far as the budget goes; where that was in the last tick, it begins in this one.
void Scheduler::evaluate_asked(Evaluation& evaluation) noexcept {
  if (asked_done_) return asked_pace_.through_with_all();
  std::uint32_t rows = 0;
  const auto pairs = asked_.pairs();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (next_asked_ >= pairs.size()) next_asked_ = 0;
    const std::uint32_t pair = pairs[next_asked_];
    if (!is_evaluated(pair, evaluation) && is_known(pair, evaluation)) {
      evaluate_these({&pair, 1}, evaluation);
      if (!is_evaluated(pair, evaluation)) {
        // Nobody may wait for a pair that might always find too little left.
        if (!asked_pace_.is_sure()) ++next_asked_;
        return asked_pace_.end_tick(rows);
      }
      rows += evaluation.table.rows_of(pair);
    }
    ++next_asked_;
  }
  asked_pace_.through_with_all();
}

void Scheduler::refresh_stalest(Evaluation& evaluation) noexcept {
  const std::uint32_t most = kCatchUp * std::max(per_tick_, others_pace_.due());
  std::uint32_t refreshed = 0, rows = 0;
  for (std::uint32_t unknown = 0; refreshed < most && unknown < kMostSetAside;) {
    const std::uint32_t pair = queue_.stalest();
    const bool left = pair != RefreshQueue::kNobody;
    const std::uint64_t last = left ? queue_.refreshed_cycle(pair) : evaluation.cycle;
    if (last == evaluation.cycle) return others_pace_.through_with_all();
    if (!is_known(pair, evaluation)) {
      set_aside(pair, evaluation);
      ++unknown;
      continue;
    }
    const bool overdue = evaluation.cycle - last >= share_.ticks;
    if (refreshed >= per_tick_ && rows >= others_pace_.due() && !overdue) break;
    if (!refresh(pair, evaluation)) break;
    ++refreshed;
    rows += evaluation.table.rows_of(pair);
  }
  others_pace_.end_tick(rows);
}

void Scheduler::set_aside(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  const PairEntry& entry = evaluation.table.entries[pair];
  const bool a_is_known = evaluation.objects[entry.object_a].known();
  queue_.set_aside(pair, a_is_known ? entry.object_b : entry.object_a);
}

std::uint64_t Scheduler::refreshed_cycle(std::uint32_t pair,
                                         const PairTable& table) const noexcept {
  return broad_phase_.left_out(pair) ? table.entries[pair].evaluated_cycle
                                     : queue_.refreshed_cycle(pair);
}

void Scheduler::find_oldest(const Evaluation& evaluation) noexcept {
  oldest_refresh_ = std::min(evaluation.cycle, queue_.oldest());
  if (!broad_phase_.everyone_met()) oldest_refresh_ = 0;
  if (!asked_.every_tick() || asked_done_) return;
  for (const std::uint32_t pair : asked_.pairs()) {
    if (!is_known(pair, evaluation)) continue;
    oldest_refresh_ = std::min(oldest_refresh_, evaluation.table.entries[pair].evaluated_cycle);
  }
}

}  // namespace clearance
