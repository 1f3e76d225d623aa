#include "monitor/schedule/scheduler.hpp"

#include <algorithm>
#include <numeric>

namespace clearance {
namespace {

// A pair that stays active is evaluated again after so many ticks, because its loose carried bound
// may be the reason why it stays active.
constexpr std::uint64_t kReEvaluationTicks = 16;
constexpr std::uint32_t kMostReEvaluated = 256;  // pairs a tick

std::uint32_t part_pairs_of(std::span<const std::uint32_t> pairs, const PairTable& table) noexcept {
  return std::transform_reduce(pairs.begin(), pairs.end(), 0u, std::plus<>(),
                               [&table](std::uint32_t pair) { return table.part_pairs_of(pair); });
}

}  // namespace

Scheduler::Scheduler(const Scene& scene, const RefreshShare& share,
                     const std::vector<PosedPart>& parts, const PairTable& table,
                     const ZoneLevels& levels)
    : published_(scene, parts, table, share.published_every_tick),
      minimum_(chosen_),
      urgency_(scene, levels, chosen_),
      round_robin_(scene, share) {
  chosen_.reserve(scene.pairs.size());
  re_evaluated_.reserve(kMostReEvaluated);
}

std::span<const std::uint32_t> Scheduler::left_out() const noexcept {
  return published_.every_tick() ? published_.pairs() : std::span<const std::uint32_t>();
}

// The published pairs are evaluated at once only if the budget covers all active pairs besides.
// Then it does not matter that urgent pairs come after them.
Schedule Scheduler::schedule(const Culling& culling, const TickView& view,
                             const Budget& budget) noexcept {
  round_robin_.begin_tick();
  const std::uint32_t kept = round_robin_.kept_for_others();
  const std::uint64_t first = std::uint64_t{published_.part_pairs()} + kept;
  const std::uint64_t others = part_pairs_of(culling.active(), view.pairs);
  const bool covered = first + others <= budget.left();
  const bool at_once = published_.every_tick() && covered;
  return {.published_at_once = at_once,
          .kept = kept + (at_once ? 0 : round_robin_.kept_for_published())};
}

bool Scheduler::evaluate_urgent(const Schedule& schedule, Culling& culling, const OpenTick& tick,
                                Budget& budget) noexcept {
  const Evaluator evaluator{tick, budget, culling, round_robin_.queue()};
  round_robin_.bring_back(culling, tick);
  evaluator.queue_decided();
  if (published_.every_tick()) update_published(schedule, evaluator);
  minimum_.find_minimum(evaluator);
  urgency_.evaluate_urgent(evaluator);
  return budget.left() > 0;
}

Evaluated Scheduler::refresh(const Schedule& schedule, bool urgent_done, Culling& culling,
                             const OpenTick& tick, Budget& budget) noexcept {
  const Evaluator evaluator{tick, budget, culling, round_robin_.queue()};
  round_robin_.refresh(published_, schedule.published_at_once, evaluator);
  if (!urgent_done) {
    minimum_.find_minimum(evaluator);
    urgency_.evaluate_urgent(evaluator);
  }
  re_evaluate_active(evaluator);
  return {.smallest_upper = minimum_.smallest_upper(),
          .oldest_refresh = oldest_refresh(schedule, culling, tick)};
}

void Scheduler::update_published(const Schedule& schedule, const Evaluator& evaluator) noexcept {
  const OpenTick& tick = evaluator.tick;
  if (schedule.published_at_once) {
    published_.evaluate_all(tick, evaluator.budget);
    for (const std::uint32_t pair : published_.pairs()) {
      if (!is_evaluated(pair, tick)) continue;
      evaluator.culling.mark_updated(pair);
      tick.table.entries[pair].refreshed_cycle = tick.cycle;  // the queue does not have these pairs
    }
    return;
  }
  for (const std::uint32_t pair : published_.pairs()) {
    if (is_known(pair, tick)) evaluator.culling.update(pair, tick);
  }
}

void Scheduler::re_evaluate_active(const Evaluator& evaluator) noexcept {
  const TickView& view = evaluator.tick;
  re_evaluated_.clear();
  for (const std::uint32_t pair : evaluator.culling.active()) {
    if (re_evaluated_.size() == kMostReEvaluated) break;
    const std::uint64_t last = view.pairs.entries[pair].evaluated_cycle;
    if (last + kReEvaluationTicks >= view.cycle && last > 0) continue;
    if (is_known(pair, view)) re_evaluated_.push_back(pair);
  }
  evaluator.evaluate_affordable(re_evaluated_);
}

std::uint64_t Scheduler::oldest_refresh(const Schedule& schedule, const Culling& culling,
                                        const TickView& view) const noexcept {
  if (!culling.broad_phase().everyone_met()) return 0;
  std::uint64_t oldest = std::min(view.cycle, round_robin_.queue().oldest(view.pairs));
  if (!published_.every_tick() || schedule.published_at_once) return oldest;
  for (const std::uint32_t pair : published_.pairs()) {
    if (is_known(pair, view)) oldest = std::min(oldest, view.pairs.entries[pair].refreshed_cycle);
  }
  return oldest;
}

}  // namespace clearance
