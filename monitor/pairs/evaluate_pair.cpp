#include "monitor/pairs/evaluate_pair.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/radii.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/swept_bound.hpp"
#include "monitor/pairs/carried_bounds.hpp"
#include "monitor/pairs/carried_gap.hpp"

namespace clearance {
namespace {

// A part pair that is queried in this tick.
struct Queried {
  std::uint32_t part_pair;
  const PosedPart &a, &b;
  Evaluation& evaluation;
  Queried(std::uint32_t of, const OpenTick& tick) noexcept
      : part_pair(of),
        a(tick.parts[tick.pairs.part_a(of)]),
        b(tick.parts[tick.pairs.part_b(of)]),
        evaluation(tick.table.evaluations.of_query(of, tick.cycle)) {}
  [[nodiscard]] DistanceResult distance() const noexcept {
    return clearance::distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part,
                               evaluation.tracking);
  }
};

// The motion of both objects since the last tick, added up.
struct PairMotion {
  double displacement, bend;  // TrackedObject, m; the sum of the bends is not rounded up
};

inline PairMotion motion_since_last_tick(const PairEntry& entry, const TickView& view) noexcept {
  const TrackedObject& a = view.objects[entry.object_a];
  const TrackedObject& b = view.objects[entry.object_b];
  return {rounded_up(a.displacement + b.displacement), a.bend + b.bend};
}

// Bounds of a part pair by its direction, for all postures within the stated errors. `exact`: for
// the model as stated. Two points of the bodies are apart by the distance and the error along the
// direction, and by the whole error across it.
[[gnu::noinline]] void note_errors(const Queried& queried, DistanceStatus status,
                                   const DistanceBounds& exact, bool was_last_tick,
                                   const PairMotion& motion, const OpenTick& tick) noexcept {
  ErrorBounds& errors = tick.table.errors[queried.part_pair];
  const double lower_last_tick = was_last_tick ? errors.lower : -kInfinity;
  errors.lower_before = lower_last_tick;
  errors.lower = -kInfinity;
  errors.upper = kInfinity;
  errors.loss = errors.between.largest;
  errors.drift = 0.0;
  const Vec3& normal = queried.evaluation.closest.normal;
  // The direction of a query that was cut short need not prove its lower bound.
  const bool is_proved = status == DistanceStatus::kConverged ||
                         status == DistanceStatus::kTouching ||
                         status == DistanceStatus::kOverlapping;
  if (!is_proved || normal.isZero(0.0) || !std::isfinite(exact.lower)) return;
  const ErrorAlong along =
      tick.errors->along(queried.a, queried.b, normal, errors.between, motion.displacement);
  errors.loss = along.loss;
  errors.drift = along.drift;
  errors.lower = rounded_down(exact.lower - along.loss);
  if (status != DistanceStatus::kConverged || !(exact.lower > 0.0)) return;
  const double largest = errors.between.largest;
  // The points are not exactly across the direction from each other.
  const double skew = std::sqrt(2.0 * (1.0 - exact.lower / exact.upper)) * largest;
  const double most = rounded_up(exact.upper + (exact.upper - exact.lower) + along.loss + skew);
  errors.upper = rounded_up(rounded_up(std::sqrt(most * most + largest * largest)));
}

// Writes a query's answer into the table. Returns a lower bound of the distance since the last
// tick. It follows from the directions of this evaluation and of one in the last tick. -infinity:
// they prove none.
//
// `point_on_b` is the witness point in B's local frame, without B's radius. A point in A's frame
// would have a rounding error that grows with the distance between the two. `known`: bounds of the
// part pair before the query.
inline double write_answer(const DistanceResult& found, const Vec3& point_on_b,
                           const DistanceBounds& known, const Queried& queried,
                           const PairMotion& motion, const OpenTick& tick) noexcept {
  PairTable& table = tick.table;
  const auto& [part_pair, a, b, evaluation] = queried;
  // The carried bounds are true as well, and a query that was cut short may be looser.
  const DistanceBounds exact = for_exact_poses(found, a, b);
  const bool has_errors = tick.errors != nullptr;
  const DistanceBounds bounds = has_errors ? widened(exact, table.largest_error(part_pair)) : exact;
  const double lower = std::max(known.lower, bounds.lower);
  const double upper = std::min(known.upper, bounds.upper);
  table.lower[part_pair] = lower;
  table.upper[part_pair] = upper;

  const Mat3& turn = a.world_from_part_rotation;
  ClosestPoints& closest = evaluation.closest;
  closest.distance = std::min(std::max(found.distance, lower), upper);
  closest.witness_a = turn * found.point_on_a + a.world_from_part.position;
  const Vec3 normal_before = closest.normal;
  const double lower_before = closest.lower;
  closest.normal = turn * found.normal;
  closest.lower = found.status == DistanceStatus::kConverged ? bounds.lower : -kInfinity;
  const Vec3 on_b = b.world_from_part_rotation * point_on_b + b.world_from_part.position;
  closest.witness_b = on_rounded_b(on_b, closest.normal, *b.shape);
  evaluation.gap = kept_gap(bounds.lower, closest.normal, a, b);
  evaluation.status = found.status;
  const bool was_last_tick = table.evaluations.cycle(part_pair) + 1 == tick.cycle;
  table.evaluations.set_cycle(part_pair, tick.cycle);
  if (has_errors) [[unlikely]] {
    note_errors(queried, found.status, exact, was_last_tick, motion, tick);
    closest.lower =
        found.status == DistanceStatus::kConverged ? table.errors[part_pair].lower : -kInfinity;
  }
  if (!was_last_tick) return -kInfinity;
  const double between =
      lower_by_directions({normal_before, lower_before}, {closest.normal, closest.lower},
                          motion.displacement, motion.bend);
  return has_errors ? between - table.errors[part_pair].drift : between;
}

// The same for what a sensor sees. Its direction separates no more than the nearest element, so it
// bounds nothing at other poses.
double query_cloud(std::uint32_t part_pair, const OpenTick& tick, Budget& budget) noexcept {
  PairTable& table = tick.table;
  const CloudPairs::Answer found = tick.clouds->query(
      part_pair, tick.parts[table.part_a(part_pair)], tick.parts[table.part_b(part_pair)]);
  budget.spend();
  const DistanceBounds bounds = widened(found.bounds, table.largest_error(part_pair));
  const double lower = std::max(table.lower[part_pair], bounds.lower);
  const double upper = std::min(table.upper[part_pair], bounds.upper);
  table.lower[part_pair] = lower;
  table.upper[part_pair] = upper;
  Evaluation& evaluation = table.evaluations.of_query(part_pair, tick.cycle);
  ClosestPoints& closest = evaluation.closest;
  closest.distance = 0.5 * (lower + upper);
  closest.witness_a = found.witness_a;
  closest.witness_b = found.witness_b;
  closest.normal = found.normal;
  closest.lower = evaluation.gap = -kInfinity;
  evaluation.status = found.status;
  table.evaluations.set_cycle(part_pair, tick.cycle);
  return -kInfinity;
}

// Queries a part pair; returns what write_answer() does.
double query_part_pair(std::uint32_t part_pair, const PairMotion& motion, const OpenTick& tick,
                       Budget& budget) noexcept {
  if (is_of_cloud(part_pair, tick)) [[unlikely]]
    return query_cloud(part_pair, tick, budget);
  const Queried queried(part_pair, tick);
  const DistanceResult found = queried.distance();
  const DistanceBounds known{tick.pairs.lower[part_pair], tick.pairs.upper[part_pair]};
  budget.spend();
  return write_answer(found, queried.evaluation.tracking.b.point, known, queried, motion, tick);
}

// The part pair with the smallest upper bound: mostly the closest one.
std::uint32_t likely_part_pair(std::uint32_t pair, const PairTable& table) noexcept {
  const auto first = table.upper.begin() + table.first_part_pair(pair);
  const auto end = table.upper.begin() + table.end_part_pair(pair);
  return static_cast<std::uint32_t>(std::min_element(first, end) - table.upper.begin());
}

// The bounds of a pair of several part pairs while these are brought up to date one by one.
struct PartPairs {
  double displacement;  // since they were last brought up to date, m
  bool is_new;          // that was in this tick, so nothing is known of the last one
  PairMotion motion;
  // Over the part pairs that displacement alone did not rule out, m. All others have
  // a distance of at least `smallest_upper`.
  double smallest_upper = kInfinity, least_lower = kInfinity;
  double between = kInfinity;  // the distance was at least this since the last tick, m
  bool all_that_matter = true;
};

// Brings a part pair up to date by displacement alone, if that proves that it is not the closest.
// Bounds that are carried so hold at every instant since they were found.
inline bool rule_out(std::uint32_t part_pair, PartPairs& part_pairs, PairTable& table) noexcept {
  const double lower = rounded_down(table.lower[part_pair] - part_pairs.displacement);
  if (!(lower >= part_pairs.smallest_upper)) return false;
  table.lower[part_pair] = lower;
  table.upper[part_pair] = rounded_up(table.upper[part_pair] + part_pairs.displacement);
  if (part_pairs.is_new)
    part_pairs.between =
        std::min(part_pairs.between, rounded_down(lower - part_pairs.motion.displacement));
  return true;
}

// Brings any other part pair up to date, and queries it if it may be the closest and the budget
// has a query left.
void update_part_pair(std::uint32_t part_pair, PartPairs& part_pairs, const OpenTick& tick,
                      Budget& budget) noexcept {
  PairTable& table = tick.table;
  const double displacement = part_pairs.motion.displacement;
  const double before =
      part_pairs.is_new
          ? -kInfinity
          : rounded_down(table.lower[part_pair] - part_pairs.displacement + displacement);
  const DistanceBounds now = bounds_now(part_pair, part_pairs.displacement, tick);
  table.lower[part_pair] = now.lower;
  table.upper[part_pair] = now.upper;
  double between = -kInfinity;
  const bool matters = now.lower < part_pairs.smallest_upper;
  if (matters && budget.left() > 0) {
    between = query_part_pair(part_pair, part_pairs.motion, tick, budget);
  } else if (matters) {
    part_pairs.all_that_matter = false;
  }
  if (between == -kInfinity) between = lower_by_ends(before, table.lower[part_pair], displacement);
  part_pairs.smallest_upper = std::min(part_pairs.smallest_upper, table.upper[part_pair]);
  part_pairs.least_lower = std::min(part_pairs.least_lower, table.lower[part_pair]);
  part_pairs.between = std::min(part_pairs.between, between);
}

void evaluate_part_pairs(std::uint32_t pair, const OpenTick& tick, Budget& budget) noexcept {
  PairTable& table = tick.table;
  PairEntry& entry = table.entries[pair];
  const bool carried = is_carried(pair, tick);
  PartPairs part_pairs{.displacement = carried ? 0.0 : displacement_since(pair, tick),
                       .is_new = carried || raised_this_tick(pair, tick),
                       .motion = motion_since_last_tick(entry, tick)};
  const std::uint32_t likely = likely_part_pair(pair, table);
  update_part_pair(likely, part_pairs, tick, budget);
  const std::uint32_t first = table.first_part_pair(pair), end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = first; part_pair < end; ++part_pair) {
    if (part_pair != likely && !rule_out(part_pair, part_pairs, table))
      update_part_pair(part_pair, part_pairs, tick, budget);
  }
  note_carried(pair, tick);
  entry.least_lower = part_pairs.least_lower;
  table.evaluations.of_query(first, tick.cycle).lower_between = part_pairs.between;
  if (part_pairs.all_that_matter) entry.evaluated_cycle = tick.cycle;
}

}  // namespace

DistanceBounds for_exact_poses(const DistanceResult& found, const PosedPart& a,
                               const PosedPart& b) noexcept {
  const double error = placing_error(a, b);
  if (error == 0.0) return {found.lower, found.upper};
  return {rounded_down(found.lower - error), rounded_up(found.upper + error)};
}

namespace {

// Carried bounds would add nothing to the bounds of a converged answer.
inline void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
                   const Queried& queried, const OpenTick& tick) noexcept {
  PairTable& table = tick.table;
  const std::uint32_t part_pair = queried.part_pair;
  PairEntry& entry = table.entries[pair];
  DistanceBounds known;
  if (found.status == DistanceStatus::kConverged) {
    note_carried(pair, tick);
  } else {
    carry(pair, tick);
    known = {table.lower[part_pair], table.upper[part_pair]};
  }
  queried.evaluation.lower_between =
      write_answer(found, point_on_b, known, queried, motion_since_last_tick(entry, tick), tick);
  entry.least_lower = table.lower[part_pair];
  entry.evaluated_cycle = tick.cycle;
}

}  // namespace

void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
            const OpenTick& tick) noexcept {
  settle(pair, found, point_on_b, Queried(tick.pairs.first_part_pair(pair), tick), tick);
}

void evaluate_pair(std::uint32_t pair, const OpenTick& tick, Budget& budget) noexcept {
  const PairTable& table = tick.pairs;
  if (table.part_pairs_of(pair) > 1 || is_of_cloud(table.first_part_pair(pair), tick)) {
    evaluate_part_pairs(pair, tick, budget);
    return;
  }
  const Queried queried(table.first_part_pair(pair), tick);
  const DistanceResult found = queried.distance();
  settle(pair, found, queried.evaluation.tracking.b.point, queried, tick);
  budget.spend();
}

DistanceBounds queried_bounds(std::uint32_t pair, double level, const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  DistanceBounds all{kInfinity, kInfinity};
  for (std::uint32_t p = table.first_part_pair(pair); p < table.end_part_pair(pair); ++p) {
    const PosedPart& a = view.parts[table.part_a(p)];
    const PosedPart& b = view.parts[table.part_b(p)];
    DistanceBounds bounds;
    if (is_of_cloud(p, view)) {
      bounds = view.clouds->query(p, a, b).bounds;
    } else {
      TrackingState tracking = table.evaluations[p].tracking;
      bounds = for_exact_poses(
          distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part, tracking), a, b);
    }
    bounds = widened(bounds, table.largest_error(p));
    all.lower = std::min(all.lower, bounds.lower);
    all.upper = std::min(all.upper, bounds.upper);
    if (all.upper < level) break;
  }
  // The part pairs that are left may be nearer.
  if (all.upper < level) all.lower = -kInfinity;
  return all;
}

std::size_t evaluate_pairs(std::span<const std::uint32_t> pairs, const OpenTick& tick,
                           Budget& budget) noexcept {
  std::size_t done = 0;
  for (; done < pairs.size() && budget.left() > 0; ++done) {
    evaluate_pair(pairs[done], tick, budget);
  }
  return done;
}

}  // namespace clearance
