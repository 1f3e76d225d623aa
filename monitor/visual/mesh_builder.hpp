// Builds the meshes of bodies from rows and fans.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "monitor/visual/body_mesh.hpp"

namespace clearance {

class MeshBuilder {
 public:
  // `arc_step` is the largest step of an arc, rad.
  explicit MeshBuilder(double arc_step) : arc_step_(arc_step) {}

  // The number of steps of an arc of this angle, rad.
  [[nodiscard]] int arc_steps(double angle) const {
    return std::max(1, static_cast<int>(std::ceil(angle / arc_step_)));
  }
  std::uint32_t add(const Vec3& position, const Vec3& normal) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, b, c});
  }
  // Connects two rows with equally many points, the first to the right of the second.
  void strip(std::span<const std::uint32_t> from, std::span<const std::uint32_t> to) {
    for (std::size_t i = 0; i + 1 < from.size(); ++i) {
      triangle(from[i], from[i + 1], to[i + 1]);
      triangle(from[i], to[i + 1], to[i]);
    }
  }

  BodyMesh mesh;

 private:
  double arc_step_;
};

}  // namespace clearance
