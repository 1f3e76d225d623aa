#include "monitor/pairs/pair_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/closing_speed.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/motion/relative_displacement.hpp"
#include "monitor/motion/swept_bound.hpp"

namespace clearance {
namespace {

// Of the distance: what objects have travelled leaves less than half of this open, where nobody
// has to know how they go together.
constexpr double kSmallTravel = 1.0 / 64.0;
// Of the travel: nor where directions leave less than this open.
constexpr double kSmallShare = 1.0 / 4096.0;

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
    case DistanceStatus::kDepthNotAsked:
    case DistanceStatus::kBadPose:
      break;
  }
  return PairStatus::kLoose;
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

RowBounds bounds_as_carried(const PairEntry& entry, const PairTable& table) noexcept {
  const auto first = table.upper.begin() + entry.first_row;
  const auto end = table.upper.begin() + entry.end_row;
  return {entry.least_lower, *std::min_element(first, end)};
}

RowBounds pair_bounds_now(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                          const std::vector<PosedPart>& parts, const PairTable& table) noexcept {
  const double travelled = travelled_since(pair, objects, table);
  RowBounds least{kInfinity, kInfinity};
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
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

// Of two objects that were known at the last tick and have not leapt since. `along`: what the
// directions of two evaluations tell, m.
double lower_on_the_way(const TrackedObject& a, const TrackedObject& b, double before, double now,
                        double along, Since since) noexcept {
  const double travel = rounded_up(a.travel + b.travel);
  if (travel == 0.0) return now;
  const bool told = along > -kInfinity;
  if (told && along >= std::min(before, now) - kSmallShare * travel) return std::min(now, along);
  const double lower = std::max(along, lower_by_ends(before, now, travel));
  const bool matters = travel > kSmallTravel * now && a.travel > 0.0 && b.travel > 0.0;
  if (since == Since::kByTravel || !matters) return std::min(now, lower);
  const double relative = std::min(travel, relative_travel(a, b));
  return std::min(now, std::max(lower, lower_by_ends(before, now, relative)));
}

double lower_along(std::uint32_t pair, std::uint64_t cycle, const PairTable& table) noexcept {
  return table.entries[pair].evaluated_cycle == cycle ? table.lower_between[pair] : -kInfinity;
}

// What summary_of() tells of the usual pair, brought up to date in this tick, in a third of the
// time.
PairBounds summary_of_one_row(std::uint32_t pair, const TrackedObject& a, const TrackedObject& b,
                              std::uint64_t cycle, const PairTable& table, Since since) noexcept {
  const PairEntry& entry = table.entries[pair];
  const std::uint32_t row = entry.first_row;
  const std::uint64_t evaluated = table.row_evaluated_cycle[row];
  const double upper = table.upper[row];
  return {
      .status = evaluated == cycle ? status_of(table.status[row]) : PairStatus::kCarried,
      .lower = entry.least_lower,
      .upper = upper,
      .swept_lower = lower_on_the_way(a, b, entry.lower_before, entry.least_lower,
                                      lower_along(pair, cycle, table), since),
      .swept_upper = upper,
      .row = row,
      .evaluated_cycle = evaluated,
  };
}

// What late objects may have moved unseen.
void count_lateness_in(const TrackedObject& a, const TrackedObject& b,
                       PairBounds& summary) noexcept {
  const double unseen_since = a.unseen_since + b.unseen_since;
  if (unseen_since > 0.0) {
    summary.swept_lower = rounded_down(summary.swept_lower - rounded_up(unseen_since));
    summary.swept_upper = rounded_up(summary.swept_upper + rounded_up(unseen_since));
  }
  if (!a.late && !b.late) return;
  const double may_have_moved = rounded_up(a.may_have_moved + b.may_have_moved);
  summary.lower = rounded_down(summary.lower - may_have_moved);
  summary.upper = rounded_up(summary.upper + may_have_moved);
  summary.swept_lower = std::min(summary.lower, summary.swept_lower);
  summary.status = PairStatus::kStale;
}

}  // namespace

PairReport unknown_report() noexcept {
  PairReport report;
  report.status = PairStatus::kUnknown;
  report.lower = report.swept_lower = -kInfinity;
  report.upper = kInfinity;
  report.distance = report.closing_speed = report.time_to_contact = kNan;
  report.witness_a = report.witness_b = report.normal = Vec3::Constant(kNan);
  return report;
}

double lower_since_last_tick(std::uint32_t pair, double lower,
                             const std::vector<TrackedObject>& objects, std::uint64_t cycle,
                             const PairTable& table, Since since) noexcept {
  const TrackedObject& a = objects[table.entries[pair].object_a];
  const TrackedObject& b = objects[table.entries[pair].object_b];
  if (a.began || b.began) return lower;
  if (a.leapt || b.leapt) return -kInfinity;
  return lower_on_the_way(a, b, lower_last_tick(pair, objects, cycle, table), lower,
                          lower_along(pair, cycle, table), since);
}

PairBounds summary_of(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                      const std::vector<PosedPart>& parts, std::uint64_t cycle,
                      const PairTable& table, Since since) noexcept {
  const PairEntry& entry = table.entries[pair];
  const TrackedObject& a = objects[entry.object_a];
  const TrackedObject& b = objects[entry.object_b];
  const bool carried = entry.carried_cycle == cycle;
  if (a.plain && b.plain && carried && entry.end_row - entry.first_row == 1) {
    return summary_of_one_row(pair, a, b, cycle, table, since);
  }
  PairBounds summary;
  if (!a.known() || !b.known()) return summary;
  const RowBounds now =
      carried ? bounds_as_carried(entry, table) : pair_bounds_now(pair, objects, parts, table);
  summary.lower = now.lower;
  summary.upper = summary.swept_upper = now.upper;
  summary.swept_lower = lower_since_last_tick(pair, now.lower, objects, cycle, table, since);
  summary.row = closest_row(entry.first_row, entry.end_row, table);
  summary.evaluated_cycle = table.row_evaluated_cycle[summary.row];
  summary.status = evaluated_status(entry.first_row, entry.end_row, summary.row, cycle, table);
  if (!a.plain || !b.plain) count_lateness_in(a, b, summary);
  return summary;
}

void report_on(std::uint32_t pair, const PairBounds& summary,
               const std::vector<TrackedObject>& objects, const std::vector<PosedPart>& parts,
               const PairTable& table, PairReport& report) noexcept {
  const TrackedObject& a = objects[table.entries[pair].object_a];
  const TrackedObject& b = objects[table.entries[pair].object_b];
  if (summary.status == PairStatus::kUnknown) report = unknown_report();
  report.pair = pair;
  report.age_a_ns = a.age_ns;
  report.age_b_ns = b.age_ns;
  if (summary.status == PairStatus::kUnknown) return;

  report.status = summary.status;
  report.lower = summary.lower;
  report.swept_lower = summary.swept_lower;
  report.upper = summary.upper;
  const ClosestPoints& closest = table.closest[summary.row];
  report.part_a = parts[table.part_a[summary.row]].index_in_object;
  report.part_b = parts[table.part_b[summary.row]].index_in_object;
  report.distance = closest.distance;
  report.witness_a = closest.witness_a;
  report.witness_b = closest.witness_b;
  report.normal = closest.normal;
  const bool has_speed = a.velocity_known() && b.velocity_known() && !closest.normal.isZero(0.0);
  report.closing_speed =
      has_speed ? closing_speed(velocity_at(closest.witness_a, a.pose, a.twist),
                                velocity_at(closest.witness_b, b.pose, b.twist), closest.normal)
                : kNan;
  report.time_to_contact = time_to_contact(report.distance, report.closing_speed);
  report.evaluated_cycle = summary.evaluated_cycle;
}

}  // namespace clearance
