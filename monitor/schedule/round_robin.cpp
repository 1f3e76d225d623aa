#include "monitor/schedule/round_robin.hpp"

#include <algorithm>

#include "monitor/invariant.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kLeastRefreshed = 16;  // pairs a tick
// Pairs out of sight, of which there may be millions, a tick.
constexpr std::uint32_t kMostSetAside = 2'000;
// As many times more when some are overdue, having been out of sight.
constexpr std::uint32_t kCatchUp = 4;

std::uint32_t refreshed_per_tick(std::uint64_t pairs, std::uint64_t ticks) {
  return std::max(kLeastRefreshed, static_cast<std::uint32_t>((pairs + ticks - 1) / ticks));
}

}  // namespace

RoundRobin::RoundRobin(const Scene& scene, const RefreshShare& share)
    : ticks_(share.ticks),
      published_(share.published, share.ticks, share.queries() <= scene.budget),
      others_(share.others, share.ticks, share.queries() <= scene.budget),
      per_tick_(refreshed_per_tick(scene.pairs.size(), share.ticks)),
      queue_(scene.objects.size(), scene.pairs.size()) {}

void RoundRobin::begin_tick() noexcept {
  published_.begin_tick();
  others_.begin_tick();
}

void RoundRobin::bring_back(const Culling& culling, const Evaluation& evaluation) noexcept {
  for (const std::uint32_t object : culling.known_pairs().regained()) queue_.regain(object);
  queue_.bring_back(culling.broad_phase().by_object(), evaluation.objects, evaluation.table);
}

// Published pairs that outnumber the budget must not starve the rest, nor these those.
void RoundRobin::refresh(const PublishedPairs& published, bool all_published,
                         const Evaluator& evaluator) noexcept {
  Budget& budget = evaluator.tick.budget;
  const bool covered = all_published || published.pairs().size() <= budget.left();
  if (all_published) {
    published_.all_refreshed();
  } else if (covered) {
    const std::uint32_t kept = budget.reserve(others_.kept());
    evaluate_published(published, evaluator);
    budget.release(kept);
  }
  const std::uint32_t kept = budget.reserve(covered ? 0 : published_.kept());
  refresh_stalest(evaluator);
  budget.release(kept);
  if (!covered) evaluate_published(published, evaluator);
}

// As far as the budget goes; where that was in the last tick, it begins in this one.
void RoundRobin::evaluate_published(const PublishedPairs& published,
                                    const Evaluator& evaluator) noexcept {
  const Evaluation& tick = evaluator.tick;
  std::uint32_t part_pairs = 0;
  const auto pairs = published.pairs();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (next_published_ >= pairs.size()) next_published_ = 0;
    const std::uint32_t pair = pairs[next_published_];
    if (!is_evaluated(pair, tick) && is_known(pair, tick)) {
      if (!evaluator.evaluate(pair)) {
        // No pair may wait for one that might always find too little left.
        if (!published_.is_sure()) ++next_published_;
        return published_.end_tick(part_pairs);
      }
      part_pairs += tick.table.part_pairs_of(pair);
    }
    ++next_published_;
  }
  published_.all_refreshed();
}

void RoundRobin::refresh_stalest(const Evaluator& evaluator) noexcept {
  const Evaluation& tick = evaluator.tick;
  const std::uint32_t most = kCatchUp * std::max(per_tick_, others_.due());
  std::uint32_t refreshed = 0, part_pairs = 0;
  for (std::uint32_t unknown = 0; refreshed < most && unknown < kMostSetAside;) {
    const std::uint32_t pair = queue_.stalest();
    const bool left = pair != RefreshQueue::kNoIndex;
    const std::uint64_t last = left ? queue_.refreshed_cycle(pair) : tick.cycle;
    if (last == tick.cycle) return others_.all_refreshed();
    if (!is_known(pair, tick)) {
      set_aside(pair, tick);
      ++unknown;
      continue;
    }
    const bool overdue = tick.cycle - last >= ticks_;
    if (refreshed >= per_tick_ && part_pairs >= others_.due() && !overdue) break;
    if (!refresh(pair, evaluator)) break;
    ++refreshed;
    part_pairs += tick.table.part_pairs_of(pair);
  }
  others_.end_tick(part_pairs);
}

// False: the budget is used up.
bool RoundRobin::refresh(std::uint32_t pair, const Evaluator& evaluator) noexcept {
  if (evaluator.culling.refresh_by_models(pair, others_.kept(), evaluator.tick)) {
    queue_.refreshed(pair, evaluator.tick.cycle);
    return true;
  }
  if (!evaluator.evaluate(pair)) return false;
  // Of a pair that was culled this is the only look at what it really does.
  CLEARANCE_INVARIANT(
      evaluator.culling.broad_phase().may_be_culled(pair, upper_of(pair, evaluator.tick.table)));
  return true;
}

void RoundRobin::set_aside(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  const PairEntry& entry = evaluation.table.entries[pair];
  const bool a_is_known = evaluation.objects[entry.object_a].known();
  queue_.set_aside(pair, a_is_known ? entry.object_b : entry.object_a);
}

}  // namespace clearance
