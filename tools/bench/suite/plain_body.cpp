#include "tools/bench/suite/plain_body.hpp"

#include "tools/bench/peers/welded.hpp"
#include "tools/bench/suite/planar_faces.hpp"

namespace clearance::bench {
namespace {

Numbers3 numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

PlainBody plain_body(const ConvexBody& body) {
  using enum PlainBody::Kind;
  PlainBody plain;
  plain.body = &body;
  plain.radius = body.radius;
  const CurvedShape& shape = body.curved;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    plain.kind = kEllipsoid;
    plain.half = numbers(shape.semi_axes);
  } else if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    plain.kind = shape.discs[1].radius == 0.0 ? kCone : kCylinder;
    plain.radius = shape.discs[0].radius;
    plain.half_length = shape.discs[1].height;
  } else if (body.vertices.size() == 1) {
    plain.kind = kSphere;
  } else if (body.vertices.size() == 2) {
    plain.kind = kCapsule;
    plain.half_length = body.vertices[1].position.cwiseAbs().z();
  } else {
    const Welded mesh = welded(body);
    for (const Vec3& p : mesh.points) plain.points.push_back(numbers(p));
    plain.faces = planar_faces(plain.points, mesh.faces);
    if (const auto half = box_half_extents(body)) {
      plain.kind = kBox;
      plain.half = numbers(*half);
    }
  }
  return plain;
}

PlainPose plain_pose(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {{q.w(), q.x(), q.y(), q.z()}, numbers(pose.position), &pose};
}

}  // namespace clearance::bench
