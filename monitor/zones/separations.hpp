// Stage 'separate' of a tick: speed and separation monitoring in the zones that ask for it, from
// the reports of their pairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/tracked_object.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

class Separations {
 public:
  // The scene must outlive it. The pairs of these zones are published.
  Separations(const Scene& scene, const ZoneLevels& levels);

  // Gives the report's lists their sizes; all figures are unknown.
  void prepare(Report& report) const;

  // `report.pairs` are of this tick. Allocates nothing.
  // `report_delay_ns`: TickTime.
  void write(std::span<const TrackedObject> objects, std::uint64_t cycle,
             std::int64_t report_delay_ns, Report& report) const noexcept;

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("zones with separation", zones_);
    visit("pairs of zones with separation", members_);
  }

 private:
  struct Member {
    std::uint32_t pair;       // index into Scene::pairs
    std::uint32_t published;  // and into Report::pairs
    std::uint32_t human, robot;
    bool human_is_first;
    double margins;  // m, rounded up
  };
  struct SeparatedZone {
    std::uint32_t zone;
    std::size_t first_member, end_member;
  };

  void write_pair(const SeparatedZone& zone, const Member& member, const PairReport& pair,
                  std::span<const TrackedObject> objects, std::uint64_t cycle,
                  std::int64_t report_delay_ns, PairSeparation& out) const noexcept;

  const Scene& scene_;
  std::vector<SeparatedZone> zones_;
  std::vector<Member> members_;  // zone by zone
};

}  // namespace clearance
