#include "config/urdf/shape_element.hpp"

#include <fmt/format.h>

#include "config/decomposition/part_limits.hpp"

namespace clearance {
namespace {

using Element = tinyxml2::XMLElement;
using Shape = decltype(UrdfCollision::shape);

constexpr double kPlate = PartLimits{}.plate;  // m, as of a flat mesh

// A disc becomes a plate, and a cylinder without radius the line in it.
Shape round_shape(double radius, double length, bool is_capsule) {
  if (length == 0.0 && (is_capsule || radius == 0.0)) return UrdfSphere{radius};
  if (length == 0.0) return UrdfCylinder{radius, kPlate};
  if (is_capsule || radius == 0.0) return UrdfCapsule{radius, length};
  return UrdfCylinder{radius, length};
}

Shape box_shape(const Vec3& size) {
  if (size.isZero(0.0)) return UrdfSphere{0.0};
  return UrdfBox{(size.array() == 0.0).select(kPlate, size)};
}

// Returns nothing for a kind that is not known.
std::optional<Shape> shape_of(XmlReader& xml, const Element& geometry, bool& is_flat) {
  if (const Element* mesh = xml.optional_child(geometry, "mesh")) {
    UrdfMesh shape{.file = xml.attribute(*mesh, "filename"), .place = xml.place_of(*mesh)};
    if (xml.optional(*mesh, "scale") != nullptr) shape.scale = xml.vector(*mesh, "scale");
    return shape;
  }
  if (const Element* box = xml.optional_child(geometry, "box")) {
    const Vec3 size = xml.vector(*box, "size", Sign::kNotNegative);
    is_flat = size.minCoeff() == 0.0;
    return box_shape(size);
  }
  if (const Element* sphere = xml.optional_child(geometry, "sphere")) {
    const double radius = xml.length(*sphere, "radius");
    is_flat = radius == 0.0;
    return UrdfSphere{radius};
  }
  for (const char* kind : {"cylinder", "capsule"}) {
    const Element* found = xml.optional_child(geometry, kind);
    if (found == nullptr) continue;
    const double radius = xml.length(*found, "radius");
    const double length = xml.length(*found, "length");
    is_flat = radius == 0.0 || length == 0.0;
    return round_shape(radius, length, std::string_view(kind) == "capsule");
  }
  return std::nullopt;
}

}  // namespace

std::optional<UrdfCollision> read_shape(XmlReader& xml, const Element& element,
                                        const std::string& link, std::vector<std::string>& notes) {
  const UrdfOrigin origin = xml.origin(element);
  const Element* geometry = xml.child(element, "geometry");
  if (geometry == nullptr) return std::nullopt;
  const std::size_t before = xml.faults().size();
  bool is_flat = false;
  std::optional<Shape> shape = shape_of(xml, *geometry, is_flat);
  if (!shape) {
    if (geometry->NoChildren()) xml.report(*geometry, "found <geometry> without a shape in it");
    return std::nullopt;
  }
  const UrdfPlace place = xml.place_of(element);
  if (is_flat && xml.faults().size() == before) {
    const bool is_point =
        std::holds_alternative<UrdfSphere>(*shape) && std::get<UrdfSphere>(*shape).radius == 0.0;
    notes.push_back(
        fmt::format("the shape of the link '{}' in line {} has no size{}", link, place.line,
                    is_point ? ": it is a point"
                             : " in some direction: it is a line, a sphere or a 1 mm plate"));
  }
  return UrdfCollision{std::move(*shape), origin, place};
}

}  // namespace clearance
