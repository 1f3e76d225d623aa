// Uses both entry points of core/README.md, "As a library". It exits with 0 if both agree with
// closed forms. It is built with several switches under which Eigen lays out its types
// differently.
#include <core/batch.hpp>
#include <core/distance.hpp>
#include <core/shapes.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

using clearance::Pose;

// Checks two unit cubes with centres at a distance of 2.5 m, alone and in a batch. The answers may
// differ from `expected` by rounding.
bool agree(const Pose& pose_a, const Pose& pose_b, double expected) {
  const auto cube = std::get<clearance::ConvexBody>(clearance::box({0.5, 0.5, 0.5}));
  clearance::TrackingState state;
  const auto alone = clearance::distance(cube, cube, pose_a, pose_b, state);
  clearance::TrackingState other;
  const auto by_relative =
      clearance::distance(cube, cube, clearance::relative_pose(pose_a, pose_b), other);

  const clearance::ConvexBody* const bodies[] = {&cube, &cube};
  const Pose poses[] = {pose_a, pose_b};
  const clearance::BodyPair pairs[] = {{0, 1}};
  clearance::DistanceBatch batch(bodies, pairs);
  const double together = batch.evaluate(poses)[0].distance;
  std::printf("%.9f m alone, %.9f m in a batch; expected %.9f m\n", alone.distance, together,
              expected);
  return std::abs(alone.distance - expected) < 1e-12 && alone.lower <= expected + 1e-12 &&
         expected - 1e-12 <= alone.upper && together == alone.distance &&
         by_relative.distance == alone.distance;
}

// The library reads shapes that are made here, and vice versa.
bool shares_shapes() {
  const std::vector<clearance::Vec2> base = {{0, 0}, {1, 0}, {0, 1}};
  const auto made = clearance::prism(base, 0.0, 2.0);
  const auto* prism = std::get_if<clearance::ConvexBody>(&made);
  return prism != nullptr && prism->vertices.size() == 6 && prism->edges.size() == 9 &&
         prism->radius == 0.0;
}

int main() {
  Pose here, beside, turned;
  beside.position.x() = turned.position.x() = 2.5;
  turned.orientation = Eigen::AngleAxisd(std::atan(1.0), clearance::Vec3::UnitZ());
  const auto quarter = clearance::relative_pose(here, turned).rotation;
  const bool columns = quarter(1, 0) > 0.7 && quarter(0, 1) < -0.7;
  const bool good = agree(here, beside, 1.5) && agree(here, turned, 2.0 - std::sqrt(0.5)) &&
                    agree(turned, here, 2.0 - std::sqrt(0.5)) && shares_shapes() && columns;
  return good ? 0 : 1;
}
