#include "monitor/triage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "monitor/rounding.hpp"

namespace clearance {

Triage::Triage(const Scene& scene, const std::vector<PlacedPart>& parts, const PairTable& table)
    : budget_(scene.budget),
      period_s_(1.0 / scene.rate_hz),
      reach_(scene.objects.size(), 0.0),
      speed_(scene.objects.size(), 0.0),
      watch_below_(scene.pairs.size(), 0.0),
      bin_(scene.pairs.size(), 0) {
  for (const PlacedPart& part : parts) {
    reach_[part.object] = std::max(reach_[part.object], part.reach);
  }
  for (const Object& object : scene.objects) {
    const bool stated = !object.fixed && std::isfinite(object.max_speed);
    stated_speed_.push_back(stated ? object.max_speed : 0.0);
  }
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) {
      const double margins = scene.objects[scene.pairs[pair].first].margin +
                             scene.objects[scene.pairs[pair].second].margin;
      watch_below_[pair] = std::max(watch_below_[pair], rounded_up(zone.leave_above + margins));
    }
  }
  for (const ObjectPair& pair : scene.pairs) published_.push_back(pair.publish);
  known_.reserve(table.pairs());
  scratch_.reserve(table.pairs());
}

std::uint32_t Triage::evaluate_due(const std::vector<ObjectState>& objects,
                                   const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                                   PairTable& table) noexcept {
  Evaluation evaluation{parts, cycle, table, budget_};
  if (find_known(objects, table) <= budget_) {
    for (const std::uint32_t pair : known_) evaluate(pair, evaluation);
  } else {
    find_speeds(objects);
    evaluate_closest(evaluation);
    evaluate_by_bins(objects, evaluation);
  }
  return budget_ - evaluation.queries_left;
}

std::uint32_t Triage::find_known(const std::vector<ObjectState>& objects,
                                 const PairTable& table) noexcept {
  known_.clear();
  std::uint32_t rows = 0;
  for (std::uint32_t pair = 0; pair < table.pairs(); ++pair) {
    if (!objects[table.object_a[pair]].known() || !objects[table.object_b[pair]].known()) continue;
    known_.push_back(pair);
    rows += table.first_row[pair + 1] - table.first_row[pair];
  }
  return rows;
}

void Triage::find_speeds(const std::vector<ObjectState>& objects) noexcept {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const double turning = objects[i].twist.angular.norm();
    const double measured =
        objects[i].twist.linear.norm() + (turning > 0.0 ? turning * reach_[i] : 0.0);
    speed_[i] = std::max(stated_speed_[i], measured);
  }
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
    if (table.least_lower[pair] < smallest_upper) scratch_.push_back(pair);
  }
  const auto later = [&table](std::uint32_t left, std::uint32_t right) {
    return std::tie(table.least_lower[left], left) > std::tie(table.least_lower[right], right);
  };
  std::make_heap(scratch_.begin(), scratch_.end(), later);
  while (!scratch_.empty() && evaluation.queries_left > 0) {
    std::pop_heap(scratch_.begin(), scratch_.end(), later);
    const std::uint32_t pair = scratch_.back();
    scratch_.pop_back();
    if (table.least_lower[pair] >= smallest_upper) return;
    evaluate(pair, evaluation);
    smallest_upper = std::min(smallest_upper, upper_of(pair));
  }
}

void Triage::evaluate_by_bins(const std::vector<ObjectState>& objects,
                              Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  std::array<std::size_t, kBins + 1> begin{};  // of each bin in scratch_, and the end of the last
  const auto due = [&](std::uint32_t pair) {
    return table.evaluated_cycle[pair] != evaluation.cycle;
  };
  for (const std::uint32_t pair : known_) {
    if (!due(pair)) continue;
    bin_[pair] = static_cast<std::uint8_t>(bin_of(pair, objects, table));
    ++begin[bin_[pair] + 1u];
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) begin[bin + 1] += begin[bin];
  scratch_.resize(begin[kBins]);
  std::array<std::size_t, kBins + 1> next = begin;
  for (const std::uint32_t pair : known_) {
    if (due(pair)) scratch_[next[bin_[pair]]++] = pair;
  }

  const std::span<std::uint32_t> pairs(scratch_);
  for (std::size_t bin = 0; bin < kUrgentBins; ++bin) {
    evaluate_stalest(pairs.subspan(begin[bin], begin[bin + 1] - begin[bin]), evaluation);
  }
  // Published pairs that outnumber the budget must not starve the rest: then all take turns.
  const std::size_t published = begin[kPublishedBin], rest = begin[kPublishedBin + 1];
  const bool covered = rest - published <= evaluation.queries_left;
  if (covered) evaluate_stalest(pairs.subspan(published, rest - published), evaluation);
  evaluate_stalest(pairs.subspan(covered ? rest : published), evaluation);
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
  for (const std::uint32_t pair : pairs) evaluate(pair, evaluation);
}

std::size_t Triage::bin_of(std::uint32_t pair, const std::vector<ObjectState>& objects,
                           const PairTable& table) const noexcept {
  const std::uint32_t a = table.object_a[pair];
  const std::uint32_t b = table.object_b[pair];
  const double lower =
      table.least_lower[pair] - objects[a].may_have_moved - objects[b].may_have_moved;
  const double slack = lower - watch_below_[pair];
  if (!(slack > 0.0)) return 0;
  const double ticks = slack / ((speed_[a] + speed_[b]) * period_s_);  // nothing moves: infinity
  std::size_t bin = 0;
  for (double until = 1.0; bin < kUrgentBins && !(ticks < until); until *= 2.0) ++bin;
  if (bin < kUrgentBins) return bin;
  return published_[pair] ? kPublishedBin : kPublishedBin + 1;
}

}  // namespace clearance
