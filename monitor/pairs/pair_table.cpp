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
  std::size_t all_part_pairs = 0;
  for (const ObjectPair& pair : scene.pairs) {
    all_part_pairs += parts_by_object[pair.first].size() * parts_by_object[pair.second].size();
  }
  entries.reserve(scene.pairs.size());
  for (auto* column : {&part_a, &part_b}) column->reserve(all_part_pairs);
  for (const ObjectPair& pair : scene.pairs) {
    PairEntry& entry = entries.emplace_back();
    entry.object_a = pair.first;
    entry.object_b = pair.second;
    entry.first_part_pair = part_pairs();
    for (const std::uint32_t a : parts_by_object[pair.first]) {
      for (const std::uint32_t b : parts_by_object[pair.second]) {
        part_a.push_back(a);
        part_b.push_back(b);
      }
    }
    entry.end_part_pair = part_pairs();
  }
  lower_between.assign(pairs(), -kInfinity);
  lower.assign(part_pairs(), -kInfinity);
  upper.assign(part_pairs(), kInfinity);
  part_pair_evaluated_cycle.assign(part_pairs(), 0);
  status.assign(part_pairs(), DistanceStatus::kIterationLimit);
  tracking.resize(part_pairs());
  closest.resize(part_pairs());
  gap.assign(part_pairs(), -kInfinity);
}

double displacement_since(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                          const PairTable& table) noexcept {
  const AccumulatedDisplacement& then = table.entries[pair].carried_at;
  const double sum = between(then.a, objects[table.entries[pair].object_a].accumulated) +
                     between(then.b, objects[table.entries[pair].object_b].accumulated);
  return rounded_up(sum);
}

bool raised_this_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                      const PairTable& table) noexcept {
  const PairEntry& entry = table.entries[pair];
  return entry.carried_at.a > objects[entry.object_a].accumulated_last_tick ||
         entry.carried_at.b > objects[entry.object_b].accumulated_last_tick;
}

double lower_last_tick(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                       std::uint64_t cycle, const PairTable& table) noexcept {
  if (table.entries[pair].carried_cycle == cycle) return table.entries[pair].lower_before;
  const AccumulatedDisplacement& then = table.entries[pair].carried_at;
  const double before_a = objects[table.entries[pair].object_a].accumulated_last_tick;
  const double before_b = objects[table.entries[pair].object_b].accumulated_last_tick;
  const double lower = table.entries[pair].least_lower;
  if (then.a == before_a && then.b == before_b) return lower;
  if (raised_this_tick(pair, objects, table)) return -kInfinity;
  const double displacement = between(then.a, before_a) + between(then.b, before_b);
  return displacement > 0.0 ? rounded_down(lower - rounded_up(displacement)) : lower;
}

DistanceBounds bounds_now(std::uint32_t part_pair, double displacement,
                          const std::vector<PosedPart>& parts, const PairTable& table) noexcept {
  DistanceBounds bounds{table.lower[part_pair], table.upper[part_pair]};
  if (displacement > 0.0) {
    bounds.lower = rounded_down(bounds.lower - displacement);
    bounds.upper = rounded_up(bounds.upper + displacement);
  }
  const PosedPart& part_a = parts[table.part_a[part_pair]];
  const PosedPart& part_b = parts[table.part_b[part_pair]];
  if (displacement > 0.0 && table.gap[part_pair] > -kInfinity) {
    const Vec3& normal = table.closest[part_pair].normal;
    bounds.lower =
        std::max(bounds.lower, lower_along(normal, table.gap[part_pair], part_a, part_b));
  }
  const Sphere& a = part_a.sphere_in_world;
  const Sphere& b = part_b.sphere_in_world;
  const double centres = (a.centre - b.centre).norm();
  const double radii = rounded_up(a.radius + b.radius);
  bounds.lower = std::max(bounds.lower, rounded_down(rounded_down(centres) - radii));
  bounds.upper = std::min(bounds.upper, rounded_up(rounded_up(centres) + radii));
  return bounds;
}

void carry(std::uint32_t pair, const std::vector<TrackedObject>& objects,
           const std::vector<PosedPart>& parts, std::uint64_t cycle, PairTable& table) noexcept {
  if (table.entries[pair].carried_cycle == cycle) return;
  const double displacement = displacement_since(pair, objects, table);
  note_carried(pair, objects, cycle, table);
  double least = kInfinity;
  for (std::uint32_t part_pair = table.entries[pair].first_part_pair;
       part_pair < table.entries[pair].end_part_pair; ++part_pair) {
    const DistanceBounds now = bounds_now(part_pair, displacement, parts, table);
    table.lower[part_pair] = now.lower;
    table.upper[part_pair] = now.upper;
    least = std::min(least, now.lower);
  }
  table.entries[pair].least_lower = least;
}

void note_carried(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                  std::uint64_t cycle, PairTable& table) noexcept {
  table.entries[pair].lower_before = lower_last_tick(pair, objects, cycle, table);
  table.entries[pair].carried_at = {objects[table.entries[pair].object_a].accumulated,
                                    objects[table.entries[pair].object_b].accumulated};
  table.entries[pair].carried_cycle = cycle;
}

void raise(std::uint32_t pair, double to, const std::vector<TrackedObject>& objects,
           PairTable& table) noexcept {
  const double displacement = displacement_since(pair, objects, table);
  double least = kInfinity;
  for (std::uint32_t part_pair = table.entries[pair].first_part_pair;
       part_pair < table.entries[pair].end_part_pair; ++part_pair) {
    if (displacement > 0.0) {
      table.lower[part_pair] = rounded_down(table.lower[part_pair] - displacement);
      table.upper[part_pair] = rounded_up(table.upper[part_pair] + displacement);
    }
    table.lower[part_pair] = std::max(table.lower[part_pair], to);
    least = std::min(least, table.lower[part_pair]);
  }
  table.entries[pair].least_lower = least;
  table.entries[pair].carried_at = {objects[table.entries[pair].object_a].accumulated,
                                    objects[table.entries[pair].object_b].accumulated};
}

void forget(std::uint32_t pair, PairTable& table) noexcept {
  for (std::uint32_t part_pair = table.entries[pair].first_part_pair;
       part_pair < table.entries[pair].end_part_pair; ++part_pair) {
    table.lower[part_pair] = -kInfinity;
    table.upper[part_pair] = kInfinity;
  }
  table.entries[pair].least_lower = table.entries[pair].lower_before = -kInfinity;
}

}  // namespace clearance
