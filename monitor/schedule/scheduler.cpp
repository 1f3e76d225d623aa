#include "monitor/schedule/scheduler.hpp"

#include <algorithm>
#include <numeric>

namespace clearance {
namespace {

// A pair that stays active is evaluated this often, in ticks: its carried bound may be what keeps
// it active.
constexpr std::uint64_t kReEvaluationTicks = 16;
constexpr std::uint32_t kMostReEvaluated = 256;  // a tick

std::uint32_t part_pairs_of(std::span<const std::uint32_t> pairs, const PairTable& table) noexcept {
  return std::transform_reduce(pairs.begin(), pairs.end(), 0u, std::plus<>(),
                               [&table](std::uint32_t pair) { return table.part_pairs_of(pair); });
}

}  // namespace

Scheduler::Scheduler(const Scene& scene, const RefreshShare& share,
                     const std::vector<PosedPart>& parts, const PairTable& table,
                     const ZoneLevels& levels, WorkerPool& pool)
    : published_(scene, parts, table, share.published_every_tick),
      minimum_(scene.pairs.size()),
      urgency_(scene, parts, levels),
      round_robin_(scene, share),
      pool_(pool) {
  re_evaluated_.reserve(kMostReEvaluated);
}

std::span<const std::uint32_t> Scheduler::left_out() const noexcept {
  return published_.every_tick() ? published_.pairs() : std::span<const std::uint32_t>();
}

// Whatever is urgent can be evaluated besides the published pairs, so that it need not come first.
Schedule Scheduler::schedule(const Culling& culling, const Evaluation& evaluation) noexcept {
  round_robin_.begin_tick();
  const std::uint32_t kept = round_robin_.kept_for_others();
  const std::uint64_t first = std::uint64_t{published_.part_pairs()} + kept;
  const std::uint64_t others = part_pairs_of(culling.active(), evaluation.table);
  const bool covered = first + others <= evaluation.budget.left();
  const bool at_once = published_.every_tick() && covered;
  return {.published_at_once = at_once,
          .kept = kept + (at_once ? 0 : round_robin_.kept_for_published())};
}

void Scheduler::evaluate(const Schedule& schedule, const Zones& zones, Culling& culling,
                         ZoneCrossings& crossings, Evaluation& evaluation) noexcept {
  const Evaluator evaluator{evaluation, culling, round_robin_.queue(), pool_};
  Budget& budget = evaluation.budget;
  round_robin_.bring_back(culling, evaluation);
  evaluator.take_decided();

  const std::uint32_t kept = budget.reserve(schedule.kept);
  if (published_.every_tick()) look_at_published(schedule, evaluator);
  minimum_.evaluate(evaluator);
  urgency_.evaluate(evaluator);
  crossings.begin_tick();
  crossings.find(culling.seen(), zones, evaluation);
  const bool ran_out = budget.left() == 0;
  const std::uint32_t kept_for_sweep = budget.reserve(crossings.queries());
  budget.release(kept);

  round_robin_.refresh(published_, schedule.published_at_once, evaluator);
  if (ran_out) {  // some of those that were kept were not needed
    minimum_.evaluate(evaluator);
    urgency_.evaluate(evaluator);
  }
  re_evaluate_active(evaluator);
  budget.release(kept_for_sweep);
  culling.cull_active(evaluation);
}

void Scheduler::look_at_published(const Schedule& schedule, const Evaluator& evaluator) noexcept {
  Evaluation& tick = evaluator.tick;
  if (schedule.published_at_once) {
    published_.evaluate(pool_, tick);
    for (const std::uint32_t pair : published_.pairs()) {
      if (is_evaluated(pair, tick)) evaluator.culling.see(pair);
    }
    return;
  }
  for (const std::uint32_t pair : published_.pairs()) {
    if (is_known(pair, tick)) evaluator.culling.look_at(pair, tick);
  }
}

void Scheduler::re_evaluate_active(const Evaluator& evaluator) noexcept {
  const Evaluation& tick = evaluator.tick;
  re_evaluated_.clear();
  for (const std::uint32_t pair : evaluator.culling.active()) {
    if (re_evaluated_.size() == kMostReEvaluated) break;
    const std::uint64_t last = tick.table.entries[pair].evaluated_cycle;
    if (last + kReEvaluationTicks >= tick.cycle && last > 0) continue;
    if (is_known(pair, tick)) re_evaluated_.push_back(pair);
  }
  evaluator.evaluate(re_evaluated_);
}

std::uint64_t Scheduler::refreshed_cycle(std::uint32_t pair, const Culling& culling,
                                         const PairTable& table) const noexcept {
  return culling.broad_phase().left_out(pair) ? table.entries[pair].evaluated_cycle
                                              : round_robin_.queue().refreshed_cycle(pair);
}

std::uint64_t Scheduler::oldest_refresh(const Schedule& schedule, const Culling& culling,
                                        const Evaluation& evaluation) const noexcept {
  if (!culling.broad_phase().everyone_met()) return 0;
  std::uint64_t oldest = std::min(evaluation.cycle, round_robin_.queue().oldest());
  if (!published_.every_tick() || schedule.published_at_once) return oldest;
  for (const std::uint32_t pair : published_.pairs()) {
    if (!is_known(pair, evaluation)) continue;
    oldest = std::min(oldest, evaluation.table.entries[pair].evaluated_cycle);
  }
  return oldest;
}

}  // namespace clearance
