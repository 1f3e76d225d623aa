// Shapes that tests ask for, and answers to single queries.
#pragma once

#include "core/distance.hpp"
#include "core/shapes.hpp"

namespace clearance {

namespace oracle {
struct Body;
}

namespace test {

// Throws std::logic_error with the reason where the shape is refused.
[[nodiscard]] ConvexBody made(ShapeResult result);
[[nodiscard]] ConvexBody made(const oracle::Body& body);

// Its edges are 1 m long, its middle is the origin.
[[nodiscard]] ConvexBody cube();

// All x with normal . x <= offset.
[[nodiscard]] ConvexBody half_space(const Vec3& normal, double offset);

// A query that has no predecessor; with a pose of B alone, A is at the origin.
[[nodiscard]] DistanceResult cold(const ConvexBody& a, const ConvexBody& b,
                                  const RelativePose& pose);
[[nodiscard]] DistanceResult cold(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b);

}  // namespace test
}  // namespace clearance
