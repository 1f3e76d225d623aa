#include "monitor/pairs/evaluate_pair.hpp"

#include <algorithm>

#include "core/model/radii.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/motion/swept_bound.hpp"
#include "monitor/pairs/carried_gap.hpp"

namespace clearance {
namespace {

DistanceResult ask(std::uint32_t row, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PosedPart& a = evaluation.parts[table.part_a[row]];
  const PosedPart& b = evaluation.parts[table.part_b[row]];
  return distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part, table.tracking[row]);
}

// What both objects have done since the last tick.
struct Gone {
  double travel, bend;  // m; the latter a sum not rounded up
};

inline Gone gone_since_last_tick(const PairEntry& entry, const Evaluation& evaluation) noexcept {
  const TrackedObject& a = evaluation.objects[entry.object_a];
  const TrackedObject& b = evaluation.objects[entry.object_b];
  return {rounded_up(a.travel + b.travel), a.bend + b.bend};
}

// Returns what the directions of this evaluation and of one in the last tick tell of the time
// between them.
// point_on_b: the witness point in B's own frame, before the radius. Through A's frame it would be
// off by what rounding makes of how far the two are apart. `known`: bounds of the row before.
inline double take_in(const DistanceResult& found, const Vec3& point_on_b, const RowBounds& known,
                      std::uint32_t row, const Gone& gone, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PosedPart& a = evaluation.parts[table.part_a[row]];
  const PosedPart& b = evaluation.parts[table.part_b[row]];
  // What was carried is true as well, and a query that was cut short may know less.
  const RowBounds bounds = for_exact_poses(found, a, b);
  const double lower = std::max(known.lower, bounds.lower);
  const double upper = std::min(known.upper, bounds.upper);
  table.lower[row] = lower;
  table.upper[row] = upper;

  const Mat3& turn = a.world_from_part_rotation;
  ClosestPoints& closest = table.closest[row];
  closest.distance = std::min(std::max(found.distance, lower), upper);
  closest.witness_a = turn * found.point_on_a + a.world_from_part.position;
  const Vec3 normal_before = closest.normal;
  const double lower_before = closest.lower;
  closest.normal = turn * found.normal;
  closest.lower = found.status == DistanceStatus::kConverged ? bounds.lower : -kInfinity;
  const Vec3 on_b = b.world_from_part_rotation * point_on_b + b.world_from_part.position;
  closest.witness_b = on_rounded_b(on_b, closest.normal, *b.shape);
  table.gap[row] = kept_gap(bounds.lower, closest.normal, a, b);
  table.status[row] = found.status;
  const bool was_last_tick = table.row_evaluated_cycle[row] + 1 == evaluation.cycle;
  table.row_evaluated_cycle[row] = evaluation.cycle;
  if (!was_last_tick) return -kInfinity;
  return lower_by_directions({normal_before, lower_before}, {closest.normal, closest.lower},
                             gone.travel, gone.bend);
}

double query(std::uint32_t row, const Gone& gone, Evaluation& evaluation) noexcept {
  const DistanceResult found = ask(row, evaluation);
  const PairTable& table = evaluation.table;
  const RowBounds known{table.lower[row], table.upper[row]};
  --evaluation.queries_left;
  return take_in(found, table.tracking[row].b.point, known, row, gone, evaluation);
}

void carry(std::uint32_t pair, const Evaluation& evaluation) noexcept {
  carry(pair, evaluation.objects, evaluation.parts, evaluation.cycle, evaluation.table);
}

// The row that was the closest, as far as is known, and mostly still is.
std::uint32_t likely_row(std::uint32_t pair, const PairTable& table) noexcept {
  const auto first = table.upper.begin() + table.entries[pair].first_row;
  const auto end = table.upper.begin() + table.entries[pair].end_row;
  return static_cast<std::uint32_t>(std::min_element(first, end) - table.upper.begin());
}

// A pair of several rows on its way through them.
struct Rows {
  double travelled;  // since they were last brought up to date, m
  bool is_new;       // that was in this tick: of the last one nothing is known
  Gone gone;
  // Of those that did not stay out, m: the others are at least `smallest_upper` apart.
  double smallest_upper = kInfinity, least_lower = kInfinity;
  double between = kInfinity;  // at least so far apart since the last tick, m
  bool all_that_matter = true;
};

// A row among others that travel alone proves not to be the closest: brought up to date by that.
// What is carried so was no nearer on the way from where it was before.
inline bool stays_out(std::uint32_t row, Rows& rows, PairTable& table) noexcept {
  const double lower = rounded_down(table.lower[row] - rows.travelled);
  if (!(lower >= rows.smallest_upper)) return false;
  table.lower[row] = lower;
  table.upper[row] = rounded_up(table.upper[row] + rows.travelled);
  if (rows.is_new) rows.between = std::min(rows.between, rounded_down(lower - rows.gone.travel));
  return true;
}

// Any other row: brought up to date no more precisely than it takes to tell that it is not the
// closest, else evaluated, as far as the budget goes.
void settle_row(std::uint32_t row, Rows& rows, Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const double travel = rows.gone.travel;
  const double before =
      rows.is_new ? -kInfinity : rounded_down(table.lower[row] - rows.travelled + travel);
  const RowBounds now = bounds_now(row, rows.travelled, evaluation.parts, table);
  table.lower[row] = now.lower;
  table.upper[row] = now.upper;
  double between = -kInfinity;
  const bool matters = now.lower < rows.smallest_upper;
  if (matters && evaluation.queries_left > 0) {
    between = query(row, rows.gone, evaluation);
  } else if (matters) {
    rows.all_that_matter = false;
  }
  if (between == -kInfinity) between = lower_by_ends(before, table.lower[row], travel);
  rows.smallest_upper = std::min(rows.smallest_upper, table.upper[row]);
  rows.least_lower = std::min(rows.least_lower, table.lower[row]);
  rows.between = std::min(rows.between, between);
}

void evaluate_rows(std::uint32_t pair, Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  PairEntry& entry = table.entries[pair];
  const bool carried = entry.carried_cycle == evaluation.cycle;
  Rows rows{.travelled = carried ? 0.0 : travelled_since(pair, evaluation.objects, table),
            .is_new = carried || raised_this_tick(pair, evaluation.objects, table),
            .gone = gone_since_last_tick(entry, evaluation)};
  const std::uint32_t likely = likely_row(pair, table);
  settle_row(likely, rows, evaluation);
  for (std::uint32_t row = entry.first_row; row < entry.end_row; ++row) {
    if (row != likely && !stays_out(row, rows, table)) settle_row(row, rows, evaluation);
  }
  note_carried(pair, evaluation.objects, evaluation.cycle, table);
  entry.least_lower = rows.least_lower;
  table.lower_between[pair] = rows.between;
  if (rows.all_that_matter) entry.evaluated_cycle = evaluation.cycle;
}

}  // namespace

RowBounds for_exact_poses(const DistanceResult& found, const PosedPart& a,
                          const PosedPart& b) noexcept {
  const double error = placing_error(a, b);
  if (error == 0.0) return {found.lower, found.upper};
  return {rounded_down(found.lower - error), rounded_up(found.upper + error)};
}

// What was known before adds nothing to a tight answer.
void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
            const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const std::uint32_t row = table.entries[pair].first_row;
  PairEntry& entry = table.entries[pair];
  RowBounds known;
  if (found.status == DistanceStatus::kConverged) {
    note_carried(pair, evaluation.objects, evaluation.cycle, table);
  } else {
    carry(pair, evaluation);
    known = {table.lower[row], table.upper[row]};
  }
  table.lower_between[pair] =
      take_in(found, point_on_b, known, row, gone_since_last_tick(entry, evaluation), evaluation);
  entry.least_lower = table.lower[row];
  entry.evaluated_cycle = evaluation.cycle;
}

void evaluate(std::uint32_t pair, Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (evaluation.queries_left == 0) return;
  if (table.rows_of(pair) > 1) {
    evaluate_rows(pair, evaluation);
    return;
  }
  const std::uint32_t row = table.entries[pair].first_row;
  const DistanceResult found = ask(row, evaluation);
  settle(pair, found, table.tracking[row].b.point, evaluation);
  --evaluation.queries_left;
}

}  // namespace clearance
