#include "monitor/pair_summary.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/closing.hpp"
#include "monitor/relative_travel.hpp"
#include "monitor/rounding.hpp"

namespace clearance {
namespace {

// Of the distance: what objects have travelled leaves less than half of this open, where nobody
// has to know how they go together.
constexpr double kSmallTravel = 1.0 / 64.0;

PairStatus status_of(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kConverged:
      return PairStatus::kConverged;
    case DistanceStatus::kTouching:
      return PairStatus::kTouching;
    case DistanceStatus::kOverlapping:
      return PairStatus::kOverlapping;
    case DistanceStatus::kFarAway:
    case DistanceStatus::kIterationLimit:
      break;
  }
  return PairStatus::kLoose;
}

// Both ends of the way bound what lies between: a pair that has come `there` cannot have been
// nearer than its distance before less `there`, nor than its distance now less what is left of
// `travel`.
double lower_between(double before, double now, double travel) noexcept {
  if (!(travel < kInfinity)) return now < kInfinity ? -kInfinity : now;
  const double halfway = 0.5 * (before + now - travel);
  const double lower = std::max({halfway, before - travel, now - travel});
  return std::min(now, rounded_down(lower - (std::abs(now) + travel) * 0x1p-50));
}

// The row with the smallest upper bound, evaluated ones before all others.
std::uint32_t closest_row(std::uint32_t first, std::uint32_t end, const PairTable& table) noexcept {
  std::uint32_t closest = first;
  for (std::uint32_t row = first + 1; row < end; ++row) {
    const bool evaluated = table.row_evaluated_cycle[row] > 0;
    const bool closest_evaluated = table.row_evaluated_cycle[closest] > 0;
    if (evaluated != closest_evaluated ? evaluated : table.upper[row] < table.upper[closest]) {
      closest = row;
    }
  }
  return closest;
}

RowBounds bounds_as_carried(std::uint32_t pair, const PairTable& table) noexcept {
  const auto first = table.upper.begin() + table.first_row[pair];
  const auto end = table.upper.begin() + table.first_row[pair + 1];
  return {table.least_lower[pair], *std::min_element(first, end)};
}

RowBounds pair_bounds_now(std::uint32_t pair, const std::vector<ObjectState>& objects,
                          const std::vector<PlacedPart>& parts, const PairTable& table) noexcept {
  const double travelled = travelled_since(pair, objects, table);
  RowBounds least{kInfinity, kInfinity};
  for (std::uint32_t row = table.first_row[pair]; row < table.first_row[pair + 1]; ++row) {
    const RowBounds now = bounds_now(row, travelled, parts, table);
    least.lower = std::min(least.lower, now.lower);
    least.upper = std::min(least.upper, now.upper);
  }
  return least;
}

// What this tick's evaluations say about the pair; kCarried when they do not decide it.
PairStatus evaluated_status(std::uint32_t first, std::uint32_t end, std::uint32_t closest,
                            std::uint64_t cycle, const PairTable& table) noexcept {
  if (table.row_evaluated_cycle[closest] != cycle) return PairStatus::kCarried;
  PairStatus status = status_of(table.status[closest]);
  for (std::uint32_t row = first; row < end; ++row) {
    if (row == closest || table.lower[row] >= table.upper[closest]) continue;
    if (table.row_evaluated_cycle[row] != cycle) return PairStatus::kCarried;
    if (status_of(table.status[row]) == PairStatus::kLoose) status = PairStatus::kLoose;
  }
  return status;
}

}  // namespace

PairReport unknown_report() noexcept {
  PairReport report;
  report.status = PairStatus::kUnknown;
  report.lower = report.lower_since = -kInfinity;
  report.upper = kInfinity;
  report.distance = report.closing_speed = report.time_to_contact = kNan;
  report.witness_a = report.witness_b = report.normal = Vec3::Constant(kNan);
  return report;
}

double lower_since_last_tick(std::uint32_t pair, double lower,
                             const std::vector<ObjectState>& objects, std::uint64_t cycle,
                             const PairTable& table, Since since) noexcept {
  const ObjectState& a = objects[table.object_a[pair]];
  const ObjectState& b = objects[table.object_b[pair]];
  if (a.began || b.began) return lower;
  if (a.leapt || b.leapt) return -kInfinity;
  double travel = rounded_up(a.travel + b.travel);
  if (travel == 0.0) return lower;
  const bool matters = travel > kSmallTravel * lower && a.travel > 0.0 && b.travel > 0.0;
  if (since == Since::kByRelative && matters) {
    travel = std::min(travel, relative_travel(a, b));
  }
  return lower_between(lower_last_tick(pair, objects, cycle, table), lower, travel);
}

PairSummary summary_of(std::uint32_t pair, const std::vector<ObjectState>& objects,
                       const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                       const PairTable& table, Since since) noexcept {
  const ObjectState& a = objects[table.object_a[pair]];
  const ObjectState& b = objects[table.object_b[pair]];
  PairSummary summary;
  if (!a.known() || !b.known()) return summary;
  const std::uint32_t first = table.first_row[pair];
  const std::uint32_t end = table.first_row[pair + 1];
  const bool carried = table.carried_cycle[pair] == cycle;
  const RowBounds now =
      carried ? bounds_as_carried(pair, table) : pair_bounds_now(pair, objects, parts, table);
  summary.lower = now.lower;
  summary.upper = now.upper;
  summary.lower_since = lower_since_last_tick(pair, summary.lower, objects, cycle, table, since);
  summary.upper_since = summary.upper;
  summary.row = closest_row(first, end, table);
  summary.evaluated_cycle = table.row_evaluated_cycle[summary.row];
  const double unseen_since = a.unseen_since + b.unseen_since;
  if (unseen_since > 0.0) {
    summary.lower_since = rounded_down(summary.lower_since - rounded_up(unseen_since));
    summary.upper_since = rounded_up(summary.upper_since + rounded_up(unseen_since));
  }
  if (!a.late && !b.late) {
    summary.status = evaluated_status(first, end, summary.row, cycle, table);
    return summary;
  }
  const double may_have_moved = rounded_up(a.may_have_moved + b.may_have_moved);
  summary.lower = rounded_down(summary.lower - may_have_moved);
  summary.upper = rounded_up(summary.upper + may_have_moved);
  summary.status = PairStatus::kStale;
  return summary;
}

void report_on(std::uint32_t pair, const PairSummary& summary,
               const std::vector<ObjectState>& objects, const std::vector<PlacedPart>& parts,
               const PairTable& table, PairReport& report) noexcept {
  const ObjectState& a = objects[table.object_a[pair]];
  const ObjectState& b = objects[table.object_b[pair]];
  if (summary.status == PairStatus::kUnknown) report = unknown_report();
  report.pair = pair;
  report.age_a_ns = a.age_ns;
  report.age_b_ns = b.age_ns;
  if (summary.status == PairStatus::kUnknown) return;

  report.status = summary.status;
  report.lower = summary.lower;
  report.lower_since = summary.lower_since;
  report.upper = summary.upper;
  const ClosestPoints& closest = table.closest[summary.row];
  report.part_a = parts[table.part_a[summary.row]].index_in_object;
  report.part_b = parts[table.part_b[summary.row]].index_in_object;
  report.distance = closest.distance;
  report.witness_a = closest.witness_a;
  report.witness_b = closest.witness_b;
  report.normal = closest.normal;
  report.closing_speed =
      a.velocity_known() && b.velocity_known()
          ? closing_speed(velocity_at(closest.witness_a, a.pose, a.twist),
                          velocity_at(closest.witness_b, b.pose, b.twist), closest.normal)
          : kNan;
  report.time_to_contact = time_to_contact(report.distance, report.closing_speed);
  report.evaluated_cycle = summary.evaluated_cycle;
}

}  // namespace clearance
