// The distance from which on a pair is outside its zones. One table serves the broad phase, the
// schedule, the sweep and the zones.
//
// A zone has two thresholds of the clearance (distance less both margins), with hysteresis between:
// enter_below, and just above leave_above. A pair's level Z is the largest distance at the latter
// threshold, over all its zones, margins included and rounded up. At Z or farther, the pair is
// outside all of them, whatever their states are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

class ZoneLevels {
 public:
  explicit ZoneLevels(const Scene& scene);

  // A pair with this clearance, m, or more is outside a zone in this state.
  [[nodiscard]] static double threshold(const Zone& zone, bool active) noexcept;

  // Z of a pair, m; -infinity: the pair has no zone.
  [[nodiscard]] double largest_threshold(std::uint32_t pair) const noexcept {
    return largest_thresholds_.empty() ? -kInfinity : largest_thresholds_[pair];
  }

  // A zone of a pair, and both its objects' margins, rounded up, m.
  struct Membership {
    std::uint32_t zone;
    double margins;
  };
  [[nodiscard]] std::span<const Membership> zones_of(std::uint32_t pair) const noexcept {
    if (first_zone_.empty()) return {};
    return {zones_.data() + first_zone_[pair], zones_.data() + first_zone_[pair + 1]};
  }
  [[nodiscard]] bool has(std::uint32_t pair) const noexcept { return !zones_of(pair).empty(); }

  // An object of a zone, and one of its pairs there.
  struct Member {
    std::uint32_t object, pair;
  };
  [[nodiscard]] std::span<const Member> members_of(std::uint32_t zone) const noexcept {
    return members_[zone];
  }
  // The largest margins of any pair of a zone, rounded up, m.
  [[nodiscard]] double most_margins(std::uint32_t zone) const noexcept {
    return most_margins_[zone];
  }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("first zones of pairs", first_zone_);
    visit("zones of pairs", zones_);
    visit("thresholds of pairs", largest_thresholds_);
    visit("members of zones", members_);
    visit("margins of zones", most_margins_);
  }

 private:
  // By pair; empty where there are no zones.
  std::vector<std::uint32_t> first_zone_;
  std::vector<Membership> zones_;
  std::vector<double> largest_thresholds_;  // m
  // By zone.
  std::vector<std::vector<Member>> members_;
  std::vector<double> most_margins_;
};

}  // namespace clearance
