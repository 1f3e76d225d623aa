// Functions that all fits share: a body's vertices, its size, and the search for a direction.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/shapes.hpp"
#include "tools/scene/fitting/enclosing_models.hpp"

namespace clearance {

// Models are enlarged by this share of the body's size, a thousand times the rounding of placing
// their vertices.
inline constexpr double kFittingMargin = 1e-12;

// The greatest coordinate of any vertex, m.
[[nodiscard]] double size_of(const ConvexBody& body);

// The body's vertices in a frame at its origin.
[[nodiscard]] std::vector<Vec3> vertices_in(const ConvexBody& body,
                                            const Eigen::Quaterniond& body_from_frame);

// The rotation that takes z to `axis` (unit).
[[nodiscard]] Eigen::Quaterniond rotation_to(const Vec3& axis);

// The principal axes of the vertices as columns, the longest last.
[[nodiscard]] Mat3 principal_axes(const ConvexBody& body);

// The direction with the least cost that a pattern search finds from any of `starts`. The first
// step is a tenth of a turn; later steps are shorter.
[[nodiscard]] Vec3 best_direction(std::span<const Vec3> starts,
                                  const std::function<double(const Vec3&)>& cost);

// Makes the model and certifies its error.
[[nodiscard]] EnclosingModel fitted(ModelKind kind, ShapeResult shape, const Pose& frame_from_shape,
                                    const ConvexBody& body);

}  // namespace clearance
