#include "tools/scene/fitting/enclosing_models.hpp"

#include <stdexcept>

#include "core/enclosing_polyhedron.hpp"
#include "tools/scene/fitting/fitted.hpp"

namespace clearance {
namespace {

constexpr std::size_t kFewestFacets = 8;
// A share of the body's size. Vertices outside a plane by less than this need no further plane.
constexpr double kLeftAlone = 1e-9;

}  // namespace

const char* name(ModelKind kind) noexcept {
  switch (kind) {
    case ModelKind::kSphere:
      return "sphere";
    case ModelKind::kCapsule:
      return "capsule";
    case ModelKind::kBox:
      return "box";
    case ModelKind::kRoundedBox:
      return "rounded box";
    case ModelKind::kCylinder:
      return "cylinder";
    case ModelKind::kEllipsoid:
      return "ellipsoid";
    case ModelKind::kPolyhedron:
      break;
  }
  return "polyhedron";
}

EnclosingModel enclosing_facets(const ConvexBody& body, std::size_t facets) {
  const PlacedShape placed[] = {{&body, Pose{}}};
  auto made = enclosing_polyhedron(placed, {.facets = facets, .tolerance = kLeftAlone});
  if (!made) throw std::logic_error("a body to be enclosed is bounded");
  return fitted(ModelKind::kPolyhedron, std::move(*made), Pose{}, body);
}

std::vector<EnclosingModel> enclosing_models(const ConvexBody& body) {
  std::vector<EnclosingModel> models;
  models.push_back(enclosing_sphere(body));
  models.push_back(enclosing_capsule(body));
  models.push_back(enclosing_box(body));
  models.push_back(enclosing_rounded_box(body));
  models.push_back(enclosing_cylinder(body));
  models.push_back(enclosing_ellipsoid(body));
  for (std::size_t facets = kFewestFacets; facets < body.facets.size(); facets *= 2) {
    models.push_back(enclosing_facets(body, facets));
  }
  return models;
}

}  // namespace clearance
