#include "monitor/pairs/pair_table.hpp"

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/pairs/carried_gap.hpp"

namespace clearance {
namespace {

// How far an object has come between two readings. Equal readings mean that it has not moved.
double between(double before, double now) noexcept {
  return now == before ? 0.0 : rounded_up(now - before);
}

}  // namespace

ClosestPoints::ClosestPoints() noexcept
    : distance(kNan),
      lower(-kInfinity),
      witness_a(Vec3::Constant(kNan)),
      witness_b(Vec3::Constant(kNan)),
      normal(Vec3::Constant(kNan)) {}

PairTable::PairTable(const Scene& scene, const std::vector<PosedPart>& parts) {
  std::vector<std::vector<std::uint32_t>> parts_by_object(scene.objects.size());
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    parts_by_object[parts[part].object].push_back(part);
  }
  std::size_t all_rows = 0;
  for (const ObjectPair& pair : scene.pairs) {
    all_rows += parts_by_object[pair.first].size() * parts_by_object[pair.second].size();
  }
  entries.reserve(scene.pairs.size());
  for (auto* column : {&part_a, &part_b}) column->reserve(all_rows);
  for (const ObjectPair& pair : scene.pairs) {
    PairEntry& entry = entries.emplace_back();
    entry.object_a = pair.first;
    entry.object_b = pair.second;
    entry.first_row = rows();
    for (const std::uint32_t a : parts_by_object[pair.first]) {
      for (const std::uint32_t b : parts_by_object[pair.second]) {
        part_a.push_back(a);
        part_b.push_back(b);
      }
    }
    entry.end_row = rows();
  }
  lower_between.assign(pairs(), -kInfinity);
  lower.assign(rows(), -kInfinity);
  upper.assign(rows(), kInfinity);
  row_evaluated_cycle.assign(rows(), 0);
  status.assign(rows(), DistanceStatus::kIterationLimit);
  tracking.resize(rows());
  closest.resize(rows());
  gap.assign(rows(), -kInfinity);
}

double travelled_since(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                       const PairTable& table) noexcept {
  const Travelled& then = table.entries[pair].carried_at;
  const double sum = between(then.a, objects[table.entries[pair].object_a].travelled) +
                     between(then.b, objects[table.entries[pair].object_b].travelled);
  return rounded_up(sum);
}

bool raised_this_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                      const PairTable& table) noexcept {
  const PairEntry& entry = table.entries[pair];
  return entry.carried_at.a > objects[entry.object_a].travelled_before ||
         entry.carried_at.b > objects[entry.object_b].travelled_before;
}

double lower_last_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                       std::uint64_t cycle, const PairTable& table) noexcept {
  if (table.entries[pair].carried_cycle == cycle) return table.entries[pair].lower_before;
  const Travelled& then = table.entries[pair].carried_at;
  const double before_a = objects[table.entries[pair].object_a].travelled_before;
  const double before_b = objects[table.entries[pair].object_b].travelled_before;
  const double lower = table.entries[pair].least_lower;
  if (then.a == before_a && then.b == before_b) return lower;
  if (raised_this_tick(pair, objects, table)) return -kInfinity;
  const double travelled = between(then.a, before_a) + between(then.b, before_b);
  return travelled > 0.0 ? rounded_down(lower - rounded_up(travelled)) : lower;
}

RowBounds bounds_now(std::uint32_t row, double travelled, const std::vector<PosedPart>& parts,
                     const PairTable& table) noexcept {
  RowBounds bounds{table.lower[row], table.upper[row]};
  if (travelled > 0.0) {
    bounds.lower = rounded_down(bounds.lower - travelled);
    bounds.upper = rounded_up(bounds.upper + travelled);
  }
  const PosedPart& part_a = parts[table.part_a[row]];
  const PosedPart& part_b = parts[table.part_b[row]];
  if (travelled > 0.0 && table.gap[row] > -kInfinity) {
    const Vec3& normal = table.closest[row].normal;
    bounds.lower = std::max(bounds.lower, lower_along(normal, table.gap[row], part_a, part_b));
  }
  const Ball& a = part_a.ball_in_world;
  const Ball& b = part_b.ball_in_world;
  const double centres = (a.centre - b.centre).norm();
  const double radii = rounded_up(a.radius + b.radius);
  bounds.lower = std::max(bounds.lower, rounded_down(rounded_down(centres) - radii));
  bounds.upper = std::min(bounds.upper, rounded_up(rounded_up(centres) + radii));
  return bounds;
}

void carry(std::uint32_t pair, const std::vector<TrackedObject>& objects,
           const std::vector<PosedPart>& parts, std::uint64_t cycle, PairTable& table) noexcept {
  if (table.entries[pair].carried_cycle == cycle) return;
  const double travelled = travelled_since(pair, objects, table);
  note_carried(pair, objects, cycle, table);
  double least = kInfinity;
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
    const RowBounds now = bounds_now(row, travelled, parts, table);
    table.lower[row] = now.lower;
    table.upper[row] = now.upper;
    least = std::min(least, now.lower);
  }
  table.entries[pair].least_lower = least;
}

void note_carried(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                  std::uint64_t cycle, PairTable& table) noexcept {
  table.entries[pair].lower_before = lower_last_tick(pair, objects, cycle, table);
  table.entries[pair].carried_at = {objects[table.entries[pair].object_a].travelled,
                                    objects[table.entries[pair].object_b].travelled};
  table.entries[pair].carried_cycle = cycle;
}

void raise(std::uint32_t pair, double to, const std::vector<TrackedObject>& objects,
           PairTable& table) noexcept {
  const double travelled = travelled_since(pair, objects, table);
  double least = kInfinity;
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
    if (travelled > 0.0) {
      table.lower[row] = rounded_down(table.lower[row] - travelled);
      table.upper[row] = rounded_up(table.upper[row] + travelled);
    }
    table.lower[row] = std::max(table.lower[row], to);
    least = std::min(least, table.lower[row]);
  }
  table.entries[pair].least_lower = least;
  table.entries[pair].carried_at = {objects[table.entries[pair].object_a].travelled,
                                    objects[table.entries[pair].object_b].travelled};
}

void forget(std::uint32_t pair, PairTable& table) noexcept {
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
    table.lower[row] = -kInfinity;
    table.upper[row] = kInfinity;
  }
  table.entries[pair].least_lower = table.entries[pair].lower_before = -kInfinity;
}

}  // namespace clearance
