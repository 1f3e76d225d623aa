// Holds answers of distance() against the exact truth, and says in words what is wrong with them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "tests/shared/exact_oracle.hpp"

namespace clearance {

// The core's model of a body, or the reason why it was refused.
[[nodiscard]] ShapeResult model(const oracle::Body& body);

class DistanceJudge {
 public:
  DistanceJudge(const oracle::Body& a, const oracle::Body& b);

  // Empty when both bodies have been accepted by the factories.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  [[nodiscard]] const ConvexBody& a() const { return a_; }
  [[nodiscard]] const ConvexBody& b() const { return b_; }

  [[nodiscard]] DistanceResult ask(const Pose& pose_a, const Pose& pose_b,
                                   TrackingState& state) const;
  // The signed distance; of bodies that overlap and have more than 16 rows or points and are no
  // prisms or lenses (exact_features.hpp), or that no translation parts, without the depth.
  [[nodiscard]] oracle::ExactDistance truth(const Pose& pose_a, const Pose& pose_b);

  // What the result gets wrong; empty when nothing:
  //  - numbers: finite where they must be, lower <= distance <= upper
  //  - the bounds, compared exactly; where the depth is not known, that B moved along the normal
  //    by as much parts from A, and by less does not, to 1e-14 of size()
  //  - the status: converged within 1e-14 of size(), overlapping and touching within 1.25e-14, and
  //    only where it is so
  //  - the witness points, to 1.5e-14: on their bodies, and `distance` apart along the normal; the
  //    normal: unit
  // Of two unbounded bodies: that the bounds hold, and that numbers are numbers.
  [[nodiscard]] std::vector<std::string> faults(const DistanceResult& result,
                                                const oracle::ExactDistance& truth,
                                                const Pose& pose_a, const Pose& pose_b);

  // The lengths that a rounding error is relative to: reach of both bodies (of an unbounded one as
  // far as the closest points may lie), and how far their origins are apart.
  [[nodiscard]] double size(const DistanceResult& result, const oracle::ExactDistance& truth,
                            const Pose& pose_a, const Pose& pose_b) const;

 private:
  [[nodiscard]] bool depth_is_asked_for() const;
  // Is the truth that of the bodies, and not only that they overlap?
  [[nodiscard]] bool depth_is_known(const oracle::ExactDistance& truth) const;
  // `farthest`: the distance or depth, m.
  [[nodiscard]] double size(double farthest, const Pose& pose_a, const Pose& pose_b) const;
  // What is wrong with an overlap's bounds along its own normal, to `tolerance` and the rounding of
  // B's position: B has to miss A when it is moved by the lower one, and to meet it by less than
  // the upper one.
  [[nodiscard]] std::vector<std::string> faults_along(const DistanceResult& r, double tolerance,
                                                      const Pose& pose_a, const Pose& pose_b);
  // A ball of this radius fits into both (of a point or segment: around one of its points). Says no
  // where one of them is a hull of points.
  [[nodiscard]] bool overlap_by(double depth, const Pose& pose_a, const Pose& pose_b) const;

  [[nodiscard]] std::vector<std::string> faults_of_unbounded(
      const DistanceResult& r, const oracle::ExactDistance& truth) const;

  oracle::Body body_a_, body_b_;
  oracle::ExactBody exact_a_, exact_b_;
  ConvexBody a_, b_;
  std::string refusal_;
};

}  // namespace clearance
