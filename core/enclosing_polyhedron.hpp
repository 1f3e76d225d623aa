// A coarser model of a body or of several: one convex polyhedron of few facets that holds them all.
//
// It keeps a few of the planes that bound the hull of the bodies. Each plane is moved out to the
// largest support value of the bodies, rounding included. So the half-spaces contain every point of
// the bodies, whichever planes are chosen. The choice is greedy: every round takes the planes that
// cut off the vertices which stick out most. This is an outer sandwich algorithm: G. Rote, "The
// convergence rate of the sandwich algorithm", 1992. Load time only: allocates, may take
// milliseconds.
#pragma once

#include <optional>
#include <span>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

// A body in a frame that it shares with others.
struct PlacedShape {
  const ConvexBody* shape = nullptr;
  Pose frame_from_shape;
};
static_assert(sizeof(PlacedShape) == 128 && alignof(PlacedShape) == 64);

struct EnclosingOptions {
  std::size_t facets = 32;  // at most; at least 6
  double tolerance = 1e-3;  // of the bodies' size: vertices that stick out by less are left alone
};

// Nothing when there are no bodies, or one is unbounded. Deterministic.
[[nodiscard]] std::optional<ConvexBody> enclosing_polyhedron(std::span<const PlacedShape> bodies,
                                                             const EnclosingOptions& options = {});

}  // namespace clearance
