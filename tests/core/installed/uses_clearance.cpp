// The two ways in of README, "The core as a library"; ends with 0 where both say 1.5 m.
#include <core/batch.hpp>
#include <core/distance.hpp>
#include <core/shapes.hpp>

int main() {
  const auto cube = std::get<clearance::ConvexPolyhedron>(clearance::box({0.5, 0.5, 0.5}));
  clearance::Pose pose_a, pose_b;
  pose_b.position.x() = 2.5;
  clearance::TrackingState state;
  const auto alone =
      clearance::distance(cube, cube, clearance::relative_pose(pose_a, pose_b), state);

  const clearance::ConvexPolyhedron* const bodies[] = {&cube, &cube};
  const clearance::Pose poses[] = {pose_a, pose_b};
  const clearance::BodyPair pairs[] = {{0, 1}};
  clearance::DistanceBatch batch(bodies, pairs);
  bool agrees = alone.lower <= 1.5 && 1.5 <= alone.upper;
  for (const auto& r : batch.evaluate(poses)) agrees = agrees && r.distance == alone.distance;
  return agrees ? 0 : 1;
}
