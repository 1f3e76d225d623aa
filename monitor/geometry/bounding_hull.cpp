#include "monitor/geometry/bounding_hull.hpp"

#include <algorithm>

namespace clearance {
namespace {

bool same(const Part& left, const Part& right) {
  return left.shape.radius == right.shape.radius && left.shape.anchors == right.shape.anchors &&
         left.shape.curved == right.shape.curved &&
         left.shape.rays.size() == right.shape.rays.size() &&
         left.object_from_part.position == right.object_from_part.position &&
         left.object_from_part.orientation.coeffs() == right.object_from_part.orientation.coeffs();
}

bool same_parts(const Object& left, const Object& right) {
  return std::equal(left.parts.begin(), left.parts.end(), right.parts.begin(), right.parts.end(),
                    same);
}

bool would_be_simpler_as_hull(const Object& object) {
  return object.parts.size() > 1 ||
         (object.parts.size() == 1 && object.parts[0].shape.facets.size() > kFineFacets);
}

BoundingHull hull_of(const Object& object) {
  auto made = enclosing_polyhedron(shapes_of(object));
  return made ? std::make_shared<const ConvexBody>(std::move(*made)) : nullptr;
}

}  // namespace

std::vector<PlacedShape> shapes_of(const Object& object) {
  std::vector<PlacedShape> shapes;
  for (const Part& part : object.parts) shapes.push_back({&part.shape, part.object_from_part});
  return shapes;
}

std::vector<BoundingHull> bounding_hulls(const Scene& scene) {
  std::vector<BoundingHull> hulls;
  std::vector<std::size_t> originals;  // objects whose hull was made
  for (const Object& object : scene.objects) {
    BoundingHull hull;
    if (would_be_simpler_as_hull(object)) {
      const auto original = std::find_if(
          originals.begin(), originals.end(),
          [&](std::size_t earlier) { return same_parts(scene.objects[earlier], object); });
      if (original != originals.end()) {
        hull = hulls[*original];
      } else {
        originals.push_back(hulls.size());
        hull = hull_of(object);
      }
    }
    hulls.push_back(std::move(hull));
  }
  return hulls;
}

}  // namespace clearance
