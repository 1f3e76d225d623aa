#include "monitor/schedule/scheduler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "monitor/pairs/evaluate_pairs.hpp"
#include "monitor/schedule/sparing.hpp"

namespace clearance {
namespace {

// Looking at a pair that was woken costs up to a query where memory is far, meeting one for the
// first time up to two.
constexpr std::size_t kWokenPerQuery = 2;
constexpr std::size_t kLeastWoken = 2'000;

constexpr std::uint32_t kLeastRefreshed = 16;  // pairs a tick
// A pair that stays awake is evaluated this often, in ticks: its carried bound may be what keeps
// it.
constexpr std::uint64_t kRestlessTicks = 16;
constexpr std::uint32_t kMostRestless = 256;  // a tick

std::uint32_t refreshed_per_tick(const Scene& scene, std::uint64_t ticks) {
  const std::uint64_t pairs = (scene.pairs.size() + ticks - 1) / ticks;
  return std::max(kLeastRefreshed, static_cast<std::uint32_t>(pairs));
}

std::uint32_t rows_of(std::span<const std::uint32_t> pairs, const PairTable& table) noexcept {
  return std::transform_reduce(pairs.begin(), pairs.end(), 0u, std::plus<>(),
                               [&table](std::uint32_t pair) { return table.rows_of(pair); });
}

}  // namespace

Scheduler::Scheduler(const Scene& scene, const std::vector<PosedPart>& parts,
                     const PairTable& table, WorkerPool& pool)
    : budget_(scene.budget),
      share_(refresh_share(scene)),
      asked_pace_(share_.asked, share_.ticks, share_.queries() <= scene.budget),
      others_pace_(share_.others, share_.ticks, share_.queries() <= scene.budget),
      per_tick_(refreshed_per_tick(scene, share_.ticks)),
      asked_(scene, parts, table, share_.asked_every_tick),
      counts_(scene),
      urgency_(scene, parts),
      broad_phase_(scene, parts, urgency_.levels(),
                   asked_.every_tick() ? asked_.pairs() : std::span<const std::uint32_t>(),
                   std::max(kLeastWoken, kWokenPerQuery * scene.budget)),
      hulls_(scene, parts),
      queue_(scene.objects.size(), scene.pairs.size()),
      passages_(std::min<std::size_t>(scene.pairs.size(), scene.budget)),
      pool_(pool),
      is_current_(table.pairs(), 0) {
  for (auto* list : {&awake_, &current_, &scratch_}) list->reserve(table.pairs());
}

std::uint32_t Scheduler::evaluate_due(const std::vector<TrackedObject>& objects,
                                      std::span<const std::uint32_t> changed,
                                      const std::vector<PosedPart>& parts, std::uint64_t cycle,
                                      const Zones& zones, PairTable& table) noexcept {
  Evaluation evaluation{objects, parts, cycle, table, budget_};
  begin(changed, evaluation);
  asked_pace_.begin_tick();
  others_pace_.begin_tick();
  asked_done_ = asked_.every_tick() && has_room(table);
  const std::uint32_t kept = others_pace_.kept() + (asked_done_ ? 0 : asked_pace_.kept());
  bool ran_out = false;
  sparing(kept, evaluation, [&] {
    evaluate_first(zones, evaluation);
    ran_out = evaluation.queries_left == 0;
  });
  evaluate_in_turn(evaluation);
  if (ran_out) {  // there is what nobody needed of those that were kept
    evaluate_minimum(evaluation);
    evaluate_urgent(evaluation);
  }
  evaluate_restless(evaluation);
  decide_passages(zones, evaluation);
  passages_.finish();
  put_to_sleep(evaluation);
  find_oldest(evaluation);
  return budget_ - evaluation.queries_left;
}

// What must not wait.
void Scheduler::evaluate_first(const Zones& zones, Evaluation& evaluation) noexcept {
  if (asked_.every_tick()) look_at_asked(evaluation);
  look_at_awake(evaluation);
  find_horizon();
  settle_woken(evaluation);

  evaluate_minimum(evaluation);
  evaluate_urgent(evaluation);
  decide_passages(zones, evaluation);
}

void Scheduler::begin(std::span<const std::uint32_t> changed, Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : current_) is_current_[pair] = 0;
  current_.clear();
  passages_.begin();
  passages_decided_ = 0;
  counts_.update(evaluation.objects, changed);
  for (const std::uint32_t object : counts_.regained()) queue_.regain(object);
  queue_.bring_back(broad_phase_, evaluation.objects, evaluation.table);
  follow_minimum();
  broad_phase_.begin(evaluation.objects, changed, evaluation.table);
}

// Whatever is urgent can be evaluated besides, so that it need not come first.
bool Scheduler::has_room(const PairTable& table) const noexcept {
  const std::uint32_t others = rows_of(awake_, table) + rows_of(broad_phase_.woken(), table);
  return asked_.rows() + others_pace_.kept() <= budget_ &&
         others <= budget_ - asked_.rows() - others_pace_.kept();
}

void Scheduler::look_at_asked(Evaluation& evaluation) noexcept {
  if (asked_done_) {
    asked_.evaluate(pool_, evaluation);
    // Nobody is in the list yet, and there is room for all.
    current_.resize(asked_.pairs().size());
    auto end = current_.begin();
    for (const std::uint32_t pair : asked_.pairs()) {
      if (!is_evaluated(pair, evaluation)) continue;
      is_current_[pair] = 1;
      *end++ = pair;
    }
    current_.erase(end, current_.end());
    return;
  }
  for (const std::uint32_t pair : asked_.pairs()) {
    if (is_known(pair, evaluation)) look_at(pair, evaluation);
  }
}

void Scheduler::look_at_awake(Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : awake_) {
    if (is_known(pair, evaluation)) look_at(pair, evaluation);
  }
}

// Whether a lower bound of a known pair is `enough`: by its models from coarse to fine, short of
// the parts. What proves pairs far may not starve those that are near: half of the budget is
// theirs; nor what is `spared` besides.
template <class Enough>
bool Scheduler::by_models(std::uint32_t pair, std::uint32_t spared, Evaluation& evaluation,
                          const Enough& enough) noexcept {
  const RowBounds balls = broad_phase_.by_balls(pair);
  if (enough(balls.lower)) return true;
  const bool hopeless = balls.upper <= broad_phase_.horizon();
  if (hopeless || evaluation.queries_left <= std::max((budget_ + 1) / 2, spared)) return false;
  if (!hulls_.possible(evaluation.table.entries[pair])) return false;
  const double lower = hulls_.lower(pair, evaluation);
  if (!enough(lower)) return false;
  raise(pair, lower, evaluation.objects, evaluation.table);
  return true;
}

void Scheduler::settle_woken(Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : broad_phase_.woken()) {
    if (is_known(pair, evaluation)) {
      const auto sleeps = [&](double lower) { return broad_phase_.sleep(pair, lower); };
      if (by_models(pair, 0, evaluation, sleeps)) {
        queue_.refreshed(pair, evaluation.cycle);
        continue;
      }
      look_at(pair, evaluation);
      queue_.enter(pair);
      if (broad_phase_.sleep(pair, evaluation.table.entries[pair].least_lower)) continue;
    }
    queue_.enter(pair);
    awake_.push_back(pair);
  }
  broad_phase_.clear_woken();
}

void Scheduler::list(std::uint32_t pair) noexcept {
  if (is_current_[pair]) return;
  is_current_[pair] = 1;
  current_.push_back(pair);
}

void Scheduler::look_at(std::uint32_t pair, Evaluation& evaluation) noexcept {
  carry(pair, evaluation.objects, evaluation.parts, evaluation.cycle, evaluation.table);
  list(pair);
}

// Known pairs that are not evaluated yet, as many of the first as the budget covers.
void Scheduler::evaluate_these(std::span<const std::uint32_t> pairs,
                               Evaluation& evaluation) noexcept {
  const std::size_t done = evaluate(pairs, pool_, evaluation);
  for (const std::uint32_t pair : pairs.first(done)) note_evaluated(pair, evaluation);
}

void Scheduler::note_evaluated(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  list(pair);
  if (!is_evaluated(pair, evaluation) || broad_phase_.left_out(pair)) return;
  queue_.refreshed(pair, evaluation.cycle);
}

void Scheduler::evaluate_urgent(Evaluation& evaluation) noexcept {
  std::array<bool, UrgencyBins::kBins> filled{};
  for (const std::uint32_t pair : current_) {
    if (is_evaluated(pair, evaluation)) continue;
    const std::size_t bin = urgency_.bin_of(pair, evaluation.objects, evaluation.table);
    if (bin < UrgencyBins::kBins) filled[bin] = true;
  }
  for (std::size_t bin = 0; bin < UrgencyBins::kBins; ++bin) {
    if (!filled[bin]) continue;
    scratch_.clear();
    for (const std::uint32_t pair : current_) {
      if (is_evaluated(pair, evaluation)) continue;
      if (urgency_.bin_of(pair, evaluation.objects, evaluation.table) == bin) {
        scratch_.push_back(pair);
      }
    }
    evaluate_stalest(scratch_, evaluation);
  }
}

// Of those looked at since the last time. Of pairs that had their turn little may be known from the
// last tick.
void Scheduler::decide_passages(const Zones& zones, Evaluation& evaluation) noexcept {
  for (; passages_decided_ < current_.size(); ++passages_decided_) {
    passages_.decide(current_[passages_decided_], zones, evaluation);
  }
}

// False: the budget is used up.
bool Scheduler::refresh(std::uint32_t pair, Evaluation& evaluation) noexcept {
  const auto is_far = [&](double lower) { return broad_phase_.is_far(pair, lower); };
  if (by_models(pair, others_pace_.kept(), evaluation, is_far)) {
    queue_.refreshed(pair, evaluation.cycle);
    return true;
  }
  evaluate_these({&pair, 1}, evaluation);
  return is_evaluated(pair, evaluation);
}

void Scheduler::evaluate_restless(Evaluation& evaluation) noexcept {
  scratch_.clear();
  for (const std::uint32_t pair : awake_) {
    if (scratch_.size() == kMostRestless) break;
    const std::uint64_t last = evaluation.table.entries[pair].evaluated_cycle;
    if (last + kRestlessTicks >= evaluation.cycle && last > 0) continue;
    if (is_known(pair, evaluation)) scratch_.push_back(pair);
  }
  evaluate_these(scratch_, evaluation);
}

void Scheduler::put_to_sleep(const Evaluation& evaluation) noexcept {
  const auto sleeps = [&](std::uint32_t pair) {
    return is_known(pair, evaluation) &&
           broad_phase_.sleep(pair, evaluation.table.entries[pair].least_lower);
  };
  awake_.erase(std::remove_if(awake_.begin(), awake_.end(), sleeps), awake_.end());
}

// As many as the budget allows; pairs of equal age in their own order.
void Scheduler::evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept {
  const std::vector<PairEntry>& entries = evaluation.table.entries;
  // A pair takes one query or more, so no more pairs than this have a turn.
  if (pairs.size() > evaluation.queries_left) {
    const auto staler = [&entries](std::uint32_t left, std::uint32_t right) {
      return std::tie(entries[left].evaluated_cycle, left) <
             std::tie(entries[right].evaluated_cycle, right);
    };
    const auto end = pairs.begin() + evaluation.queries_left;
    std::nth_element(pairs.begin(), end, pairs.end(), staler);
    std::sort(pairs.begin(), end, staler);
    pairs = pairs.first(evaluation.queries_left);
  }
  evaluate_these(pairs, evaluation);
}

}  // namespace clearance
