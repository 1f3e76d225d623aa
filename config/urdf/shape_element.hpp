// Reads <collision> and <visual> of URDF, which have the same children.
#pragma once

#include "config/urdf/urdf.hpp"
#include "config/urdf/xml_reader.hpp"

namespace clearance {

// Reads one shape with its place in the link; the shape is unset after a fault.
[[nodiscard]] UrdfCollision read_shape(XmlReader& xml, const tinyxml2::XMLElement& element);

}  // namespace clearance
