#include "config/urdf/shape_element.hpp"

namespace clearance {

UrdfCollision read_shape(XmlReader& xml, const tinyxml2::XMLElement& element) {
  UrdfCollision collision;
  collision.link_from_shape = xml.origin(element);
  collision.line = element.GetLineNum();
  const tinyxml2::XMLElement* geometry = xml.child(element, "geometry");
  if (geometry == nullptr) return collision;
  if (const tinyxml2::XMLElement* mesh = geometry->FirstChildElement("mesh")) {
    UrdfMesh shape{.file = xml.attribute(*mesh, "filename"), .line = mesh->GetLineNum()};
    if (mesh->Attribute("scale") != nullptr) shape.scale = xml.vector(*mesh, "scale");
    collision.shape = shape;
  } else if (const tinyxml2::XMLElement* box = geometry->FirstChildElement("box")) {
    collision.shape = UrdfBox{xml.vector(*box, "size", Sign::kPositive)};
  } else if (const tinyxml2::XMLElement* cylinder = geometry->FirstChildElement("cylinder")) {
    const double radius = xml.length(*cylinder, "radius");
    collision.shape = UrdfCylinder{radius, xml.length(*cylinder, "length")};
  } else if (const tinyxml2::XMLElement* sphere = geometry->FirstChildElement("sphere")) {
    collision.shape = UrdfSphere{xml.length(*sphere, "radius")};
  } else if (const tinyxml2::XMLElement* capsule = geometry->FirstChildElement("capsule")) {
    const double radius = xml.length(*capsule, "radius");
    collision.shape = UrdfCapsule{radius, xml.length(*capsule, "length")};
  } else {
    xml.report(
        *geometry,
        "found a geometry of an unknown kind; expected mesh, box, cylinder, sphere or capsule");
  }
  return collision;
}

}  // namespace clearance
