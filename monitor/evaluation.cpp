#include "monitor/evaluation.hpp"

#include <algorithm>

#include "core/radii.hpp"
#include "monitor/carried_direction.hpp"
#include "monitor/rounding.hpp"

namespace clearance {
namespace {

DistanceResult ask(std::uint32_t row, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PlacedPart& a = evaluation.parts[table.part_a[row]];
  const PlacedPart& b = evaluation.parts[table.part_b[row]];
  return distance(*a.shape, *b.shape, a.world_from_part, b.world_from_part, table.tracking[row]);
}

// point_on_b: the witness point in B's own frame, before the radius. Through A's frame it would be
// off by what rounding makes of how far the two are apart. `known`: bounds of the row before.
void take_in(const DistanceResult& found, const Vec3& point_on_b, const RowBounds& known,
             std::uint32_t row, const Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const PlacedPart& a = evaluation.parts[table.part_a[row]];
  const PlacedPart& b = evaluation.parts[table.part_b[row]];
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
  closest.normal = turn * found.normal;
  const Vec3 on_b = b.world_from_part_rotation * point_on_b + b.world_from_part.position;
  closest.witness_b = on_rounded_b(on_b, closest.normal, *b.shape);
  table.gap[row] = kept_gap(bounds.lower, closest.normal, a, b);
  table.status[row] = found.status;
  table.row_evaluated_cycle[row] = evaluation.cycle;
}

void query(std::uint32_t row, Evaluation& evaluation) noexcept {
  const DistanceResult found = ask(row, evaluation);
  const PairTable& table = evaluation.table;
  const RowBounds known{table.lower[row], table.upper[row]};
  take_in(found, table.tracking[row].b.point, known, row, evaluation);
  --evaluation.queries_left;
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

// A row among others that travel alone proves not to be the closest: brought up to date by that.
inline bool stays_out(std::uint32_t row, double travelled, double smallest_upper,
                      PairTable& table) noexcept {
  const double lower = rounded_down(table.lower[row] - travelled);
  if (!(lower >= smallest_upper)) return false;
  table.lower[row] = lower;
  table.upper[row] = rounded_up(table.upper[row] + travelled);
  return true;
}

// Any other row: brought up to date no more precisely than it takes to tell that it is not the
// closest, else evaluated. False: that would have taken a query too many.
bool settle_row(std::uint32_t row, double travelled, double smallest_upper,
                Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const RowBounds now = bounds_now(row, travelled, evaluation.parts, table);
  table.lower[row] = now.lower;
  table.upper[row] = now.upper;
  if (now.lower >= smallest_upper) return true;
  if (evaluation.queries_left == 0) return false;
  query(row, evaluation);
  return true;
}

void evaluate_rows(std::uint32_t pair, Evaluation& evaluation) noexcept {
  PairTable& table = evaluation.table;
  const double travelled = table.entries[pair].carried_cycle == evaluation.cycle
                               ? 0.0
                               : travelled_since(pair, evaluation.objects, table);
  const std::uint32_t likely = likely_row(pair, table);
  bool all_that_matter = settle_row(likely, travelled, kInfinity, evaluation);
  double smallest_upper = table.upper[likely], least = table.lower[likely];
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
    if (row == likely) continue;
    if (!stays_out(row, travelled, smallest_upper, table)) {
      if (!settle_row(row, travelled, smallest_upper, evaluation)) all_that_matter = false;
      smallest_upper = std::min(smallest_upper, table.upper[row]);
    }
    least = std::min(least, table.lower[row]);
  }
  note_carried(pair, evaluation.objects, evaluation.cycle, table);
  table.entries[pair].least_lower = least;
  if (all_that_matter) table.entries[pair].evaluated_cycle = evaluation.cycle;
}

}  // namespace

RowBounds for_exact_poses(const DistanceResult& found, const PlacedPart& a,
                          const PlacedPart& b) noexcept {
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
  take_in(found, point_on_b, known, row, evaluation);
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
