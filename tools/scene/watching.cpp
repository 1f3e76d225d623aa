#include "tools/scene/watching.hpp"

#include <algorithm>

#include "config/scene/scene.hpp"
#include "monitor/schedule/broad_phase.hpp"
#include "monitor/schedule/urgency_bins.hpp"

namespace clearance {
namespace {

// The distance that the objects move in a tick, m.
double a_tick(double speed) { return speed / Scene().rate_hz; }

// The margin that the broad phase takes off a pair's distance, m: the urgent ticks ahead and the
// one behind (BroadPhase::level_of).
double urgent(double speed) { return (UrgencyBins::kTicks + 1.0) * a_tick(speed); }

double least_allowance(double speed) {
  return BroadPhase::kLeastAllowance + BroadPhase::kLeastTicks * a_tick(speed);
}

// The distance at which two models cost the same, without the margin, m:
// c_i / (x - e_i) = c_j / (x - e_j).
double equal_at(const Level& i, const Level& j) {
  return (j.query_ns * i.error - i.query_ns * j.error) / (j.query_ns - i.query_ns);
}

}  // namespace

std::optional<WatchCost> watch_cost(const Level& level, const Watching& watching) {
  const double allowance = watching.distance - level.error - urgent(watching.speed);
  if (!(allowance >= least_allowance(watching.speed))) return std::nullopt;
  const double looks = watching.speed / allowance;
  return WatchCost{looks, looks * level.query_ns};
}

double error_of_equal_cost(double query_ns, double ns_per_s, const Watching& watching) {
  return watching.distance - urgent(watching.speed) - query_ns * watching.speed / ns_per_s;
}

std::optional<std::size_t> cheapest(std::span<const Level> levels, const Watching& watching) {
  std::optional<std::size_t> best;
  double least = 0.0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto cost = watch_cost(levels[i], watching);
    if (!cost || (best && !(cost->ns_per_s < least))) continue;
    best = i;
    least = cost->ns_per_s;
  }
  return best;
}

std::vector<CheapestFrom> cheapest_by_distance(std::span<const Level> levels, double speed) {
  std::vector<double> ends;  // the cheapest model changes only at these distances
  for (const Level& i : levels) {
    ends.push_back(i.error + least_allowance(speed) + urgent(speed));
    for (const Level& j : levels) {
      if (i.query_ns < j.query_ns) ends.push_back(equal_at(i, j) + urgent(speed));
    }
  }
  std::sort(ends.begin(), ends.end());
  std::vector<CheapestFrom> found;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double middle = k + 1 < ends.size() ? 0.5 * (ends[k] + ends[k + 1]) : 2.0 * ends[k];
    const auto best = cheapest(levels, {middle, speed});
    if (best && (found.empty() || found.back().level != *best)) found.push_back({ends[k], *best});
  }
  return found;
}

}  // namespace clearance
