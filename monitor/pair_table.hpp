// What is known about every pair of parts: bounds for the poses in use, and the last evaluation.
//
// An object pair owns consecutive rows, one for every part of the first with every part of the
// second. The bounds of a row are true at the end of carry() and stay so through every evaluation.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene.hpp"
#include "core/distance.hpp"
#include "monitor/placed_part.hpp"

namespace clearance {

// A distance query's answer, in the world.
struct Evaluation {
  std::uint64_t cycle = 0;  // of the tick; 0: never
  DistanceStatus status = DistanceStatus::kIterationLimit;
  double distance;  // m; the figures are NaN until evaluated
  Vec3 witness_a, witness_b;
  Vec3 normal;
  Evaluation() noexcept;
};

struct PairTable {
  // Fixed at construction. Row r is part_a[r] with part_b[r], of object pair pair[r].
  std::vector<std::uint32_t> part_a, part_b;  // indices into parts_of(scene)
  std::vector<std::uint32_t> pair;            // index into Scene::pairs
  std::vector<std::uint32_t> first_row;  // object pair p: rows first_row[p] .. first_row[p + 1]

  // True for the poses in use, m.
  std::vector<double> lower, upper;
  std::vector<TrackingState> tracking;
  std::vector<Evaluation> evaluation;

  PairTable(const Scene& scene, const std::vector<PlacedPart>& parts);
  [[nodiscard]] std::size_t rows() const noexcept { return pair.size(); }
  [[nodiscard]] std::size_t pairs() const noexcept { return first_row.size() - 1; }
};

// Takes every bound from the last tick's poses to this tick's: looser by what the parts have moved,
// but never looser than their bounding balls tell. Rows of objects never seen keep -infinity and
// +infinity.
void carry(const std::vector<ObjectState>& objects, const std::vector<PlacedPart>& parts,
           PairTable& table) noexcept;

// One distance query: the row's bounds are then those of this tick's poses, placing errors
// included.
void evaluate(const std::vector<PlacedPart>& parts, std::uint32_t row, std::uint64_t cycle,
              PairTable& table) noexcept;

}  // namespace clearance
