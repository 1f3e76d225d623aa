// All zones of a scene in one tick, from the pairs that are awake and what is known of the rest.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "monitor/objects/tracked_object.hpp"
#include "monitor/zones/zone_hysteresis.hpp"

namespace clearance {

class Zones {
 public:
  explicit Zones(const Scene& scene);

  // Before the pairs: takes the last tick's reports.
  void begin(const std::vector<ZoneReport>& reports) noexcept;

  [[nodiscard]] bool has(std::uint32_t pair) const noexcept { return !zones_of(pair).empty(); }
  // The pair is in none of its zones, whatever their hysteresis says, while it is at least this far
  // apart, m; -infinity: it has none.
  [[nodiscard]] double outside_from(std::uint32_t pair) const noexcept {
    return outside_from_.empty() ? -kInfinity : outside_from_[pair];
  }
  // The farthest distance below which the pair is inside a zone, of the zones that it is outside of
  // with `lower`, m, but not with `swept_lower`. -infinity: there is none.
  [[nodiscard]] double undecided(std::uint32_t pair, double lower,
                                 double swept_lower) const noexcept;

  // A pair that is awake.
  void add(std::uint32_t pair, const PairBounds& summary) noexcept;

  // What was not added: farther than its zones watch for since the last tick, at least `pending`
  // apart where that is less (margins not subtracted), or unknown. `objects`: none where all are
  // known and none has leapt.
  void finish(std::span<const TrackedObject> objects, const Clearance& pending, std::uint64_t cycle,
              std::vector<ZoneReport>& reports) noexcept;

 private:
  // An object of a zone, and one of its pairs there.
  struct Member {
    std::uint32_t object, pair;
  };
  // A zone of a pair, and both its objects' margins, rounded up, m.
  struct Membership {
    std::uint32_t zone;
    double margins;
  };
  [[nodiscard]] std::span<const Membership> zones_of(std::uint32_t pair) const noexcept {
    if (first_zone_.empty()) return {};
    return {zones_.data() + first_zone_[pair], zones_.data() + first_zone_[pair + 1]};
  }

  const Scene& scene_;
  // By pair; none where there are no zones.
  std::vector<std::uint32_t> first_zone_;
  std::vector<Membership> zones_;
  std::vector<double> outside_from_;          // m
  std::vector<std::vector<Member>> members_;  // by zone
  std::vector<double> most_margins_;          // by zone: of any of its pairs, m
  // By zone, of this tick.
  std::vector<ZoneHysteresis> updates_;
  std::vector<std::uint32_t> added_;
};

}  // namespace clearance
