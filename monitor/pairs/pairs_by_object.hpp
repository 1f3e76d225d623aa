// The pairs of an object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/large_column.hpp"

namespace clearance {

class PairsByObject {
 public:
  explicit PairsByObject(const Scene& scene);

  // Indices into Scene::pairs, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> pairs_of(std::uint32_t object) const noexcept {
    return std::span(pairs_).subspan(first_[object], first_[object + 1] - first_[object]);
  }

 private:
  std::vector<std::uint32_t> first_;  // by object, and the end
  LargeColumn<std::uint32_t> pairs_;
};

}  // namespace clearance
