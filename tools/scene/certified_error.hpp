// A certified bound on the error of a model that encloses bodies.
#pragma once

#include <span>

#include "core/enclosing_polyhedron.hpp"

namespace clearance {

// No point of `model` is farther from the nearest of `bodies` than this, m. Therefore no distance
// from the model is smaller by more than this than the distance from the bodies. For one body the
// result exceeds the least such bound only by rounding. For several bodies and a solid polyhedron
// the result is within 2 %, unless that takes too many splits. `model`: bounded and without curves
// but for its radius; `bodies`: at least one.
[[nodiscard]] double certified_error(const ConvexBody& model, const Pose& frame_from_model,
                                     std::span<const PlacedShape> bodies);

}  // namespace clearance
