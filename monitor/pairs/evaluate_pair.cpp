#include "monitor/pairs/evaluate_pair.hpp"

#include <algorithm>

#include "core/model/radii.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/motion/swept_bound.hpp"
#include "monitor/pairs/carried_gap.hpp"

namespace clearance {
namespace {

DistanceResult ask(std::uint32_t part_pair, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PosedPart& a = evaluation.parts[table.part_a[part_pair]];
  const PosedPart& b = evaluation.parts[table.part_b[part_pair]];
  return distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part,
                  table.tracking[part_pair]);
}

// How far both objects have come since the last tick, added up.
struct PairMotion {
  double displacement, bend;  // m; the latter a sum not rounded up
};

inline PairMotion motion_since_last_tick(const PairEntry& entry,
                                         const Evaluation& evaluation) noexcept {
  const TrackedObject& a = evaluation.objects[entry.object_a];
  const TrackedObject& b = evaluation.objects[entry.object_b];
  return {rounded_up(a.displacement + b.displacement), a.bend + b.bend};
}

// Returns what the directions of this evaluation and of one in the last tick tell of the time
// between them.
// point_on_b: the witness point in B's own frame, before the radius. Through A's frame it would be
// off by what rounding makes of how far the two are apart. `known`: bounds of the part pair before.
inline double take_in(const DistanceResult& found, const Vec3& point_on_b,
                      const DistanceBounds& known, std::uint32_t part_pair,
                      const PairMotion& motion, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PosedPart& a = evaluation.parts[table.part_a[part_pair]];
  const PosedPart& b = evaluation.parts[table.part_b[part_pair]];
  // What was carried is true as well, and a query that was cut short may know less.
  const DistanceBounds bounds = for_exact_poses(found, a, b);
  const double lower = std::max(known.lower, bounds.lower);
  const double upper = std::min(known.upper, bounds.upper);
  table.lower[part_pair] = lower;
  table.upper[part_pair] = upper;

  const Mat3& turn = a.world_from_part_rotation;
  ClosestPoints& closest = table.closest[part_pair];
  closest.distance = std::min(std::max(found.distance, lower), upper);
  closest.witness_a = turn * found.point_on_a + a.world_from_part.position;
  const Vec3 normal_before = closest.normal;
  const double lower_before = closest.lower;
  closest.normal = turn * found.normal;
  closest.lower = found.status == DistanceStatus::kConverged ? bounds.lower : -kInfinity;
  const Vec3 on_b = b.world_from_part_rotation * point_on_b + b.world_from_part.position;
  closest.witness_b = on_rounded_b(on_b, closest.normal, *b.shape);
  table.gap[part_pair] = kept_gap(bounds.lower, closest.normal, a, b);
  table.status[part_pair] = found.status;
  const bool was_last_tick = table.part_pair_evaluated_cycle[part_pair] + 1 == evaluation.cycle;
  table.part_pair_evaluated_cycle[part_pair] = evaluation.cycle;
  if (!was_last_tick) return -kInfinity;
  return lower_by_directions({normal_before, lower_before}, {closest.normal, closest.lower},
                             motion.displacement, motion.bend);
}

double query(std::uint32_t part_pair, const PairMotion& motion, Evaluation& evaluation) noexcept {
  const DistanceResult found = ask(part_pair, evaluation);
  const PairTable& table = evaluation.table;
  const DistanceBounds known{table.lower[part_pair], table.upper[part_pair]};
  evaluation.budget.spend();
  return take_in(found, table.tracking[part_pair].b.point, known, part_pair, motion, evaluation);
}

void carry(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  carry(pair, evaluation.objects, evaluation.parts, evaluation.cycle, evaluation.table);
}

// The part pair that was the closest, as far as is known, and mostly still is.
std::uint32_t likely_part_pair(std::uint32_t pair, const PairTable& table) noexcept {
  const auto first = table.upper.begin() + table.entries[pair].first_part_pair;
  const auto end = table.upper.begin() + table.entries[pair].end_part_pair;
  return static_cast<std::uint32_t>(std::min_element(first, end) - table.upper.begin());
}

// A pair of several part pairs on its way through them.
struct PartPairs {
  double displacement;  // since they were last brought up to date, m
  bool is_new;          // that was in this tick: of the last one nothing is known
  PairMotion motion;
  // Of those that did not stay out, m: the others are at least `smallest_upper` apart.
  double smallest_upper = kInfinity, least_lower = kInfinity;
  double between = kInfinity;  // at least so far apart since the last tick, m
  bool all_that_matter = true;
};

// A part pair among others that displacement alone proves not to be the closest: brought up to date
// by that. What is carried so was no nearer on the way from where it was before.
inline bool stays_out(std::uint32_t part_pair, PartPairs& part_pairs, PairTable& table) noexcept {
  const double lower = rounded_down(table.lower[part_pair] - part_pairs.displacement);
  if (!(lower >= part_pairs.smallest_upper)) return false;
  table.lower[part_pair] = lower;
  table.upper[part_pair] = rounded_up(table.upper[part_pair] + part_pairs.displacement);
  if (part_pairs.is_new)
    part_pairs.between =
        std::min(part_pairs.between, rounded_down(lower - part_pairs.motion.displacement));
  return true;
}

// Any other part pair: brought up to date no more precisely than it takes to tell that it is not
// the closest, else evaluated, as far as the budget goes.
void update_part_pair(std::uint32_t part_pair, PartPairs& part_pairs,
                      Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const double displacement = part_pairs.motion.displacement;
  const double before =
      part_pairs.is_new
          ? -kInfinity
          : rounded_down(table.lower[part_pair] - part_pairs.displacement + displacement);
  const DistanceBounds now =
      bounds_now(part_pair, part_pairs.displacement, evaluation.parts, table);
  table.lower[part_pair] = now.lower;
  table.upper[part_pair] = now.upper;
  double between = -kInfinity;
  const bool matters = now.lower < part_pairs.smallest_upper;
  if (matters && evaluation.budget.left() > 0) {
    between = query(part_pair, part_pairs.motion, evaluation);
  } else if (matters) {
    part_pairs.all_that_matter = false;
  }
  if (between == -kInfinity) between = lower_by_ends(before, table.lower[part_pair], displacement);
  part_pairs.smallest_upper = std::min(part_pairs.smallest_upper, table.upper[part_pair]);
  part_pairs.least_lower = std::min(part_pairs.least_lower, table.lower[part_pair]);
  part_pairs.between = std::min(part_pairs.between, between);
}

void evaluate_part_pairs(std::uint32_t pair, Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  PairEntry& entry = table.entries[pair];
  const bool carried = entry.carried_cycle == evaluation.cycle;
  PartPairs part_pairs{
      .displacement = carried ? 0.0 : displacement_since(pair, evaluation.objects, table),
      .is_new = carried || raised_this_tick(pair, evaluation.objects, table),
      .motion = motion_since_last_tick(entry, evaluation)};
  const std::uint32_t likely = likely_part_pair(pair, table);
  update_part_pair(likely, part_pairs, evaluation);
  for (std::uint32_t part_pair = entry.first_part_pair; part_pair < entry.end_part_pair;
       ++part_pair) {
    if (part_pair != likely && !stays_out(part_pair, part_pairs, table))
      update_part_pair(part_pair, part_pairs, evaluation);
  }
  note_carried(pair, evaluation.objects, evaluation.cycle, table);
  entry.least_lower = part_pairs.least_lower;
  table.lower_between[pair] = part_pairs.between;
  if (part_pairs.all_that_matter) entry.evaluated_cycle = evaluation.cycle;
}

}  // namespace

DistanceBounds for_exact_poses(const DistanceResult& found, const PosedPart& a,
                               const PosedPart& b) noexcept {
  const double error = placing_error(a, b);
  if (error == 0.0) return {found.lower, found.upper};
  return {rounded_down(found.lower - error), rounded_up(found.upper + error)};
}

// What was known before adds nothing to a tight answer.
void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
            const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const std::uint32_t part_pair = table.entries[pair].first_part_pair;
  PairEntry& entry = table.entries[pair];
  DistanceBounds known;
  if (found.status == DistanceStatus::kConverged) {
    note_carried(pair, evaluation.objects, evaluation.cycle, table);
  } else {
    carry(pair, evaluation);
    known = {table.lower[part_pair], table.upper[part_pair]};
  }
  table.lower_between[pair] = take_in(found, point_on_b, known, part_pair,
                                      motion_since_last_tick(entry, evaluation), evaluation);
  entry.least_lower = table.lower[part_pair];
  entry.evaluated_cycle = evaluation.cycle;
}

void evaluate(std::uint32_t pair, Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (evaluation.budget.left() == 0) return;
  if (table.part_pairs_of(pair) > 1) {
    evaluate_part_pairs(pair, evaluation);
    return;
  }
  const std::uint32_t part_pair = table.entries[pair].first_part_pair;
  const DistanceResult found = ask(part_pair, evaluation);
  settle(pair, found, table.tracking[part_pair].b.point, evaluation);
  evaluation.budget.spend();
}

}  // namespace clearance
