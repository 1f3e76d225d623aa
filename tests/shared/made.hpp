// Shapes for tests, and answers to single queries.
#pragma once

#include "core/distance.hpp"
#include "core/shapes.hpp"

namespace clearance {

namespace oracle {
struct Body;
}

namespace test {

// Throws std::logic_error with the reason if the shape is refused.
[[nodiscard]] ConvexBody made(ShapeResult result);
[[nodiscard]] ConvexBody made(const oracle::Body& body);

// A cube with edges of 1 m, centred at the origin.
[[nodiscard]] ConvexBody cube();

// The half-space of all x with normal . x <= offset.
[[nodiscard]] ConvexBody half_space(const Vec3& normal, double offset);

// A query without a tracking state from an earlier one. If only the pose of B is given, A is at the
// origin.
[[nodiscard]] DistanceResult cold(const ConvexBody& a, const ConvexBody& b,
                                  const RelativePose& pose);
[[nodiscard]] DistanceResult cold(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b);

}  // namespace test
}  // namespace clearance
