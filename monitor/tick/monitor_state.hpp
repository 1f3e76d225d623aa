// The inside of a monitor. Only its own sources include this, and tests that look inside.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/ask/stops.hpp"
#include "monitor/bodies/displacements.hpp"
#include "monitor/bodies/ingest.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/pairs/differentiate.hpp"
#include "monitor/pairs/hidden_places.hpp"
#include "monitor/pairs/pair_table.hpp"
#include "monitor/schedule/scheduler.hpp"
#include "monitor/schedule/zone_crossings.hpp"
#include "monitor/tick/conclude.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/self_test.hpp"
#include "monitor/zones/contacts.hpp"
#include "monitor/zones/separations.hpp"
#include "monitor/zones/zone_levels.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

// The state that one tick leaves to the next. Comments name the stages that change it.
struct Monitor::State {
  const Scene& scene;
  const ZoneLevels zone_levels;
  const RefreshShare share;
  const std::vector<std::uint32_t> first_part;  // by object
  const Published published;
  const std::vector<SourceName> named_sources;

  Inputs inputs;                                // ingest and displace
  std::vector<std::uint32_t> presence_changed;  // objects, since the last tick
  Displacer displacer;                          // displace
  std::vector<PosedPart> parts;                 // pose
  ModelErrors errors;                           // pose
  PairTable table;                              // cull, evaluate and refresh
  Scheduler scheduler;                          // schedule, evaluate and refresh
  Culling culling;                              // cull, evaluate, refresh and cull again
  Evaluated evaluated;                          // refresh
  ZoneCrossings crossings;                      // cross and sweep
  Contacts contacts;                            // allow and judge
  Zones zones;                                  // conclude
  Conclusion conclusion;                        // conclude
  const Separations separations;
  Stops stops;                      // stop
  Differentiation differentiation;  // differentiate
  Report report;                    // conclude, separate, differentiate and report

  // The objects of sensors, by their numbers.
  struct Shown {
    SensorFrame frame;   // that the next tick takes; its cloud is null: none
    SensorFrame in_use;  // likewise
    SourceClock clock;
    std::uint64_t awaited = 0;  // awaited_frame()
  };
  std::vector<Shown> shown;
  std::unique_ptr<CloudPairs> clouds;  // ingest and evaluate; null: the scene has no sensors
  HiddenPlaces hidden;                 // ingest
  // No partner and no replay goes on from its state. Made last, of all of the above.
  SelfTest self_test;

  // `similar`: null, or that of the monitor whose hulls are used again.
  State(const Scene& the_scene, const State* similar);

  // All above that no tick changes, and what it points to.
  [[nodiscard]] ConstantMemory constant_memory() const;
  [[nodiscard]] TickView view() const noexcept {
    return {inputs.objects,
            parts,
            inputs.cycle,
            table,
            inputs.time.now_ns,
            clouds.get(),
            errors.any() ? &errors : nullptr};
  }
  void make_absent(std::uint32_t object) noexcept;
  void note_presence(std::uint32_t object) noexcept;
  void drop_useless_frame(std::uint32_t sensor) noexcept;
  void take_frames() noexcept;
  void begin_first_tick() noexcept;
  void add_presence_changes() noexcept;
  void count_pairs() noexcept;
  void finish_report(std::uint32_t queries) noexcept;
  void write_minimum() noexcept;
  [[nodiscard]] PairBounds bounds(std::uint32_t pair) const noexcept;
  [[nodiscard]] PairReport pair_report(std::uint32_t pair) const noexcept;
};

}  // namespace clearance
