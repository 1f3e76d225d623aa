#include "monitor/schedule/culling.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/interface/invariant.hpp"
#include "monitor/pairs/carried_bounds.hpp"

namespace clearance {
namespace {

// If its data are not in the cache, an activated pair costs up to one query's time. A pair that is
// met for the first time costs up to two.
constexpr std::size_t kActivatedPerQuery = 2;
constexpr std::size_t kLeastActivated = 2'000;
// m. While the horizon is above a growing minimum, it follows by no more than this a tick.
constexpr double kHorizonStep = 0.002;

// Queries that prove pairs far must starve neither the refreshes nor pairs that are near, which get
// half of the budget.
std::uint32_t least_left(std::uint32_t budget, const RefreshShare& share) noexcept {
  const std::uint64_t refreshes = share.queries() <= budget ? share.queries() : 0;
  return std::max((budget + 1) / 2, static_cast<std::uint32_t>(refreshes));
}

}  // namespace

Culling::Culling(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
                 const ZoneLevels& zone_levels, std::vector<double> urgent,
                 std::span<const std::uint32_t> left_out, const RefreshShare& share,
                 const KnownHulls& known)
    : least_left_(least_left(scene.budget, share)),
      known_(scene),
      broad_phase_(scene, parts, table, zone_levels, std::move(urgent), left_out,
                   std::max(kLeastActivated, kActivatedPerQuery * scene.budget)),
      hulls_(scene, parts, known),
      is_updated_(table.pairs(), 0) {
  for (auto* list : {&active_, &updated_}) list->reserve(table.pairs());
  decided_.reserve(table.pairs());
}

void Culling::cull(std::span<const std::uint32_t> changed, double last_minimum,
                   const OpenTick& tick, Budget& budget) noexcept {
  for (const std::uint32_t pair : updated_) is_updated_[pair] = 0;
  updated_.clear();
  decided_.clear();
  known_.update(tick.objects, changed);
  follow(last_minimum);
  broad_phase_.begin(tick, changed);
  for (const std::uint32_t pair : active_) {
    if (is_known(pair, tick)) update(pair, tick);
  }
  set_first_horizon();
  decide_activated(tick, budget);
}

// The horizon stays a little above the minimum of the last tick. A minimum of -infinity (two bodies
// that no translation separates) does not move it.
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

// The minimum over the pairs that are activated now is not above it.
void Culling::set_first_horizon() noexcept {
  if (broad_phase_.horizon() > -kInfinity) return;
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : broad_phase_.activated()) {
    smallest_upper = std::min(smallest_upper, broad_phase_.by_spheres(pair).upper);
  }
  if (smallest_upper < kInfinity) broad_phase_.move_horizon(smallest_upper + kHeadroom);
}

bool Culling::covers(double minimum) const noexcept {
  const double horizon = broad_phase_.horizon();
  return updated_.size() == known_.known() || minimum <= horizon || !(horizon > -kInfinity);
}

void Culling::raise_horizon(double minimum, double step, const OpenTick& tick,
                            Budget& budget) noexcept {
  decided_.clear();
  broad_phase_.move_horizon(std::min(minimum + kHeadroom, broad_phase_.horizon() + step));
  decide_activated(tick, budget);
}

// Returns true when a lower bound of a known pair is `enough`. Tries the bounds of its models from
// coarse to fine, without the parts.
template <class Enough>
bool Culling::bound_by_models(std::uint32_t pair, std::uint32_t kept, const OpenTick& tick,
                              Budget& budget, const Enough& enough) noexcept {
  const DistanceBounds spheres = broad_phase_.by_spheres(pair);
  if (enough(spheres.lower)) return true;
  const bool hopeless = spheres.upper <= broad_phase_.horizon();
  if (hopeless || budget.left() <= std::max(least_left_, kept)) return false;
  if (!hulls_.possible(tick.pairs.entries[pair])) return false;
  const double lower = hulls_.lower(pair, tick, budget);
  if (!enough(lower)) return false;
  raise(pair, lower, tick);
  return true;
}

bool Culling::prove_far(std::uint32_t pair, std::uint32_t kept, const OpenTick& tick,
                        Budget& budget) noexcept {
  const auto is_far = [&](double lower) { return broad_phase_.is_far(pair, lower); };
  return bound_by_models(pair, kept, tick, budget, is_far);
}

void Culling::decide_activated(const OpenTick& tick, Budget& budget) noexcept {
  constexpr std::size_t kAhead = 8;
  const auto& activated = broad_phase_.activated();
  for (std::size_t i = 0; i < activated.size(); ++i) {
    if (i + kAhead < activated.size()) broad_phase_.fetch(activated[i + kAhead]);
    const std::uint32_t pair = activated[i];
    const auto [a, b] = broad_phase_.ends(pair);
    const bool known = tick.objects[a].known() && tick.objects[b].known();
    const auto culls = [&](double lower) { return broad_phase_.cull(pair, lower); };
    const bool proved_far = known && bound_by_models(pair, 0, tick, budget, culls);
    decided_.push_back({.pair = pair & 0x7fff'ffff, .proved_far = proved_far});
    if (proved_far) continue;
    if (known) {
      update(pair, tick);
      if (culls(tick.pairs.entries[pair].least_lower)) continue;
    }
    active_.push_back(pair);
  }
  broad_phase_.clear_activated();
}

void Culling::mark_updated(std::uint32_t pair) noexcept {
  if (is_updated_[pair]) return;
  is_updated_[pair] = 1;
  updated_.push_back(pair);
}

void Culling::update(std::uint32_t pair, const OpenTick& tick) noexcept {
  carry(pair, tick);
  mark_updated(pair);
}

void Culling::cull_active(const TickView& view) noexcept {
  std::erase_if(active_, [&](std::uint32_t pair) {
    return is_known(pair, view) && broad_phase_.cull(pair, view.pairs.entries[pair].least_lower);
  });
  if constexpr (kInvariantsChecked) broad_phase_.check_some();
}

UntouchedPairs Culling::untouched(const Displacements& displaced) const noexcept {
  CLEARANCE_INVARIANT(updated_.size() <= known_.known());
  return {.any = updated_.size() < known_.known(),
          .horizon = broad_phase_.horizon(),
          .waiting_lower = broad_phase_.waiting_lower(),
          .most_unobserved = displaced.most_unobserved,
          .most_displaced = displaced.most_displaced};
}

}  // namespace clearance
