#include "tests/shared/made.hpp"

#include <stdexcept>
#include <variant>

#include "tests/shared/distance_judge.hpp"

namespace clearance::test {

ConvexPolyhedron made(ShapeResult result) {
  if (const auto* error = std::get_if<ShapeError>(&result)) throw std::logic_error(error->reason);
  return std::get<ConvexPolyhedron>(std::move(result));
}

ConvexPolyhedron made(const oracle::Body& body) { return made(model(body)); }

ConvexPolyhedron cube() { return made(box({0.5, 0.5, 0.5})); }

ConvexPolyhedron half_space(const Vec3& normal, double offset) {
  const HalfSpace row{normal, offset};
  return made(polyhedron_from_halfspaces({&row, 1}));
}

DistanceResult cold(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose& pose) {
  TrackingState state;
  return distance(a, b, pose, state);
}

DistanceResult cold(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const Pose& pose_b) {
  return cold(a, b, relative_pose(Pose{}, pose_b));
}

}  // namespace clearance::test
