#include "tools/bench/peers/fcl_bodies.hpp"

#include <vector>

#include "tools/bench/peers/welded.hpp"

namespace clearance::bench {

// Faces in FCL's format: the number of vertices, then the vertices counter-clockwise.
std::shared_ptr<FclHull> fcl_hull(const ConvexBody& body) {
  const Welded mesh = welded(body);
  const auto points =
      std::make_shared<std::vector<fcl::Vector3d>>(mesh.points.begin(), mesh.points.end());
  const auto faces = std::make_shared<std::vector<int>>();
  for (const std::vector<int>& face : mesh.faces) {
    faces->push_back(static_cast<int>(face.size()));
    faces->insert(faces->end(), face.begin(), face.end());
  }
  return std::make_shared<FclHull>(points, static_cast<int>(mesh.faces.size()), faces);
}

FclShape fcl_shape(const ConvexBody& body) {
  const CurvedShape& shape = body.curved;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    return std::make_shared<fcl::Ellipsoidd>(shape.semi_axes);
  }
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    const auto& [low, high] = shape.discs;
    const double length = high.height - low.height;
    if (high.radius == 0.0) return std::make_shared<fcl::Coned>(low.radius, length);
    return std::make_shared<fcl::Cylinderd>(low.radius, length);
  }
  if (body.vertices.size() == 1) return std::make_shared<fcl::Sphered>(body.radius);
  if (body.vertices.size() == 2) {
    return std::make_shared<fcl::Capsuled>(body.radius, body.edges.front().end);
  }
  if (const auto half = box_half_extents(body)) return std::make_shared<fcl::Boxd>(2.0 * *half);
  return fcl_hull(body);
}

fcl::Transform3d fcl_transform(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.orientation.normalized().toRotationMatrix();
  t.translation() = pose.position;
  return t;
}

}  // namespace clearance::bench
