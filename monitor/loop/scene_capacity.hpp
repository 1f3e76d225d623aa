// The room that a running loop and its readers have for scenes that follow the first one.
#pragma once

#include <cstddef>

#include "config/scene/scene.hpp"

namespace clearance {

struct SceneCapacity {
  std::size_t objects = 0, variables = 0;
};

// Enough for the scene, and for 64 more objects and joint variables.
[[nodiscard]] inline SceneCapacity capacity_for(const Scene& scene) noexcept {
  constexpr std::size_t kSpare = 64;
  return {scene.objects.size() + kSpare, scene.variables.size() + kSpare};
}

}  // namespace clearance
