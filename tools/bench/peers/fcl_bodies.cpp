#include "tools/bench/peers/fcl_bodies.hpp"

#include <vector>

#include "tools/bench/peers/welded.hpp"

namespace clearance::bench {

// Faces as FCL wants them: the number of corners, then the corners counter-clockwise.
std::shared_ptr<FclHull> fcl_hull(const ConvexPolyhedron& body) {
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

fcl::Transform3d fcl_transform(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.orientation.normalized().toRotationMatrix();
  t.translation() = pose.position;
  return t;
}

}  // namespace clearance::bench
