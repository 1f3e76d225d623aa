// The state that the stages of a tick read, and the state that the stages which bring pairs up to
// date change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/bodies/model_errors.hpp"
#include "monitor/pairs/cloud_pairs.hpp"
#include "monitor/pairs/pair_table.hpp"

namespace clearance {

// The state that stages read: every object and part as placed in this tick, and the bounds of every
// pair.
struct TickView {
  std::span<const TrackedObject> objects;
  const std::vector<PosedPart>& parts;
  std::uint64_t cycle;  // counts ticks from 1
  const PairTable& pairs;
  std::int64_t now_ns = 0;              // the time of the tick
  CloudPairs* clouds = nullptr;         // null: the scene has no sensors
  const ModelErrors* errors = nullptr;  // null: the scene states none
};

// A tick whose pairs are still being carried and evaluated. Functions that take this one write to
// the table; functions that take a TickView do not.
struct OpenTick : TickView {
  PairTable& table;  // the same as `pairs`

  OpenTick(std::span<const TrackedObject> the_objects, const std::vector<PosedPart>& the_parts,
           std::uint64_t the_cycle, PairTable& the_table, std::int64_t the_time = 0,
           CloudPairs* the_clouds = nullptr, const ModelErrors* the_errors = nullptr) noexcept
      : TickView{the_objects, the_parts, the_cycle, the_table, the_time, the_clouds, the_errors},
        table(the_table) {}
};

// An object is known not to be there.
[[nodiscard]] inline bool is_absent(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  return view.objects[entry.object_a].absent || view.objects[entry.object_b].absent;
}
// One of the two parts is what a sensor sees.
[[nodiscard]] inline bool is_of_cloud(std::uint32_t part_pair, const TickView& view) noexcept {
  return view.clouds != nullptr && view.clouds->has(part_pair);
}
// Both objects' poses are known.
[[nodiscard]] inline bool is_known(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  return view.objects[entry.object_a].known() && view.objects[entry.object_b].known();
}
// The pair's bounds are of this tick.
[[nodiscard]] inline bool is_carried(std::uint32_t pair, const TickView& view) noexcept {
  return view.pairs.entries[pair].carried_cycle == view.cycle;
}
// All part pairs that matter to the pair's distance were evaluated in this tick.
[[nodiscard]] inline bool is_evaluated(std::uint32_t pair, const TickView& view) noexcept {
  return view.pairs.entries[pair].evaluated_cycle == view.cycle;
}

}  // namespace clearance
