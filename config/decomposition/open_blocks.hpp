// Finds the open point in a convex hull that is farthest from the mesh. Points are kept in blocks,
// so that few of them are compared with the hull.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "config/decomposition/open_space.hpp"
#include "core/shapes.hpp"

namespace clearance {

class OpenBlocks {
 public:
  OpenBlocks() = default;
  // `spacing`: that of the grid of the points, m.
  OpenBlocks(std::vector<OpenPoint> points, double spacing);

  // Returns the largest distance from the mesh among points in the box that are in the hull, or
  // outside it by at most `near`, m. Returns 0 if there is none. `box`: that of the hull, widened
  // by `near`.
  [[nodiscard]] double farthest_in(std::span<const HalfSpace> hull, const Eigen::AlignedBox3d& box,
                                   double near) const;

 private:
  struct Block {
    Eigen::AlignedBox3d box;
    double farthest = 0.0;              // the largest distance of its points, m
    std::size_t first = 0, behind = 0;  // its points
  };
  std::vector<OpenPoint> points_;  // block by block, the farthest of each first
  std::vector<Block> blocks_;      // the farthest first
};

}  // namespace clearance
