// What is known about every pair: bounds for the poses in use, and the last evaluation.
//
// An object pair owns consecutive rows, one for every part of the first with every part of the
// second. Bounds are true at the end of carry() and stay so through every evaluation.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene.hpp"
#include "core/distance.hpp"
#include "monitor/placed_part.hpp"

namespace clearance {

// Where two parts were found to be closest, in the world. NaN until evaluated.
struct ClosestPoints {
  double distance;  // m
  Vec3 witness_a, witness_b;
  Vec3 normal;
  ClosestPoints() noexcept;
};

struct PairTable {
  // By object pair, as in Scene::pairs.
  std::vector<std::uint32_t> object_a, object_b;
  std::vector<std::uint32_t> first_row;        // pair p: rows first_row[p] .. first_row[p + 1]
  std::vector<double> least_lower;             // over its rows, m
  std::vector<std::uint64_t> evaluated_cycle;  // when all rows that matter last were; 0: never

  // By row.
  std::vector<std::uint32_t> part_a, part_b;       // indices into parts_of(scene)
  std::vector<double> lower, upper;                // true for the poses in use, m
  std::vector<std::uint64_t> row_evaluated_cycle;  // 0: never
  std::vector<DistanceStatus> status;
  std::vector<TrackingState> tracking;
  std::vector<ClosestPoints> closest;

  PairTable(const Scene& scene, const std::vector<PlacedPart>& parts);
  [[nodiscard]] std::uint32_t pairs() const noexcept {
    return static_cast<std::uint32_t>(object_a.size());
  }
  [[nodiscard]] std::uint32_t rows() const noexcept {
    return static_cast<std::uint32_t>(part_a.size());
  }
};

// Takes every bound from the last tick's poses to this tick's: looser by what the parts have moved,
// but never looser than their bounding balls tell. Pairs of objects never seen keep -infinity and
// +infinity.
void carry(const std::vector<ObjectState>& objects, const std::vector<PlacedPart>& parts,
           PairTable& table) noexcept;

}  // namespace clearance
