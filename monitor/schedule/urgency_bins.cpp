#include "monitor/schedule/urgency_bins.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

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

}  // namespace

UrgencyBins::UrgencyBins(const Scene& scene, const std::vector<PosedPart>& parts)
    : pairs_(scene.pairs),
      period_s_(1.0 / scene.rate_hz),
      reach_(scene.objects.size(), 0.0),
      stated_speed_(stated_speeds(scene)),
      zone_levels_(zone_levels(scene)) {
  for (const PosedPart& part : parts) {
    reach_[part.object] = std::max(reach_[part.object], part.reach);
  }
}

BroadPhase::Levels UrgencyBins::levels() const {
  BroadPhase::Levels levels{.zones = zone_levels_, .urgent = stated_speed_};
  for (double& level : levels.urgent) level *= kTicks * period_s_;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    levels.zones[p] += levels.urgent[pairs_[p].first] + levels.urgent[pairs_[p].second];
  }
  return levels;
}

std::size_t UrgencyBins::bin_of(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                                const PairTable& table) const noexcept {
  const std::uint32_t a = table.entries[pair].object_a;
  const std::uint32_t b = table.entries[pair].object_b;
  const double lower =
      table.entries[pair].least_lower - objects[a].may_have_moved - objects[b].may_have_moved;
  const double slack = lower - std::max(zone_levels_[pair], 0.0);
  if (!(slack > 0.0)) return 0;
  const double speed = speed_of(a, objects[a]) + speed_of(b, objects[b]);
  const double ticks = slack / (speed * period_s_);  // nothing moves: infinity
  std::size_t bin = 0;
  for (double until = 1.0; bin < kBins && !(ticks < until); until *= 2.0) ++bin;
  return bin;
}

// A velocity that is not known counts as zero: the stated speed is what is left then, and a pair
// that has just been seen is evaluated anyway.
double UrgencyBins::speed_of(std::uint32_t object, const TrackedObject& state) const noexcept {
  const double turning = state.twist.angular.norm();
  const double measured =
      state.twist.linear.norm() + (turning > 0.0 ? turning * reach_[object] : 0.0);
  return std::max(stated_speed_[object], measured);
}

}  // namespace clearance
