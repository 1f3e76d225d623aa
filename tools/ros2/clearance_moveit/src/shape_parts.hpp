// The convex bodies that stand for a shape of MoveIt in distance queries.
#pragma once

#include "posed_part.hpp"

#include <memory>

#include <geometric_shapes/shapes.h>

namespace clearance_moveit {

// Returns the parts of a shape with MoveIt's own scale and padding (Shape::scaleAndPadd). To
// split a mesh may take seconds: the process keeps the parts of its last meshes by their content.
[[nodiscard]] std::shared_ptr<const ShapeParts> parts_of(const shapes::ShapeConstPtr& shape,
                                                         double scale = 1.0, double padding = 0.0);

}  // namespace clearance_moveit
