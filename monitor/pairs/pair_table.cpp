#include "monitor/pairs/pair_table.hpp"

namespace clearance {

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
  refreshed_cycle.assign(pairs(), 0);
  lower.assign(part_pairs(), -kInfinity);
  upper.assign(part_pairs(), kInfinity);
  part_pair_evaluated_cycle.assign(part_pairs(), 0);
  status.assign(part_pairs(), DistanceStatus::kIterationLimit);
  tracking.resize(part_pairs());
  closest.resize(part_pairs());
  gap.assign(part_pairs(), -kInfinity);
}

void add_pair(std::uint32_t pair, const PairTable& table, Checksum& sum) noexcept {
  const PairEntry& entry = table.entries[pair];
  sum.add(entry.carried_at.a);
  sum.add(entry.carried_at.b);
  sum.add(entry.carried_cycle);
  sum.add(entry.least_lower);
  sum.add(entry.lower_before);
  sum.add(entry.evaluated_cycle);
  sum.add(table.lower_between[pair]);
  sum.add(table.refreshed_cycle[pair]);
  for (std::uint32_t i = entry.first_part_pair; i < entry.end_part_pair; ++i) {
    sum.add(table.lower[i]);
    sum.add(table.upper[i]);
    sum.add(table.part_pair_evaluated_cycle[i]);
    sum.add(table.status[i]);
    sum.add(table.gap[i]);
    sum.add(table.closest[i].distance);
    sum.add(table.closest[i].lower);
    sum.add3(table.closest[i].witness_a);
    sum.add3(table.closest[i].witness_b);
    sum.add3(table.closest[i].normal);
  }
}

void forget_bounds(std::uint32_t pair, PairTable& table) noexcept {
  for (std::uint32_t part_pair = table.entries[pair].first_part_pair;
       part_pair < table.entries[pair].end_part_pair; ++part_pair) {
    table.lower[part_pair] = -kInfinity;
    table.upper[part_pair] = kInfinity;
  }
  table.entries[pair].least_lower = table.entries[pair].lower_before = -kInfinity;
}

// Tracking states are kept. They are only hints, so stale ones do no harm.
void forget_pair(std::uint32_t pair, PairTable& table) noexcept {
  forget_bounds(pair, table);
  PairEntry& entry = table.entries[pair];
  for (std::uint32_t part_pair = entry.first_part_pair; part_pair < entry.end_part_pair;
       ++part_pair) {
    table.part_pair_evaluated_cycle[part_pair] = 0;
    table.closest[part_pair] = ClosestPoints();
    table.gap[part_pair] = -kInfinity;
  }
  entry.carried_cycle = entry.evaluated_cycle = 0;
  table.lower_between[pair] = -kInfinity;
}

}  // namespace clearance
