// Distance queries: from true bounds to tight ones.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/pairs/budget.hpp"
#include "monitor/pairs/pair_table.hpp"

namespace clearance {

// What the queries of one tick work on, and what is left of its budget.
struct Evaluation {
  const std::vector<TrackedObject>& objects;
  const std::vector<PosedPart>& parts;
  const std::uint64_t cycle;
  PairTable& table;
  Budget budget;
};

// Both objects' poses are known.
[[nodiscard]] inline bool is_known(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  return evaluation.objects[table.entries[pair].object_a].known() &&
         evaluation.objects[table.entries[pair].object_b].known();
}
// The pair was evaluated in this tick, all part pairs that matter.
[[nodiscard]] inline bool is_evaluated(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  return evaluation.table.entries[pair].evaluated_cycle == evaluation.cycle;
}

// Takes in the answer to a query of a pair's only part pair, which brings the pair up to date, and
// the witness point on B in B's own frame (TrackingState). Does not count the query.
void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
            const Evaluation& evaluation) noexcept;

// The bounds that a query tells are for the poses as it used them; these are for the exact ones.
[[nodiscard]] DistanceBounds for_exact_poses(const DistanceResult& found, const PosedPart& a,
                                             const PosedPart& b) noexcept;

// Brings an object pair up to date and evaluates it as far as the budget goes: the part pair that
// may be closest, then every other one that may be closer still. Rows whose carried bounds prove
// that they are not are left as they are: the pair's distance does not depend on them. Both objects
// are known.
void evaluate(std::uint32_t pair, Evaluation& evaluation) noexcept;

}  // namespace clearance
