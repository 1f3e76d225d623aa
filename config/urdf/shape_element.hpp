// Reads <collision> and <visual> of URDF, which have the same children.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "config/urdf/xml_reader.hpp"

namespace clearance {

// Reads one shape of a link with its place in it. A shape without size in some direction becomes
// the point, line or thin plate that it is the limit of, and a note names it. Returns nothing for a
// geometry of another kind, which is then a word that is not read.
[[nodiscard]] std::optional<UrdfCollision> read_shape(XmlReader& xml,
                                                      const tinyxml2::XMLElement& element,
                                                      const std::string& link,
                                                      std::vector<std::string>& notes);

}  // namespace clearance
