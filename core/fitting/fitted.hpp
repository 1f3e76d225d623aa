// What all fits share: the body's vertices, its size, and how far beyond it a model reaches.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/enclosing_models.hpp"
#include "core/shapes.hpp"

namespace clearance {

// Models are larger by this, of the body's size: a thousand times what placing their vertices in
// doubles can be off.
inline constexpr double kFittingSlack = 1e-12;

// The greatest coordinate of any vertex, m.
[[nodiscard]] double size_of(const ConvexBody& body);

// The vertices as seen from a frame at the body's origin.
[[nodiscard]] std::vector<Vec3> vertices_in(const ConvexBody& body,
                                            const Eigen::Quaterniond& body_from_frame);

// The turn that leads z along `axis` (unit).
[[nodiscard]] Eigen::Quaterniond turn_to(const Vec3& axis);

// Of the vertices, as columns; the longest last.
[[nodiscard]] Mat3 principal_axes(const ConvexBody& body);

// The direction with the least cost that a search finds from each of `starts`: steps of a tenth of
// a turn, then ever smaller ones.
[[nodiscard]] Vec3 best_direction(std::span<const Vec3> starts,
                                  const std::function<double(const Vec3&)>& cost);

// Puts the model together; its error is certified here.
[[nodiscard]] EnclosingModel fitted(ModelKind kind, ShapeResult shape, const Pose& frame_from_shape,
                                    const ConvexBody& body);

// Signed distances of points from the body, from above, tracked.
class BeyondBody {
 public:
  explicit BeyondBody(const ConvexBody& body);
  // Not below the distance of `p` from the body, or less the depth within it, m.
  [[nodiscard]] double operator()(const Vec3& p);

 private:
  const ConvexBody& body_;
  ConvexBody point_;
  TrackingState state_;
};

}  // namespace clearance
