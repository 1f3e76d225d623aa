#include "monitor/schedule/round_robin.hpp"

#include <algorithm>

#include "monitor/interface/invariant.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kLeastRefreshed = 16;  // pairs a tick
// Pairs of objects that are not known, a tick; there may be millions of them.
constexpr std::uint32_t kMostSetAside = 2'000;
// A tick refreshes at most so many times its usual number while pairs are overdue because their
// objects were not known.
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

void RoundRobin::bring_back(const Culling& culling, const TickView& view) noexcept {
  for (const std::uint32_t object : culling.known_pairs().regained()) queue_.regain(object);
  queue_.bring_back(culling.broad_phase().by_object(), view);
}

// Published pairs that outnumber the budget must not starve the other pairs, and vice versa.
void RoundRobin::refresh(const PublishedPairs& published, bool all_published,
                         const Evaluator& evaluator) noexcept {
  Budget& budget = evaluator.budget;
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

// Evaluates published pairs as far as the budget goes, starting where it ended in the last tick.
void RoundRobin::evaluate_published(const PublishedPairs& published,
                                    const Evaluator& evaluator) noexcept {
  const OpenTick& tick = evaluator.tick;
  std::uint32_t part_pairs = 0;
  const auto pairs = published.pairs();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (next_published_ >= pairs.size()) next_published_ = 0;
    const std::uint32_t pair = pairs[next_published_];
    if (!is_evaluated(pair, tick) && is_known(pair, tick)) {
      if (!evaluator.try_evaluate(pair)) {
        // The next tick must not begin with a pair that may never find enough budget left.
        if (!published_.is_sure()) ++next_published_;
        return published_.end_tick(part_pairs);
      }
      part_pairs += tick.pairs.part_pairs_of(pair);
    }
    ++next_published_;
  }
  published_.all_refreshed();
}

void RoundRobin::refresh_stalest(const Evaluator& evaluator) noexcept {
  const OpenTick& tick = evaluator.tick;
  const std::uint32_t most = kCatchUp * std::max(per_tick_, others_.due());
  std::uint32_t refreshed = 0, part_pairs = 0;
  for (std::uint32_t unknown = 0; refreshed < most && unknown < kMostSetAside;) {
    const std::uint32_t pair = queue_.stalest();
    const bool left = pair != RefreshQueue::kNoIndex;
    const std::uint64_t last = left ? tick.pairs.entries[pair].refreshed_cycle : tick.cycle;
    if (last == tick.cycle) return others_.all_refreshed();
    if (!is_known(pair, tick)) {
      set_aside(pair, tick);
      ++unknown;
      continue;
    }
    const bool overdue = tick.cycle - last >= ticks_;
    if (refreshed >= per_tick_ && part_pairs >= others_.due() && !overdue) break;
    if (!refresh_pair(pair, evaluator)) break;
    ++refreshed;
    part_pairs += tick.pairs.part_pairs_of(pair);
  }
  others_.end_tick(part_pairs);
}

// False: the budget is used up.
bool RoundRobin::refresh_pair(std::uint32_t pair, const Evaluator& evaluator) noexcept {
  if (evaluator.culling.prove_far(pair, others_.kept(), evaluator.tick, evaluator.budget)) {
    evaluator.note_refreshed(pair);
    return true;
  }
  if (!evaluator.try_evaluate(pair)) return false;
  // Only here is the true distance of a culled pair found.
  CLEARANCE_INVARIANT(
      evaluator.culling.broad_phase().may_be_culled(pair, upper_of(pair, evaluator.tick.pairs)));
  return true;
}

void RoundRobin::set_aside(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const bool a_is_known = view.objects[entry.object_a].known();
  queue_.set_aside(pair, a_is_known ? entry.object_b : entry.object_a, view.pairs);
}

}  // namespace clearance
