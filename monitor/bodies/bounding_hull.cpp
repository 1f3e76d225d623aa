#include "monitor/bodies/bounding_hull.hpp"

#include <algorithm>

namespace clearance {
namespace {

bool same(const Part& left, const Part& right) {
  return left.shape.radius == right.shape.radius && left.shape.anchors == right.shape.anchors &&
         left.shape.curved == right.shape.curved &&
         left.shape.rays.size() == right.shape.rays.size() &&
         same_pose(left.object_from_part, right.object_from_part);
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

std::vector<BoundingHull> bounding_hulls(const Scene& scene, const KnownHulls& known) {
  struct Made {
    const Object* object;
    BoundingHull hull;
  };
  std::vector<Made> made;
  for (std::size_t i = 0; i < known.objects.size(); ++i) {
    if (known.hulls[i] != nullptr) made.push_back({&known.objects[i], known.hulls[i]});
  }
  std::vector<BoundingHull> hulls;
  for (const Object& object : scene.objects) {
    if (!would_be_simpler_as_hull(object)) {
      hulls.push_back(nullptr);
      continue;
    }
    const auto same = std::ranges::find_if(
        made, [&](const Made& each) { return same_parts(*each.object, object); });
    if (same != made.end()) {
      hulls.push_back(same->hull);
    } else {
      hulls.push_back(made.emplace_back(&object, hull_of(object)).hull);
    }
  }
  return hulls;
}

}  // namespace clearance
