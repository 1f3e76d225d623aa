// A piece of a mesh on the way to a convex part: what lies between some planes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/decomposition/open_space.hpp"
#include "core/shapes.hpp"

namespace clearance {

inline constexpr std::size_t kDirections = 160;

// Of neighbouring cells, a share of the tolerance: they leave no gap, not even a point, that would
// be surface of the union. A face along which a cut runs is thus in the cells on both sides.
inline constexpr double kOverlap = 0.01;

// In each of some directions the farthest of a set of points: a sketch of the set's hull, which
// sets that are joined share out.
class Outline {
 public:
  Outline();
  void add(const Vec3& point);
  void add(const Outline& other);
  [[nodiscard]] std::vector<Vec3> points() const;  // each once

 private:
  std::array<double, kDirections> reach_;
  std::array<Vec3, kDirections> farthest_;
};

// Convex: the piece of the mesh and of what it encloses between these planes.
struct Cell {
  std::vector<HalfSpace> planes;  // n.x <= d; those of the mesh's box first

  // Those of its corners, when widened by `margin`, that lie in the mesh: no triangle has them.
  [[nodiscard]] std::vector<Vec3> corners_within(const OpenSpace& space, double margin) const;
};

struct Piece {
  std::vector<Cell> cells;      // several: pieces that were joined
  std::vector<Vec3> points;     // of the mesh and of enclosed corners
  Outline outline;              // of the points
  std::vector<HalfSpace> hull;  // of the outline
  // What of the open space is in the hull, or so near to it that a thin hull holds some.
  std::vector<OpenPoint> open;
  double error = 0.0;  // about how far the hull's farthest point is from the mesh, m

  // Of points and of what is open in what it was a part of, in a grid of that spacing.
  void finish(std::span<const OpenPoint> open_before, double spacing);
};

// What of the triangle lies in the cell widened by `margin`: a convex polygon.
[[nodiscard]] std::vector<Vec3> clipped(const Triangle& triangle, const Cell& cell, double margin);

}  // namespace clearance
