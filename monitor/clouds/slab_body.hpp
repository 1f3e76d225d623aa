// The slab of a pixel as a body that the core's queries take.
#pragma once

#include <array>
#include <cstdint>

#include "core/convex_body.hpp"
#include "monitor/clouds/depth_cloud.hpp"

namespace clearance {

// A ConvexBody of six facets whose numbers are replaced for each slab, without allocation. The
// factories of core/shapes.hpp compute in exact arithmetic and take over a hundred times as long.
// Numbers are computed in double-double here and rounded once, as a ConvexBody promises. To be used
// by one thread at a time.
class SlabBody {
 public:
  SlabBody();

  // The body of this slab, in the frame of the slab. It is valid until the next call.
  [[nodiscard]] const ConvexBody& of(const DepthCloud::Slab& slab) noexcept;
  // A point at the origin, which queries place in the middle of a tile.
  [[nodiscard]] const ConvexBody& origin() const noexcept { return origin_; }

 private:
  // The ray (x, y, 1) of a corner, and its depth.
  struct Corner {
    double x, y, z;
  };
  [[nodiscard]] static Corner corner(unsigned bits, const DepthCloud::Slab& slab) noexcept;
  void set_edge(const DepthCloud::Slab& slab, Edge& edge) noexcept;
  void fill_tables() noexcept;

  ConvexBody origin_;
  ConvexBody body_;  // of a box: all slabs have its features
  // The side of a facet, and the corner of a vertex: bit k is set on the upper side of axis k.
  struct Side {
    int axis = 0;
    bool upper = false;
  };
  std::array<Side, 6> sides_{};
  std::array<unsigned, 8> corners_{};
};

}  // namespace clearance
