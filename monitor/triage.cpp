#include "monitor/triage.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "monitor/rounding.hpp"

namespace clearance {

Triage::Triage(const Scene& scene, const PairTable& table)
    : budget_(scene.budget), period_s_(1.0 / scene.rate_hz), watch_below_(scene.pairs.size(), 0.0) {
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) {
      const double margins = scene.objects[scene.pairs[pair].first].margin +
                             scene.objects[scene.pairs[pair].second].margin;
      watch_below_[pair] = std::max(watch_below_[pair], rounded_up(zone.leave_above + margins));
    }
  }
  for (const ObjectPair& pair : scene.pairs) published_.push_back(pair.publish);
  known_.reserve(table.rows());
  scratch_.reserve(table.rows());
  bins_.assign(table.rows(), 0);
}

std::uint32_t Triage::evaluate_due(const std::vector<ObjectState>& objects,
                                   const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                                   PairTable& table) noexcept {
  Work work{objects, parts, cycle, table, budget_};
  find_known(work);
  if (known_.size() <= budget_) {
    evaluate_stalest(known_, work);
  } else {
    evaluate_closest(work);
    evaluate_by_bins(work);
  }
  return budget_ - work.queries_left;
}

void Triage::find_known(const Work& work) noexcept {
  known_.clear();
  for (std::uint32_t row = 0; row < work.table.rows(); ++row) {
    const ObjectState& a = work.objects[work.parts[work.table.part_a[row]].object];
    const ObjectState& b = work.objects[work.parts[work.table.part_b[row]].object];
    if (a.known() && b.known()) known_.push_back(row);
  }
}

void Triage::evaluate_closest(Work& work) noexcept {
  const std::vector<double>& lower = work.table.lower;
  const std::vector<double>& upper = work.table.upper;
  double smallest_upper = kInfinity;
  for (const std::uint32_t row : known_) smallest_upper = std::min(smallest_upper, upper[row]);

  scratch_.clear();
  for (const std::uint32_t row : known_) {
    if (lower[row] < smallest_upper) scratch_.push_back(row);
  }
  const auto later = [&lower](std::uint32_t left, std::uint32_t right) {
    return std::tie(lower[left], left) > std::tie(lower[right], right);
  };
  std::make_heap(scratch_.begin(), scratch_.end(), later);
  while (!scratch_.empty() && work.queries_left > 0) {
    std::pop_heap(scratch_.begin(), scratch_.end(), later);
    const std::uint32_t row = scratch_.back();
    scratch_.pop_back();
    if (lower[row] >= smallest_upper) return;
    evaluate(work.parts, row, work.cycle, work.table);
    --work.queries_left;
    smallest_upper = std::min(smallest_upper, upper[row]);
  }
}

void Triage::evaluate_by_bins(Work& work) noexcept {
  const auto due = [&work](std::uint32_t row) {
    return work.table.evaluation[row].cycle != work.cycle;
  };
  std::array<std::size_t, kBins> begin{};  // of each bin in scratch_
  std::size_t count = 0;
  for (const std::uint32_t row : known_) {
    if (!due(row)) continue;
    bins_[row] = static_cast<std::uint8_t>(bin_of(row, work));
    ++count;
    for (std::size_t later = bins_[row] + 1u; later < kBins; ++later) ++begin[later];
  }
  scratch_.resize(count);
  std::array<std::size_t, kBins> end = begin;
  for (const std::uint32_t row : known_) {
    if (due(row)) scratch_[end[bins_[row]]++] = row;
  }
  const std::span<std::uint32_t> rows(scratch_);
  for (std::size_t bin = 0; bin < kBins && work.queries_left > 0; ++bin) {
    evaluate_stalest(rows.subspan(begin[bin], end[bin] - begin[bin]), work);
  }
}

// As many as the budget allows; rows of equal age in their own order.
void Triage::evaluate_stalest(std::span<std::uint32_t> rows, Work& work) noexcept {
  const std::vector<Evaluation>& evaluation = work.table.evaluation;
  if (rows.size() > work.queries_left) {
    std::nth_element(rows.begin(), rows.begin() + work.queries_left, rows.end(),
                     [&evaluation](std::uint32_t left, std::uint32_t right) {
                       return std::tie(evaluation[left].cycle, left) <
                              std::tie(evaluation[right].cycle, right);
                     });
    rows = rows.first(work.queries_left);
  }
  for (const std::uint32_t row : rows) evaluate(work.parts, row, work.cycle, work.table);
  work.queries_left -= static_cast<std::uint32_t>(rows.size());
}

std::size_t Triage::bin_of(std::uint32_t row, const Work& work) const noexcept {
  const PlacedPart& a = work.parts[work.table.part_a[row]];
  const PlacedPart& b = work.parts[work.table.part_b[row]];
  const std::uint32_t pair = work.table.pair[row];
  const double lower = work.table.lower[row] - work.objects[a.object].may_have_moved -
                       work.objects[b.object].may_have_moved;
  const double slack = lower - watch_below_[pair];
  if (!(slack > 0.0)) return 0;
  const double ticks = slack / ((a.speed + b.speed) * period_s_);  // nothing moves: infinity
  const std::size_t last = published_[pair] ? kUrgentBins - 1 : kUrgentBins;
  std::size_t bin = 0;
  for (double until = 1.0; bin < last && !(ticks < until); until *= 2.0) ++bin;
  return bin;
}

}  // namespace clearance
