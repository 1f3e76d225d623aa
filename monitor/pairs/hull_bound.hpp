// How far apart are two objects at least, by their reduced models? One query instead of one for
// every part of the one with every part of the other.
//
// Starts cold each time: it is queried when a pair becomes active, and what it would remember of
// the last time would have to be fetched from memory.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/geometry/bounding_hull.hpp"
#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {

class HullBound {
 public:
  HullBound(const Scene& scene, const std::vector<PosedPart>& parts);

  // Whether that may save anything: one of the objects has a hull at least, and the other one a
  // hull or only one part.
  [[nodiscard]] bool possible(const PairEntry& pair) const noexcept;

  // A lower bound of the pair's distance for the poses in use, m; -infinity where the models
  // overlap: how deep decides nothing. Takes one query of the budget. possible(), and both objects
  // are known.
  [[nodiscard]] double lower(std::uint32_t pair, Evaluation& evaluation) noexcept;

 private:
  static constexpr std::uint32_t kNoModel = ~0u;
  [[nodiscard]] const PosedPart& model(std::uint32_t object, const Evaluation& evaluation) noexcept;

  std::vector<BoundingHull> hulls_;       // by object; null: the only part, if any
  std::vector<PosedPart> placed_;         // by object: its hull, placed when it is queried
  std::vector<std::uint32_t> only_part_;  // by object without a hull; kNoModel: several parts
};

}  // namespace clearance
