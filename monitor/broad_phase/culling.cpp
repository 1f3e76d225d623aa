#include "monitor/broad_phase/culling.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/invariant.hpp"

namespace clearance {
namespace {

// Looking at a pair that was activated costs up to a query where memory is far, meeting one for the
// first time up to two.
constexpr std::size_t kActivatedPerQuery = 2;
constexpr std::size_t kLeastActivated = 2'000;
// The horizon follows a growing minimum by no more than this a tick while it is above it, m.
constexpr double kHorizonStep = 0.002;

// What proves pairs far may not starve those that are near: half of the budget is theirs; nor what
// has to be refreshed.
std::uint32_t least_left(std::uint32_t budget, const RefreshShare& share) noexcept {
  const std::uint64_t refreshes = share.queries() <= budget ? share.queries() : 0;
  return std::max((budget + 1) / 2, static_cast<std::uint32_t>(refreshes));
}

}  // namespace

Culling::Culling(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
                 const ZoneLevels& zone_levels, std::vector<double> urgent,
                 std::span<const std::uint32_t> left_out, const RefreshShare& share)
    : least_left_(least_left(scene.budget, share)),
      known_(scene),
      broad_phase_(scene, parts, zone_levels, std::move(urgent), left_out,
                   std::max(kLeastActivated, kActivatedPerQuery * scene.budget)),
      hulls_(scene, parts),
      is_seen_(table.pairs(), 0) {
  for (auto* list : {&active_, &seen_}) list->reserve(table.pairs());
  decided_.reserve(table.pairs());
}

void Culling::cull(std::span<const std::uint32_t> changed, double last_minimum,
                   Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : seen_) is_seen_[pair] = 0;
  seen_.clear();
  decided_.clear();
  known_.update(evaluation.objects, changed);
  follow(last_minimum);
  broad_phase_.begin(evaluation.objects, changed, evaluation.table);
  for (const std::uint32_t pair : active_) {
    if (is_known(pair, evaluation)) look_at(pair, evaluation);
  }
  find_horizon();
  decide_activated(evaluation);
}

// The horizon stays a little above the minimum of the last tick. What no translation parts
// (-infinity) moves it nowhere: every minimum is below it.
void Culling::follow(double minimum) noexcept {
  if (!std::isfinite(minimum)) return;
  const double horizon = broad_phase_.horizon();
  const double best = minimum + kHeadroom;
  if (!(horizon > -kInfinity) || best < horizon - kHeadroom) {
    broad_phase_.move_horizon(best);
  } else if (best > horizon + 0.5 * kHeadroom) {
    broad_phase_.move_horizon(std::min(best, horizon + kHorizonStep));
  }
}

// The first one: the minimum of the pairs seen so far is not beyond it.
void Culling::find_horizon() noexcept {
  if (broad_phase_.horizon() > -kInfinity) return;
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : broad_phase_.activated()) {
    smallest_upper = std::min(smallest_upper, broad_phase_.by_spheres(pair).upper);
  }
  if (smallest_upper < kInfinity) broad_phase_.move_horizon(smallest_upper + kHeadroom);
}

bool Culling::covers(double minimum) const noexcept {
  const double horizon = broad_phase_.horizon();
  return seen_.size() == known_.known() || minimum <= horizon || !(horizon > -kInfinity);
}

void Culling::raise_horizon(double minimum, double step, Evaluation& evaluation) noexcept {
  decided_.clear();
  broad_phase_.move_horizon(std::min(minimum + kHeadroom, broad_phase_.horizon() + step));
  decide_activated(evaluation);
}

// Whether a lower bound of a known pair is `enough`: by its models from coarse to fine, short of
// the parts.
template <class Enough>
bool Culling::by_models(std::uint32_t pair, std::uint32_t kept, Evaluation& evaluation,
                        const Enough& enough) noexcept {
  const DistanceBounds spheres = broad_phase_.by_spheres(pair);
  if (enough(spheres.lower)) return true;
  const bool hopeless = spheres.upper <= broad_phase_.horizon();
  if (hopeless || evaluation.budget.left() <= std::max(least_left_, kept)) return false;
  if (!hulls_.possible(evaluation.table.entries[pair])) return false;
  const double lower = hulls_.lower(pair, evaluation);
  if (!enough(lower)) return false;
  raise(pair, lower, evaluation.objects, evaluation.table);
  return true;
}

bool Culling::refresh_by_models(std::uint32_t pair, std::uint32_t kept,
                                Evaluation& evaluation) noexcept {
  const auto is_far = [&](double lower) { return broad_phase_.is_far(pair, lower); };
  return by_models(pair, kept, evaluation, is_far);
}

void Culling::decide_activated(Evaluation& evaluation) noexcept {
  for (const std::uint32_t pair : broad_phase_.activated()) {
    const bool known = is_known(pair, evaluation);
    const auto culls = [&](double lower) { return broad_phase_.cull(pair, lower); };
    const bool proved_far = known && by_models(pair, 0, evaluation, culls);
    decided_.push_back({pair, proved_far});
    if (proved_far) continue;
    if (known) {
      look_at(pair, evaluation);
      if (culls(evaluation.table.entries[pair].least_lower)) continue;
    }
    active_.push_back(pair);
  }
  broad_phase_.clear_activated();
}

void Culling::see(std::uint32_t pair) noexcept {
  if (is_seen_[pair]) return;
  is_seen_[pair] = 1;
  seen_.push_back(pair);
}

void Culling::look_at(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  carry(pair, evaluation.objects, evaluation.parts, evaluation.cycle, evaluation.table);
  see(pair);
}

void Culling::cull_active(const Evaluation& evaluation) noexcept {
  std::erase_if(active_, [&](std::uint32_t pair) {
    return is_known(pair, evaluation) &&
           broad_phase_.cull(pair, evaluation.table.entries[pair].least_lower);
  });
  if constexpr (kInvariantsChecked) broad_phase_.check_some();
}

UnseenPairs Culling::unseen(const Displacements& displaced) const noexcept {
  CLEARANCE_INVARIANT(seen_.size() <= known_.known());
  return {.any = seen_.size() < known_.known(),
          .horizon = broad_phase_.horizon(),
          .waiting_lower = broad_phase_.waiting_lower(),
          .most_unseen = displaced.most_unseen,
          .most_displaced = displaced.most_displaced};
}

}  // namespace clearance
