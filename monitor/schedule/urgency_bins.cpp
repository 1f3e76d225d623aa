#include "monitor/schedule/urgency_bins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

std::vector<double> stated_speeds(const Scene& scene) {
  std::vector<double> speeds;
  for (const Object& object : scene.objects) {
    const bool stated = !object.fixed && std::isfinite(object.max_speed);
    speeds.push_back(stated ? object.max_speed : 0.0);
  }
  return speeds;
}

// Evaluates as many as the budget allows, the stalest first; pairs of equal age in their order.
void evaluate_stalest(std::span<std::uint32_t> pairs, const Evaluator& evaluator) noexcept {
  const LargeColumn<PairEntry>& entries = evaluator.tick.pairs.entries;
  const std::uint32_t queries = evaluator.budget.left();
  // A pair takes at least one query, so no more pairs than this can have a turn.
  if (pairs.size() > queries) {
    const auto staler = [&entries](std::uint32_t left, std::uint32_t right) {
      return std::tie(entries[left].evaluated_cycle, left) <
             std::tie(entries[right].evaluated_cycle, right);
    };
    const auto end = pairs.begin() + queries;
    std::nth_element(pairs.begin(), end, pairs.end(), staler);
    std::sort(pairs.begin(), end, staler);
    pairs = pairs.first(queries);
  }
  evaluator.evaluate_affordable(pairs);
}

}  // namespace

UrgencyBins::UrgencyBins(const Scene& scene, const ZoneLevels& levels,
                         std::vector<std::uint32_t>& in_bin)
    : levels_(levels),
      period_s_(1.0 / scene.rate_hz),
      stated_speed_(stated_speeds(scene)),
      in_bin_(in_bin) {}

std::vector<double> UrgencyBins::distances_ahead(const Scene& scene) {
  const double period_s = 1.0 / scene.rate_hz;
  std::vector<double> distances = stated_speeds(scene);
  for (double& distance : distances) distance *= kTicks * period_s;
  return distances;
}

void UrgencyBins::evaluate_urgent(const Evaluator& evaluator) noexcept {
  const TickView& view = evaluator.tick;
  std::array<bool, kBins> filled{};
  for (const std::uint32_t pair : evaluator.culling.updated()) {
    if (is_evaluated(pair, view)) continue;
    const std::size_t bin = bin_of(pair, view);
    if (bin < kBins) filled[bin] = true;
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (!filled[bin]) continue;
    in_bin_.clear();
    for (const std::uint32_t pair : evaluator.culling.updated()) {
      if (is_evaluated(pair, view)) continue;
      if (bin_of(pair, view) == bin) in_bin_.push_back(pair);
    }
    evaluate_stalest(in_bin_, evaluator);
  }
}

std::size_t UrgencyBins::bin_of(std::uint32_t pair, const TickView& view) const noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const std::uint32_t a = entry.object_a, b = entry.object_b;
  const std::span<const TrackedObject> objects = view.objects;
  const double lower = entry.least_lower - objects[a].may_have_moved - objects[b].may_have_moved;
  const double above = lower - std::max(levels_.largest_threshold(pair), 0.0);
  if (!(above > 0.0)) return 0;
  const double speed = speed_of(a, objects[a]) + speed_of(b, objects[b]);
  const double ticks = above / (speed * period_s_);  // infinity where nothing moves
  std::size_t bin = 0;
  for (double until = 1.0; bin < kBins && !(ticks < until); until *= 2.0) ++bin;
  return bin;
}

// A velocity that is not known is zero here, and then the stated speed counts. A pair of an object
// that has just become known is evaluated anyway.
double UrgencyBins::speed_of(std::uint32_t object, const TrackedObject& state) const noexcept {
  const double turning = state.twist.angular.norm();
  const double measured =
      state.twist.linear.norm() + (turning > 0.0 ? turning * state.bounding_radius : 0.0);
  return std::max(stated_speed_[object], measured);
}

}  // namespace clearance
