// The layout of a report's gradients: the joint positions that move one object of a published pair
// relative to the other. The scene determines it once for all ticks.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

// The gradient of one pair.
struct GradientRow {
  std::uint32_t published = 0;       // index into Report::pairs
  std::uint32_t first = 0, end = 0;  // its entries, the latter excluded
};

struct GradientRows {
  std::vector<GradientRow> rows;  // of the published pairs that joints move, in their order
  std::vector<std::uint32_t>
      variables;  // by entry, ascending in a row: index into Scene::variables
};

// A joint that moves one of a pair's objects and not the other. A joint that carries both objects
// changes no distance.
struct MovingJoint {
  std::uint32_t robot = 0, joint = 0;  // indices into Scene::robots and Robot::joints
  bool moves_b = false;                // the second object of the pair; else the first
};

// The joints of any pair, from the world outwards, those of the first object first.
[[nodiscard]] std::vector<MovingJoint> joints_between(const Scene& scene, const ObjectPair& pair);

// There are no rows unless Scene::gradients is set.
[[nodiscard]] GradientRows gradient_rows(const Scene& scene);

// Gradients of the size of these rows, all unknown.
[[nodiscard]] Gradients unknown_gradients(const GradientRows& rows);

}  // namespace clearance
