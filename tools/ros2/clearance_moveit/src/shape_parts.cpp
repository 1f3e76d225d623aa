#include "shape_parts.hpp"

#include <algorithm>
#include <array>
#include <config/decomposition/convex_parts.hpp>
#include <core/shapes.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <span>
#include <utility>
#include <variant>

#include <octomap/octomap.h>

namespace clearance_moveit {
namespace {

// What has no size in some direction gets this one, m.
double extent(double length) { return std::max(length, 4.0 * clearance::kLeastExtent); }

Box box_around(const clearance::ConvexBody& body) {
  if (!body.bounded()) return {};
  Box box{Vec3::Constant(clearance::kInfinity), Vec3::Constant(-clearance::kInfinity)};
  const auto include = [&](const Vec3& low, const Vec3& high) {
    box.low = box.low.cwiseMin(low);
    box.high = box.high.cwiseMax(high);
  };
  if (body.is_curved()) {
    for (const clearance::Disc& disc : body.curved.discs) {
      include({-disc.radius, -disc.radius, disc.height}, {disc.radius, disc.radius, disc.height});
    }
  }
  for (const Vec3& anchor : body.anchors) include(anchor, anchor);
  const double more = body.radius + 2.0 * body.position_error;
  return {box.low.array() - more, box.high.array() + more};
}

void add(clearance::ShapeResult made, ShapeParts& parts) {
  if (auto* error = std::get_if<clearance::ShapeError>(&made)) {
    parts.fault = error->reason;
    return;
  }
  parts.bodies.push_back(std::get<clearance::ConvexBody>(std::move(made)));
}

void add_mesh(const shapes::Mesh& mesh, ShapeParts& parts) {
  clearance::TriangleMesh triangles;
  for (std::size_t i = 0; i < mesh.vertex_count; ++i)
    triangles.vertices.emplace_back(mesh.vertices + 3 * i);
  for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
    const unsigned int* t = mesh.triangles + 3 * i;
    triangles.triangles.push_back({t[0], t[1], t[2]});
  }
  if (triangles.triangles.empty()) {
    parts.fault = "the mesh has no triangle";
    return;
  }
  const auto split = clearance::convex_parts(triangles);
  if (const auto* error = std::get_if<clearance::ShapeError>(&split)) {
    parts.fault = error->reason;
    return;
  }
  const auto& convex = std::get<clearance::ConvexParts>(split);
  parts.mesh_error = convex.error;
  for (const auto& vertices : convex.parts)
    add(clearance::polyhedron_from_vertices(vertices), parts);
}

// A plane is solid on the side that its normal points away from, as in the cells of Clearance.
void add_plane(const shapes::Plane& plane, ShapeParts& parts) {
  const std::array<clearance::HalfSpace, 1> solid = {{{{plane.a, plane.b, plane.c}, -plane.d}}};
  add(clearance::polyhedron_from_halfspaces(solid), parts);
}

// Trees of one resolution have the same cubes, and to make them takes about 2 ms.
void add_octree(const shapes::OcTree& shape, ShapeParts& parts) {
  static std::mutex mutex;
  static std::map<double, ShapeParts> cubes;
  const std::lock_guard lock(mutex);
  const auto [of, is_new] = cubes.try_emplace(shape.octree->getResolution());
  for (unsigned depth = 0; is_new && depth <= shape.octree->getTreeDepth(); ++depth)
    add(clearance::box(Vec3::Constant(0.5 * shape.octree->getNodeSize(depth))), of->second);
  parts = of->second;
  parts.octree = shape.octree;
}

ShapeParts make_parts(const shapes::Shape& shape) {
  ShapeParts parts;
  switch (shape.type) {
    case shapes::SPHERE:
      add(clearance::point(Vec3::Zero(), static_cast<const shapes::Sphere&>(shape).radius), parts);
      break;
    case shapes::BOX: {
      const double* size = static_cast<const shapes::Box&>(shape).size;
      add(clearance::box(0.5 * Vec3(extent(size[0]), extent(size[1]), extent(size[2]))), parts);
      break;
    }
    case shapes::CYLINDER: {
      const auto& cylinder = static_cast<const shapes::Cylinder&>(shape);
      add(clearance::cylinder(extent(cylinder.radius), 0.5 * extent(cylinder.length)), parts);
      break;
    }
    case shapes::CONE: {
      const auto& cone = static_cast<const shapes::Cone&>(shape);
      add(clearance::cone(extent(cone.radius), 0.5 * extent(cone.length)), parts);
      break;
    }
    case shapes::MESH:
      add_mesh(static_cast<const shapes::Mesh&>(shape), parts);
      break;
    case shapes::PLANE:
      add_plane(static_cast<const shapes::Plane&>(shape), parts);
      break;
    case shapes::OCTREE:
      add_octree(static_cast<const shapes::OcTree&>(shape), parts);
      break;
    default:
      parts.fault = "a shape of this type has no convex parts";
  }
  for (const clearance::ConvexBody& body : parts.bodies) parts.boxes.push_back(box_around(body));
  return parts;
}

struct Key {
  std::weak_ptr<const shapes::Shape> shape;
  double scale, padding;

  bool operator<(const Key& other) const {
    if (shape.owner_before(other.shape)) return true;
    if (other.shape.owner_before(shape)) return false;
    return std::pair(scale, padding) < std::pair(other.scale, other.padding);
  }
};

// Every environment of the process shares it: scenes are copied often, and shapes rarely change.
class PartsCache {
 public:
  std::shared_ptr<const ShapeParts> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = parts_.find(key);
    return found == parts_.end() ? nullptr : found->second;
  }
  void keep(const Key& key, const std::shared_ptr<const ShapeParts>& parts) {
    const std::lock_guard lock(mutex_);
    if (parts_.size() >= 2 * left_) {
      std::erase_if(parts_, [](const auto& entry) { return entry.first.shape.expired(); });
      left_ = std::max<std::size_t>(64, parts_.size());
    }
    parts_[key] = parts;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const ShapeParts>> parts_;
  std::size_t left_ = 64;  // after the last removal of shapes that are gone
};

// The last meshes of the process by their content. A message about an object that was there before
// brings a new shape with the same mesh, and to split it again may take seconds.
class SplitMeshes {
 public:
  std::shared_ptr<const ShapeParts> find(const shapes::Mesh& mesh) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(last_, [&](const Entry& entry) {
      return std::ranges::equal(entry.vertices, vertices(mesh)) &&
             std::ranges::equal(entry.corners, corners(mesh));
    });
    return found == last_.end() ? nullptr : found->parts;
  }
  void keep(const shapes::Mesh& mesh, const std::shared_ptr<const ShapeParts>& parts) {
    const auto points = vertices(mesh);
    const auto triangles = corners(mesh);
    const std::lock_guard lock(mutex_);
    last_.push_front({{points.begin(), points.end()}, {triangles.begin(), triangles.end()}, parts});
    if (last_.size() > kMost) last_.pop_back();
  }

 private:
  static constexpr std::size_t kMost = 256;
  struct Entry {
    std::vector<double> vertices;
    std::vector<unsigned int> corners;
    std::shared_ptr<const ShapeParts> parts;
  };
  static std::span<const double> vertices(const shapes::Mesh& mesh) {
    return {mesh.vertices, 3 * std::size_t{mesh.vertex_count}};
  }
  static std::span<const unsigned int> corners(const shapes::Mesh& mesh) {
    return {mesh.triangles, 3 * std::size_t{mesh.triangle_count}};
  }

  std::mutex mutex_;
  std::deque<Entry> last_;
};

std::shared_ptr<const ShapeParts> shared_parts(const shapes::Shape& shape) {
  static SplitMeshes meshes;
  if (shape.type != shapes::MESH) return std::make_shared<const ShapeParts>(make_parts(shape));
  const auto& mesh = static_cast<const shapes::Mesh&>(shape);
  if (auto found = meshes.find(mesh)) return found;
  const auto made = std::make_shared<const ShapeParts>(make_parts(shape));
  meshes.keep(mesh, made);
  return made;
}

}  // namespace

std::shared_ptr<const ShapeParts> parts_of(const shapes::ShapeConstPtr& shape, double scale,
                                           double padding) {
  static PartsCache cache;
  // The cache would keep the tree of a shape that is gone.
  if (shape->type == shapes::OCTREE) return shared_parts(*shape);
  const Key key{shape, scale, padding};
  if (auto found = cache.find(key)) return found;
  std::shared_ptr<const ShapeParts> made;
  if (scale == 1.0 && padding == 0.0) {
    made = shared_parts(*shape);
  } else {
    const std::unique_ptr<shapes::Shape> padded(shape->clone());
    padded->scaleAndPadd(scale, padding);
    made = shared_parts(*padded);
  }
  cache.keep(key, made);
  return made;
}

}  // namespace clearance_moveit
