// The bodies that are not polyhedra, each in a file of its own, and the one place that
// distinguishes their kinds. A new body adds a line here, a kind and its parameters in
// core/curved_shape.hpp, and a factory in core/construction.
#pragma once

#include "core/model/ellipsoid.hpp"
#include "core/model/truncated_cone.hpp"

namespace clearance {

// f(body) for the curved body that the shape is. `rim_azimuth`: see TruncatedCone.
template <class F>
decltype(auto) visit(const CurvedShape& shape, F&& f, const Vec2& rim_azimuth = {1.0, 0.0}) {
  if (shape.kind == CurvedShape::Kind::kEllipsoid) return f(Ellipsoid(shape));
  return f(TruncatedCone(shape, rim_azimuth));
}

}  // namespace clearance
