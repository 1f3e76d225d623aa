#include "tests/shared/made.hpp"

#include <stdexcept>
#include <variant>

#include "tests/shared/distance_judge.hpp"

namespace clearance::test {

ConvexBody made(ShapeResult result) {
  if (const auto* error = std::get_if<ShapeError>(&result)) throw std::logic_error(error->reason);
  return std::get<ConvexBody>(std::move(result));
}

ConvexBody made(const oracle::Body& body) { return made(model(body)); }

ConvexBody cube() { return made(box({0.5, 0.5, 0.5})); }

ConvexBody half_space(const Vec3& normal, double offset) {
  const HalfSpace row{normal, offset};
  return made(polyhedron_from_halfspaces({&row, 1}));
}

DistanceResult cold(const ConvexBody& a, const ConvexBody& b, const RelativePose& pose) {
  TrackingState state;
  return distance(a, b, pose, state);
}

DistanceResult cold(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b) {
  return cold(a, b, relative_pose(Pose{}, pose_b));
}

}  // namespace clearance::test
