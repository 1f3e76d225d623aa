// Where to begin when nothing is known: for every direction, a vertex that is nearly the farthest
// along it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/vec.hpp"

namespace clearance {

// A cube around the origin, each face a grid; a direction's cell names the vertex that is farthest
// along the cell's middle. 6 x 8 x 8 cells: on a facet-ball of 2,042 facets the walk from there is
// 3 edges long on average, and the table is no larger than the vertices of a body of 26 facets.
class StartTable {
 public:
  static constexpr int kGrid = 8;
  static constexpr int kCells = 6 * kGrid * kGrid;

  [[nodiscard]] std::int32_t at(const Vec3& direction) const noexcept {
    return cells_[static_cast<std::size_t>(cell(direction))];
  }
  void set(int cell, std::int32_t vertex) noexcept {
    cells_[static_cast<std::size_t>(cell)] = vertex;
  }

  // Any direction, zero and NaN included, has a cell.
  [[nodiscard]] static int cell(const Vec3& d) noexcept {
    const double x = std::abs(d.x()), y = std::abs(d.y()), z = std::abs(d.z());
    const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    const double major = d[axis], u = d[(axis + 1) % 3], v = d[(axis + 2) % 3];
    const double scale = 0.5 * kGrid / std::abs(major);
    return ((axis * 2 + (major < 0.0)) * kGrid + step(u * scale)) * kGrid + step(v * scale);
  }
  [[nodiscard]] static Vec3 middle(int cell) noexcept {
    const auto coordinate = [](int step) { return (step + 0.5) * 2.0 / kGrid - 1.0; };
    const int face = cell / (kGrid * kGrid), axis = face / 2;
    Vec3 d;
    d[axis] = face % 2 == 0 ? 1.0 : -1.0;
    d[(axis + 1) % 3] = coordinate(cell / kGrid % kGrid);
    d[(axis + 2) % 3] = coordinate(cell % kGrid);
    return d;
  }

 private:
  static int step(double from_middle) noexcept {
    const double s = from_middle + 0.5 * kGrid;
    return s > 0.0 ? (s < kGrid ? static_cast<int>(s) : kGrid - 1) : 0;
  }
  std::array<std::int32_t, kCells> cells_{};
};

}  // namespace clearance
