// Compares answers of distance() with the exact truth, and states in words what is wrong with them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "tests/shared/exact_oracle.hpp"

namespace clearance {

// The core's model of a body, or the reason for its refusal.
[[nodiscard]] ShapeResult model(const oracle::Body& body);

class DistanceJudge {
 public:
  DistanceJudge(const oracle::Body& a, const oracle::Body& b);

  // Empty if the factories have accepted both bodies.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  [[nodiscard]] const ConvexBody& a() const { return a_; }
  [[nodiscard]] const ConvexBody& b() const { return b_; }

  [[nodiscard]] DistanceResult ask(const Pose& pose_a, const Pose& pose_b,
                                   TrackingState& state) const;
  // The exact signed distance. The depth of an overlap is left out if no translation separates the
  // bodies. It is also left out if a body has more than 16 rows or points and is neither a prism
  // nor a lens (exact_features.hpp).
  [[nodiscard]] oracle::ExactDistance truth(const Pose& pose_a, const Pose& pose_b);

  // The errors of the result; empty if there are none. It checks the following.
  // - The numbers are finite where they must be, and lower <= distance <= upper.
  // - The bounds hold, compared exactly. If the depth is not known, B must miss A when it is moved
  //   along the normal by -lower. Moved by less than -upper, it must meet A. Both hold to 1e-14 of
  //   size().
  // - The status is true: converged within 1e-14 of size(), overlapping and touching within
  //   1.25e-14.
  // - The witness points lie on their bodies and are separated by `distance` along the normal, to
  //   1.5e-14. The normal has unit length.
  //
  // For two unbounded bodies it checks only that the bounds hold and that the numbers are numbers.
  [[nodiscard]] std::vector<std::string> faults(const DistanceResult& result,
                                                const oracle::ExactDistance& truth,
                                                const Pose& pose_a, const Pose& pose_b);

  // The length that rounding errors are relative to: the bounding radii of both bodies and the
  // distance between their origins. For an unbounded body, the farthest possible position of its
  // closest point replaces the radius.
  [[nodiscard]] double size(const DistanceResult& result, const oracle::ExactDistance& truth,
                            const Pose& pose_a, const Pose& pose_b) const;

 private:
  [[nodiscard]] bool depth_is_asked_for() const;
  // Returns true if `truth` contains the depth of an overlap, and not only the fact that the bodies
  // overlap.
  [[nodiscard]] bool depth_is_known(const oracle::ExactDistance& truth) const;
  // `farthest`: the distance or the depth, m.
  [[nodiscard]] double size(double farthest, const Pose& pose_a, const Pose& pose_b) const;
  // Checks the bounds of an overlap along its own normal, to `tolerance` and the rounding of B's
  // position. B must miss A if it is moved by -lower. It must meet A if it is moved by less than
  // -upper.
  [[nodiscard]] std::vector<std::string> faults_along(const DistanceResult& r, double tolerance,
                                                      const Pose& pose_a, const Pose& pose_b);
  // Returns true if a ball of radius `depth` fits into the intersection of both bodies. For a point
  // or a segment, the ball is centred at one of its points. Returns false if one of the bodies is a
  // hull of points.
  [[nodiscard]] bool overlap_by(double depth, const Pose& pose_a, const Pose& pose_b) const;

  [[nodiscard]] std::vector<std::string> faults_of_unbounded(
      const DistanceResult& r, const oracle::ExactDistance& truth) const;

  oracle::Body body_a_, body_b_;
  oracle::ExactBody exact_a_, exact_b_;
  ConvexBody a_, b_;
  std::string refusal_;
};

}  // namespace clearance
