// The memory that a running loop and its readers have for scenes that follow the first one.
#pragma once

#include <cstddef>

#include "config/cell/cell.hpp"

namespace clearance {

struct SceneCapacity {
  std::size_t objects = 0, variables = 0, parts = 0, pairs = 0;
};

[[nodiscard]] inline std::size_t parts_in(const Scene& scene) noexcept {
  std::size_t parts = 0;
  for (const Object& object : scene.objects) parts += object.parts.size();
  return parts;
}

// Enough for the cell, and for what it states under `capacity`.
[[nodiscard]] inline SceneCapacity capacity_for(const Cell& cell) noexcept {
  const Scene& scene = cell.scene;
  return {.objects = scene.objects.size() + cell.capacity.objects,
          .variables = scene.variables.size() + cell.capacity.objects,
          .parts = parts_in(scene) + cell.capacity.parts,
          .pairs = scene.pairs.size() + cell.capacity.pairs};
}

}  // namespace clearance
