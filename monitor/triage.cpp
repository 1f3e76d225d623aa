#include "monitor/triage.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace clearance {
namespace {

// How far the horizon is kept above the minimum: the farther, the more pairs are awake, the less
// often one has to be woken when the minimum grows. m.
constexpr double kHeadroom = 0.02;
// The horizon follows a growing minimum by no more than this a tick while it is above it, m.
constexpr double kHorizonStep = 0.002;
constexpr int kMostRaises = 8;  // a tick

// Looking at a woken pair costs about a fifth of a query.
constexpr std::size_t kWokenPerQuery = 5;
constexpr std::size_t kLeastWoken = 1'000;

constexpr std::uint32_t kLeastRefreshed = 16;  // pairs a tick
// A pair that stays awake is evaluated this often, in ticks: its carried bound may be what keeps
// it.
constexpr std::uint64_t kRestlessTicks = 16;
constexpr std::uint32_t kMostRestless = 256;  // a tick

std::uint32_t refreshed_per_tick(const Scene& scene) {
  const double ticks = std::max(1.0, scene.refresh_s * scene.rate_hz);
  const double pairs = std::ceil(static_cast<double>(scene.pairs.size()) / ticks);
  return std::max(kLeastRefreshed, static_cast<std::uint32_t>(std::min(pairs, 1e9)));
}

std::vector<std::uint32_t> asked_pairs(const Scene& scene) {
  std::vector<std::uint32_t> asked;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (scene.pairs[p].publish || scene.evaluate_all) asked.push_back(p);
  }
  return asked;
}

std::uint32_t rows_of(std::uint32_t pair, const PairTable& table) noexcept {
  return table.first_row[pair + 1] - table.first_row[pair];
}

std::uint32_t rows_of(std::span<const std::uint32_t> pairs, const PairTable& table) noexcept {
  return std::transform_reduce(pairs.begin(), pairs.end(), 0u, std::plus<>(),
                               [&table](std::uint32_t pair) { return rows_of(pair, table); });
}

bool is_known(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  return evaluation.objects[table.object_a[pair]].known() &&
         evaluation.objects[table.object_b[pair]].known();
}

bool is_evaluated(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  return evaluation.table.evaluated_cycle[pair] == evaluation.cycle;
}

}  // namespace

Triage::Triage(const Scene& scene, const std::vector<PlacedPart>& parts, const PairTable& table)
    : budget_(scene.budget),
      per_tick_(refreshed_per_tick(scene)),
      asked_(asked_pairs(scene)),
      asked_rows_(rows_of(asked_, table)),
      asked_every_tick_(asked_rows_ <= budget_),
      counts_(scene),
      urgency_(scene, parts),
      broad_phase_(scene, parts, urgency_.levels(),
                   asked_every_tick_ ? std::span(asked_) : std::span<const std::uint32_t>(),
                   std::max(kLeastWoken, kWokenPerQuery * scene.budget)),
      round_(scene.objects.size(), scene.pairs.size()) {
  for (auto* list : {&awake_, &current_, &scratch_}) list->reserve(table.pairs());
}

std::uint32_t Triage::evaluate_due(const std::vector<ObjectState>& objects,
                                   const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                                   PairTable& table) noexcept {
  Evaluation evaluation{objects, parts, cycle, table, budget_};
  evaluated_ = 0;
  current_.clear();
  counts_.update(objects);
  round_.look(objects);
  follow_minimum();
  broad_phase_.begin(objects, table);
  if (asked_every_tick_) look_at_asked(has_room(table), evaluation);
  look_at_awake(evaluation);
  find_horizon();
  settle_woken(evaluation);

  evaluate_minimum(evaluation);
  evaluate_urgent(evaluation);
  evaluate_asked(evaluation);
  evaluate_in_turn(evaluation);
  evaluate_restless(evaluation);
  put_to_sleep(evaluation);
  return budget_ - evaluation.queries_left;
}

// Whatever is urgent can be evaluated besides, so that it need not come first.
bool Triage::has_room(const PairTable& table) const noexcept {
  return rows_of(awake_, table) + rows_of(broad_phase_.woken(), table) <= budget_ - asked_rows_;
}

void Triage::look_at_asked(bool roomy, Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : asked_) {
    if (!is_known(pair, evaluation)) continue;
    if (roomy) {
      evaluate_once(pair, evaluation);
    } else {
      look_at(pair, evaluation);
    }
  }
}

void Triage::look_at_awake(Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : awake_) {
    if (is_known(pair, evaluation)) look_at(pair, evaluation);
  }
}

// The horizon stays a little above the minimum of the last tick.
void Triage::follow_minimum() noexcept {
  if (!(smallest_upper_ < kInfinity)) return;
  const double horizon = broad_phase_.horizon();
  const double best = smallest_upper_ + kHeadroom;
  if (!(horizon > -kInfinity) || best < horizon - kHeadroom) {
    broad_phase_.move_horizon(best);
  } else if (best > horizon + 0.5 * kHeadroom) {
    broad_phase_.move_horizon(std::min(best, horizon + kHorizonStep));
  }
}

// The first one: the minimum of the pairs seen so far is not beyond it.
void Triage::find_horizon() noexcept {
  if (broad_phase_.horizon() > -kInfinity) return;
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : broad_phase_.woken()) {
    smallest_upper = std::min(smallest_upper, broad_phase_.by_balls(pair).upper);
  }
  if (smallest_upper < kInfinity) broad_phase_.move_horizon(smallest_upper + kHeadroom);
}

void Triage::settle_woken(Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : broad_phase_.woken()) {
    if (is_known(pair, evaluation)) {
      if (broad_phase_.sleep(pair, broad_phase_.by_balls(pair).lower)) continue;
      look_at(pair, evaluation);
      if (broad_phase_.sleep(pair, evaluation.table.least_lower[pair])) continue;
    }
    awake_.push_back(pair);
  }
  broad_phase_.clear_woken();
}

// When the budget lasts, no pair that sleeps can be closer than the minimum afterwards.
void Triage::evaluate_minimum(Evaluation& evaluation) noexcept {
  evaluate_closest(evaluation);
  double step = kHeadroom;
  for (int i = 0; i < kMostRaises; ++i, step *= 2.0) {
    const double horizon = broad_phase_.horizon();
    const bool all_current = current_.size() == counts_.known();
    if (all_current || smallest_upper_ <= horizon || !(horizon > -kInfinity)) return;
    if (evaluation.queries_left == 0 || broad_phase_.pending()) return;
    broad_phase_.move_horizon(std::min(smallest_upper_ + kHeadroom, horizon + step));
    settle_woken(evaluation);
    evaluate_closest(evaluation);
  }
}

void Triage::look_at(std::uint32_t pair, Evaluation& evaluation) noexcept {
  if (evaluation.table.carried_cycle[pair] == evaluation.cycle) return;
  carry(pair, evaluation.objects, evaluation.parts, evaluation.cycle, evaluation.table);
  current_.push_back(pair);
}

void Triage::evaluate_once(std::uint32_t pair, Evaluation& evaluation) noexcept {
  if (is_evaluated(pair, evaluation) || evaluation.queries_left == 0) return;
  if (evaluation.table.carried_cycle[pair] != evaluation.cycle) current_.push_back(pair);
  evaluate(pair, evaluation);
  ++evaluated_;
}

void Triage::evaluate_closest(Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  const auto upper_of = [&table](std::uint32_t pair) {
    return *std::min_element(table.upper.begin() + table.first_row[pair],
                             table.upper.begin() + table.first_row[pair + 1]);
  };
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : current_)
    smallest_upper = std::min(smallest_upper, upper_of(pair));

  scratch_.clear();
  for (const std::uint32_t pair : current_) {
    const bool done = table.evaluated_cycle[pair] == evaluation.cycle;
    if (!done && table.least_lower[pair] < smallest_upper) scratch_.push_back(pair);
  }
  const auto later = [&table](std::uint32_t left, std::uint32_t right) {
    return std::tie(table.least_lower[left], left) > std::tie(table.least_lower[right], right);
  };
  std::make_heap(scratch_.begin(), scratch_.end(), later);
  while (!scratch_.empty() && evaluation.queries_left > 0) {
    std::pop_heap(scratch_.begin(), scratch_.end(), later);
    const std::uint32_t pair = scratch_.back();
    scratch_.pop_back();
    if (table.least_lower[pair] >= smallest_upper) break;
    evaluate_once(pair, evaluation);
    smallest_upper = std::min(smallest_upper, upper_of(pair));
  }
  smallest_upper_ = smallest_upper;
}

void Triage::evaluate_urgent(Evaluation& evaluation) noexcept {
  for (std::size_t bin = 0; bin < Urgency::kBins; ++bin) {
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

// Pairs asked for that outnumber the budget must not starve the rest: they take turns in what the
// round of all pairs leaves.
void Triage::evaluate_asked(Evaluation& evaluation) noexcept {
  const bool covered = asked_.size() <= evaluation.queries_left;
  const std::uint32_t kept = covered ? 0 : std::min(per_tick_, evaluation.queries_left);
  for (std::size_t i = 0; i < asked_.size() && evaluation.queries_left > kept; ++i) {
    if (next_asked_ >= asked_.size()) next_asked_ = 0;
    const std::uint32_t pair = asked_[next_asked_++];
    if (is_known(pair, evaluation)) evaluate_once(pair, evaluation);
  }
}

void Triage::evaluate_in_turn(Evaluation& evaluation) noexcept {
  std::uint32_t left = per_tick_;
  // Passing over a pair costs little; still, there may be millions that nobody knows.
  const std::uint64_t turns = std::min<std::uint64_t>(evaluation.table.pairs(), 4ull * per_tick_);
  for (std::uint64_t turn = 0; turn < turns && left > 0 && evaluation.queries_left > 0; ++turn) {
    const std::uint32_t pair = round_.take_turn(evaluation.cycle);
    if (is_evaluated(pair, evaluation) || !is_known(pair, evaluation)) continue;
    evaluate_once(pair, evaluation);
    --left;
  }
}

void Triage::evaluate_restless(Evaluation& evaluation) noexcept {
  std::uint32_t left = std::min(kMostRestless, evaluation.queries_left);
  for (const std::uint32_t pair : awake_) {
    if (left == 0) return;
    const std::uint64_t last = evaluation.table.evaluated_cycle[pair];
    if (last + kRestlessTicks >= evaluation.cycle && last > 0) continue;
    if (!is_known(pair, evaluation)) continue;
    evaluate_once(pair, evaluation);
    --left;
  }
}

void Triage::put_to_sleep(const Evaluation& evaluation) noexcept {
  const auto sleeps = [&](std::uint32_t pair) {
    return is_known(pair, evaluation) &&
           broad_phase_.sleep(pair, evaluation.table.least_lower[pair]);
  };
  awake_.erase(std::remove_if(awake_.begin(), awake_.end(), sleeps), awake_.end());
}

// As many as the budget allows; pairs of equal age in their own order.
void Triage::evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept {
  const std::vector<std::uint64_t>& cycle = evaluation.table.evaluated_cycle;
  // A pair takes one query or more, so no more pairs than this have a turn.
  if (pairs.size() > evaluation.queries_left) {
    const auto staler = [&cycle](std::uint32_t left, std::uint32_t right) {
      return std::tie(cycle[left], left) < std::tie(cycle[right], right);
    };
    const auto end = pairs.begin() + evaluation.queries_left;
    std::nth_element(pairs.begin(), end, pairs.end(), staler);
    std::sort(pairs.begin(), end, staler);
    pairs = pairs.first(evaluation.queries_left);
  }
  for (const std::uint32_t pair : pairs) evaluate_once(pair, evaluation);
}

}  // namespace clearance
