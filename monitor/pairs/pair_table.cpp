#include "monitor/pairs/pair_table.hpp"

#include <algorithm>

#include "config/scene/refresh_share.hpp"

namespace clearance {

namespace {

std::size_t count_part_pairs(const Scene& scene) {
  std::size_t count = 0;
  for (const ObjectPair& pair : scene.pairs)
    count += scene.objects[pair.first].parts.size() * scene.objects[pair.second].parts.size();
  return count;
}

}  // namespace

PairTable::PairTable(const Scene& scene, const std::vector<PosedPart>& parts)
    : lower(count_part_pairs(scene), -kInfinity),
      upper(lower.size(), kInfinity),
      evaluations(lower.size(), scene.budget) {
  entries.reserve(scene.pairs.size());
  for (const ObjectPair& pair : scene.pairs) {
    PairEntry& entry = entries.emplace_back();
    entry.object_a = pair.first;
    entry.object_b = pair.second;
  }
  all_single_ = std::ranges::all_of(scene.objects,
                                    [](const Object& object) { return object.parts.size() == 1; });
  if (!all_single_) number_part_pairs(scene, parts);
  for (std::uint32_t pair = 0; pair < pairs(); ++pair) {
    if (!is_published(scene.pairs[pair], scene)) continue;
    for (std::uint32_t i = first_part_pair(pair); i < end_part_pair(pair); ++i) evaluations.keep(i);
  }
  evaluations.share();
  state_errors(scene);
}

void PairTable::state_errors(const Scene& scene) {
  const StatedErrors stated(scene);
  if (!stated.any()) return;
  errors.reserve(lower.size());
  for (const ObjectPair& pair : scene.pairs) {
    const ErrorsBetween between = stated.between(pair.first, pair.second);
    most_error_ = std::max(most_error_, between.largest);
    const std::size_t parts =
        scene.objects[pair.first].parts.size() * scene.objects[pair.second].parts.size();
    for (std::size_t i = 0; i < parts; ++i)
      errors.push_back({.between = between, .loss = between.largest});
  }
}

void PairTable::number_part_pairs(const Scene& scene, const std::vector<PosedPart>& parts) {
  std::vector<std::vector<std::uint32_t>> parts_by_object(scene.objects.size());
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    parts_by_object[parts[part].object].push_back(part);
  }
  first_part_pair_.reserve(scene.pairs.size() + 1);
  for (auto* column : {&part_a_, &part_b_}) column->reserve(lower.size());
  for (const ObjectPair& pair : scene.pairs) {
    first_part_pair_.push_back(static_cast<std::uint32_t>(part_a_.size()));
    for (const std::uint32_t a : parts_by_object[pair.first]) {
      for (const std::uint32_t b : parts_by_object[pair.second]) {
        part_a_.push_back(a);
        part_b_.push_back(b);
      }
    }
  }
  first_part_pair_.push_back(static_cast<std::uint32_t>(part_a_.size()));
}

void add_pair(std::uint32_t pair, const PairTable& table, Checksum& sum) noexcept {
  const PairEntry& entry = table.entries[pair];
  sum.add(entry.object_a);
  sum.add(entry.object_b);
  sum.add(entry.carried_at.a);
  sum.add(entry.carried_at.b);
  sum.add(entry.carried_cycle);
  sum.add(entry.least_lower);
  sum.add(entry.lower_before);
  sum.add(entry.evaluated_cycle);
  sum.add(entry.refreshed_cycle);
  for (std::uint32_t i = table.first_part_pair(pair); i < table.end_part_pair(pair); ++i) {
    const Evaluation& evaluation = table.evaluations[i];
    sum.add(table.lower[i]);
    sum.add(table.upper[i]);
    sum.add(evaluation.lower_between);
    sum.add(table.evaluations.cycle(i));
    sum.add(evaluation.status);
    sum.add(evaluation.gap);
    sum.add(evaluation.closest.distance);
    sum.add(evaluation.closest.lower);
    sum.add3(evaluation.closest.witness_a);
    sum.add3(evaluation.closest.witness_b);
    sum.add3(evaluation.closest.normal);
  }
}

void forget_bounds(std::uint32_t pair, PairTable& table) noexcept {
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < table.end_part_pair(pair);
       ++part_pair) {
    table.lower[part_pair] = -kInfinity;
    table.upper[part_pair] = kInfinity;
  }
  table.entries[pair].least_lower = table.entries[pair].lower_before = -kInfinity;
}

// Tracking states are kept. They are only hints, so stale ones do no harm.
void forget_pair(std::uint32_t pair, PairTable& table) noexcept {
  forget_bounds(pair, table);
  PairEntry& entry = table.entries[pair];
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < table.end_part_pair(pair);
       ++part_pair) {
    Evaluation* const evaluation = table.evaluations.find(part_pair);
    if (evaluation == nullptr) continue;
    table.evaluations.set_cycle(part_pair, 0);
    evaluation->closest = ClosestPoints();
    evaluation->gap = evaluation->lower_between = -kInfinity;
  }
  entry.carried_cycle = entry.evaluated_cycle = 0;
}

}  // namespace clearance
