// A piece of a mesh that is to become a convex part: the mesh between some planes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/decomposition/open_space.hpp"
#include "core/shapes.hpp"

namespace clearance {

inline constexpr std::size_t kDirections = 160;

// Each cut makes two cells that overlap by this share of the tolerance. Without the overlap,
// rounding could leave a gap between them. If a cut runs along a face of the mesh, both cells
// contain the face.
inline constexpr double kOverlap = 0.01;

// The support point of a set in each of some directions, which approximates the set's hull. The
// outline of a union follows from the outlines of its sets.
class Outline {
 public:
  Outline();
  void add(const Vec3& point);
  void add(const Outline& other);
  [[nodiscard]] std::vector<Vec3> points() const;  // each once

 private:
  std::array<double, kDirections> support_value_;
  std::array<Vec3, kDirections> support_point_;
};

// A convex cell: the piece of a mesh, and of the space that it encloses, between these planes.
struct ConvexCell {
  static constexpr std::size_t kBoxPlanes = 6;  // the first planes are those of the mesh's box

  const TriangleMesh* mesh = nullptr;
  std::vector<HalfSpace> planes;  // n.x <= d

  // The cell of all of a mesh.
  [[nodiscard]] static ConvexCell around(const TriangleMesh& mesh);

  // Keeps the side of the plane where n.x <= d.
  void cut_by(const HalfSpace& plane);

  // Tells whether no plane cuts the mesh.
  [[nodiscard]] bool is_whole() const { return planes.size() == kBoxPlanes; }

  // Returns those vertices of the cell, widened by `margin`, that lie in space which the mesh
  // encloses. They belong to no triangle. Vertices of the mesh's box are left out.
  [[nodiscard]] std::vector<Vec3> corners_within(const OpenSpace& space, double margin) const;
};

struct Piece {
  std::vector<ConvexCell> cells;  // several after joining
  std::vector<Vec3> points;       // of the mesh, and enclosed vertices of the cell
  Outline outline;                // of the points
  std::vector<HalfSpace> hull;    // of the outline
  // The open points in the hull. Points just outside are included, since a thin hull would contain
  // no grid point.
  std::vector<OpenPoint> open;
  double error = 0.0;    // estimate: the largest distance of the hull from the mesh, m
  int useless_cuts = 0;  // the last cuts of the piece that left its error nearly as it was

  // Completes the piece from its points and from the open points of the piece that it was cut from.
  // `spacing` is that of the grid.
  void finish(std::span<const OpenPoint> open_before, double spacing);
};

// Returns the part of the triangle in the cell widened by `margin`: a convex polygon.
[[nodiscard]] std::vector<Vec3> clipped(const Triangle& triangle, const ConvexCell& cell,
                                        double margin);

}  // namespace clearance
