// A lower bound of two objects' distance by their reduced models. One query replaces those of every
// part of one object with every part of the other.
//
// Each query starts cold. It is made when a pair becomes active, and a tracking state would have to
// be fetched from memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/bodies/bounding_hull.hpp"
#include "monitor/pairs/budget.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

class HullBound {
 public:
  // `known`: hulls of a similar scene.
  HullBound(const Scene& scene, const std::vector<PosedPart>& parts, const KnownHulls& known = {});

  // By object.
  [[nodiscard]] std::span<const BoundingHull> hulls() const noexcept { return hulls_; }

  // Returns true when the models may save queries: one object has a hull, and the other has a hull
  // or only one part.
  [[nodiscard]] bool possible(const PairEntry& pair) const noexcept;

  // A lower bound of the pair's distance for the poses in use, m; -infinity where the models
  // overlap, because no decision needs their depth. Takes one query of the budget. Requires
  // possible(), and that both objects are known.
  [[nodiscard]] double lower(std::uint32_t pair, const TickView& view, Budget& budget) noexcept;

 private:
  static constexpr std::uint32_t kNoModel = ~0u;
  [[nodiscard]] const PosedPart& model(std::uint32_t object, const TickView& view) noexcept;

  std::vector<BoundingHull> hulls_;  // by object; null: no hull, but perhaps a single part
  std::vector<PosedPart> placed_;    // by object: its hull, placed when it is queried
  // By object: the index of its part if it has only one, and kNoModel if it has several. A single
  // part is the model of an object without a hull.
  std::vector<std::uint32_t> only_part_;
};

}  // namespace clearance
