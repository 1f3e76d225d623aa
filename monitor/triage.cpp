#include "monitor/triage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "monitor/rounding.hpp"

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

// Just above a zone's upper threshold, margins included.
double watch_level(const Zone& zone, double margins) noexcept {
  return rounded_up(std::nextafter(zone.leave_above, kInfinity) + margins);
}

std::vector<double> stated_speeds(const Scene& scene) {
  std::vector<double> speeds;
  for (const Object& object : scene.objects) {
    const bool stated = !object.fixed && std::isfinite(object.max_speed);
    speeds.push_back(stated ? object.max_speed : 0.0);
  }
  return speeds;
}

// By pair; -infinity: no zone.
std::vector<double> zone_levels(const Scene& scene) {
  std::vector<double> levels(scene.pairs.size(), -kInfinity);
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) {
      const double margins = scene.objects[scene.pairs[pair].first].margin +
                             scene.objects[scene.pairs[pair].second].margin;
      levels[pair] = std::max(levels[pair], watch_level(zone, margins));
    }
  }
  return levels;
}

// Awake well before the urgent bins.
BroadPhase::Levels levels_of(const Scene& scene, double ticks) {
  BroadPhase::Levels levels{.zones = zone_levels(scene), .urgent = stated_speeds(scene)};
  for (double& level : levels.urgent) level *= ticks / scene.rate_hz;
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    levels.zones[p] += levels.urgent[scene.pairs[p].first] + levels.urgent[scene.pairs[p].second];
  }
  return levels;
}

}  // namespace

Triage::Triage(const Scene& scene, const std::vector<PlacedPart>& parts, const PairTable& table)
    : budget_(scene.budget),
      period_s_(1.0 / scene.rate_hz),
      everything_(table.rows() <= scene.budget),
      per_tick_(refreshed_per_tick(scene)),
      reach_(scene.objects.size(), 0.0),
      stated_speed_(stated_speeds(scene)),
      watch_below_(zone_levels(scene)),
      counts_(scene),
      broad_phase_(scene, parts, levels_of(scene, kUrgentTicks),
                   std::max(kLeastWoken, kWokenPerQuery * scene.budget)),
      round_(scene.objects.size(), scene.pairs.size()) {
  for (const PlacedPart& part : parts) {
    reach_[part.object] = std::max(reach_[part.object], part.reach);
  }
  for (double& level : watch_below_) level = std::max(level, 0.0);
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (scene.pairs[p].publish) published_.push_back(p);
  }
  for (auto* list : {&awake_, &known_, &scratch_}) list->reserve(table.pairs());
  evaluated_.reserve(std::min(table.pairs(), budget_));  // a pair takes one query or more
}

std::uint32_t Triage::evaluate_due(const std::vector<ObjectState>& objects,
                                   const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                                   PairTable& table) noexcept {
  Evaluation evaluation{parts, cycle, table, budget_};
  evaluated_.clear();
  counts_.update(objects);
  round_.look(objects);
  follow_minimum();
  broad_phase_.begin(objects, table);
  for (const std::uint32_t pair : awake_) carry(pair, objects, parts, table);
  if (!everything_) find_horizon();
  settle_woken(objects, evaluation);

  if (everything_) {
    list_known(objects, table);
    for (const std::uint32_t pair : known_) evaluate_once(pair, evaluation);
    return budget_ - evaluation.queries_left;
  }
  evaluate_minimum(objects, evaluation);
  evaluate_urgent(objects, evaluation);
  evaluate_published(objects, evaluation);
  evaluate_in_turn(objects, evaluation);
  evaluate_restless(evaluation);
  put_to_sleep(objects, table);
  return budget_ - evaluation.queries_left;
}

bool Triage::is_known(std::uint32_t pair, const std::vector<ObjectState>& objects,
                      const PairTable& table) const noexcept {
  return objects[table.object_a[pair]].known() && objects[table.object_b[pair]].known();
}

// The horizon stays a little above the minimum of the last tick.
void Triage::follow_minimum() noexcept {
  if (everything_ || !(smallest_upper_ < kInfinity)) return;
  const double horizon = broad_phase_.horizon();
  const double best = smallest_upper_ + kHeadroom;
  if (!(horizon > -kInfinity) || best < horizon - kHeadroom) {
    broad_phase_.move_horizon(best);
  } else if (best > horizon) {
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

void Triage::settle_woken(const std::vector<ObjectState>& objects,
                          Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  for (const std::uint32_t pair : broad_phase_.woken()) {
    const bool known = is_known(pair, objects, table);
    if (known && broad_phase_.sleep(pair, broad_phase_.by_balls(pair).lower)) continue;
    carry(pair, objects, evaluation.parts, table);
    if (known && broad_phase_.sleep(pair, table.least_lower[pair])) continue;
    awake_.push_back(pair);
  }
  broad_phase_.clear_woken();
}

void Triage::list_known(const std::vector<ObjectState>& objects, const PairTable& table) noexcept {
  known_.clear();
  for (const std::uint32_t pair : awake_) {
    if (is_known(pair, objects, table)) known_.push_back(pair);
  }
}

// When the budget lasts, no pair that sleeps can be closer than the minimum afterwards.
void Triage::evaluate_minimum(const std::vector<ObjectState>& objects,
                              Evaluation& evaluation) noexcept {
  list_known(objects, evaluation.table);
  evaluate_closest(evaluation);
  double step = kHeadroom;
  for (int i = 0; i < kMostRaises; ++i, step *= 2.0) {
    const double horizon = broad_phase_.horizon();
    const bool all_awake = known_.size() == counts_.known();
    if (all_awake || smallest_upper_ <= horizon || !(horizon > -kInfinity)) return;
    if (evaluation.queries_left == 0 || broad_phase_.pending()) return;
    broad_phase_.move_horizon(std::min(smallest_upper_ + kHeadroom, horizon + step));
    settle_woken(objects, evaluation);
    list_known(objects, evaluation.table);
    evaluate_closest(evaluation);
  }
}

void Triage::evaluate_once(std::uint32_t pair, Evaluation& evaluation) noexcept {
  if (evaluation.table.evaluated_cycle[pair] == evaluation.cycle) return;
  if (evaluation.queries_left == 0) return;
  evaluate(pair, evaluation);
  evaluated_.push_back(pair);
}

void Triage::evaluate_closest(Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  const auto upper_of = [&table](std::uint32_t pair) {
    return *std::min_element(table.upper.begin() + table.first_row[pair],
                             table.upper.begin() + table.first_row[pair + 1]);
  };
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : known_) smallest_upper = std::min(smallest_upper, upper_of(pair));

  scratch_.clear();
  for (const std::uint32_t pair : known_) {
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

void Triage::evaluate_urgent(const std::vector<ObjectState>& objects,
                             Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  for (std::size_t bin = 0; bin < kUrgentBins; ++bin) {
    scratch_.clear();
    for (const std::uint32_t pair : known_) {
      if (table.evaluated_cycle[pair] == evaluation.cycle) continue;
      if (bin_of(pair, objects, table) == bin) scratch_.push_back(pair);
    }
    evaluate_stalest(scratch_, evaluation);
  }
}

// Published pairs that outnumber the budget must not starve the rest: they take turns in what the
// round of all pairs leaves.
void Triage::evaluate_published(const std::vector<ObjectState>& objects,
                                Evaluation& evaluation) noexcept {
  const bool covered = published_.size() <= evaluation.queries_left;
  const std::uint32_t kept = covered ? 0 : std::min(per_tick_, evaluation.queries_left);
  for (std::size_t i = 0; i < published_.size() && evaluation.queries_left > kept; ++i) {
    if (next_published_ >= published_.size()) next_published_ = 0;
    const std::uint32_t pair = published_[next_published_++];
    if (evaluation.table.evaluated_cycle[pair] == evaluation.cycle) continue;
    if (!is_known(pair, objects, evaluation.table)) continue;
    carry(pair, objects, evaluation.parts, evaluation.table);
    evaluate_once(pair, evaluation);
  }
}

void Triage::evaluate_in_turn(const std::vector<ObjectState>& objects,
                              Evaluation& evaluation) noexcept {
  std::uint32_t left = per_tick_;
  // Passing over a pair costs little; still, there may be millions that nobody knows.
  const std::uint64_t turns = std::min<std::uint64_t>(evaluation.table.pairs(), 4ull * per_tick_);
  for (std::uint64_t turn = 0; turn < turns && left > 0 && evaluation.queries_left > 0; ++turn) {
    const std::uint32_t pair = round_.take_turn(evaluation.cycle);
    if (evaluation.table.evaluated_cycle[pair] == evaluation.cycle) continue;
    if (!is_known(pair, objects, evaluation.table)) continue;
    carry(pair, objects, evaluation.parts, evaluation.table);
    evaluate_once(pair, evaluation);
    --left;
  }
}

void Triage::evaluate_restless(Evaluation& evaluation) noexcept {
  std::uint32_t left = std::min(kMostRestless, evaluation.queries_left);
  for (const std::uint32_t pair : known_) {
    if (left == 0) return;
    if (evaluation.table.evaluated_cycle[pair] + kRestlessTicks >= evaluation.cycle &&
        evaluation.table.evaluated_cycle[pair] > 0) {
      continue;
    }
    evaluate_once(pair, evaluation);
    --left;
  }
}

void Triage::put_to_sleep(const std::vector<ObjectState>& objects,
                          const PairTable& table) noexcept {
  const auto sleeps = [&](std::uint32_t pair) {
    return is_known(pair, objects, table) && broad_phase_.sleep(pair, table.least_lower[pair]);
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

// A velocity that is not known counts as zero: the stated speed is what is left then, and a pair
// that has just been seen is evaluated anyway.
double Triage::speed_of(std::uint32_t object, const ObjectState& state) const noexcept {
  const double turning = state.twist.angular.norm();
  const double measured =
      state.twist.linear.norm() + (turning > 0.0 ? turning * reach_[object] : 0.0);
  return std::max(stated_speed_[object], measured);
}

std::size_t Triage::bin_of(std::uint32_t pair, const std::vector<ObjectState>& objects,
                           const PairTable& table) const noexcept {
  const std::uint32_t a = table.object_a[pair];
  const std::uint32_t b = table.object_b[pair];
  const double lower =
      table.least_lower[pair] - objects[a].may_have_moved - objects[b].may_have_moved;
  const double slack = lower - watch_below_[pair];
  if (!(slack > 0.0)) return 0;
  const double speed = speed_of(a, objects[a]) + speed_of(b, objects[b]);
  const double ticks = slack / (speed * period_s_);  // nothing moves: infinity
  std::size_t bin = 0;
  for (double until = 1.0; bin < kUrgentBins && !(ticks < until); until *= 2.0) ++bin;
  return bin;
}

}  // namespace clearance
