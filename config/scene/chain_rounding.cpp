// Bounds the rounding error of the sums in ForwardKinematics::carry by the largest lengths that can
// occur in them.
#include "config/scene/chain_rounding.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// The sums in this file round as well; together they lose less than this factor.
constexpr double kRounded = 1.0 + 0x1p-40;

// The bound of one link: its error, and its largest distance from the world's origin, m.
struct LinkBound {
  ChainError error;
  double farthest = 0.0;
};

// Returns the largest length that a position can have, m.
double largest(const JointVariable& variable, double multiplier, double offset) noexcept {
  const double limit = std::max(std::abs(variable.lower), std::abs(variable.upper));
  const double length = std::isfinite(limit) ? limit + variable.limit_tolerance : kLargestLength;
  return std::abs(multiplier) * length + std::abs(offset);
}

// Returns the largest angle of the joint that rounding errors depend on, rad.
double angle_of(const RobotJoint& joint, const std::vector<JointVariable>& variables) {
  constexpr double kLargestAngle = 1e6;
  const bool turns = joint.type == JointType::kRevolute || joint.type == JointType::kContinuous ||
                     joint.type == JointType::kPlanar;
  if (!turns) return 0.0;
  if (!joint.rescales()) return kLeastSureAngle;
  const JointVariable& variable = variables[joint.variable];
  const double limit = std::max(std::abs(variable.lower), std::abs(variable.upper));
  const double angle = std::isfinite(limit) ? limit + variable.limit_tolerance : kLargestAngle;
  return std::max(kLeastSureAngle, std::abs(joint.multiplier) * angle + std::abs(joint.offset));
}

LinkBound carried(const LinkBound& parent, double step, double slide, double angle) noexcept {
  const double far = step + slide;
  LinkBound link;
  link.error.turn = kRounded * (parent.error.turn + kJointError + kPositionError * angle);
  link.error.shift = kRounded * (parent.error.shift + (parent.error.turn + kJointError) * far +
                                 kPositionError * slide + kPlacingError * (parent.farthest + far));
  link.farthest = kRounded * (parent.farthest + far);
  return link;
}

}  // namespace

double largest_slide(const RobotJoint& joint, const std::vector<JointVariable>& variables) {
  switch (joint.type) {
    case JointType::kPrismatic:
      return largest(variables[joint.variable], joint.multiplier, joint.offset);
    case JointType::kPlanar:
      return 2.0 * kLargestLength;
    case JointType::kFloating:
      return 3.0 * kLargestLength;
    default:
      return 0.0;
  }
}

std::vector<ChainError> chain_rounding(const std::vector<Robot>& robots,
                                       const std::vector<JointVariable>& variables) {
  std::vector<std::vector<LinkBound>> bounds;
  for (const Robot& robot : robots) {
    LinkBound parent;
    if (robot.base.kind == RobotBase::Kind::kObject) parent.farthest = kLargestLength;
    if (robot.base.kind == RobotBase::Kind::kLink)
      parent = bounds[robot.base.robot][robot.base.link];
    std::vector<LinkBound>& links = bounds.emplace_back();
    links.push_back(carried(parent, robot.base.base_from_root.position.norm(), 0.0, 0.0));
    for (const RobotJoint& joint : robot.joints) {
      links.push_back(carried(links[joint.parent], joint.parent_from_joint.position.norm(),
                              largest_slide(joint, variables), angle_of(joint, variables)));
    }
  }
  std::vector<ChainError> errors;
  for (const LinkBound& link : bounds.back()) errors.push_back(link.error);
  return errors;
}

void account_for(const ChainError& error, Object& object) {
  double radius = 0.0;
  for (const Part& part : object.parts) {
    for (const Vec3& anchor : part.shape.anchors) {
      radius = std::max(radius, transform(part.object_from_part, anchor).norm());
    }
    radius = std::max(radius, part.object_from_part.position.norm() + part.shape.bounding_radius);
    radius += part.shape.radius + part.shape.position_error;
  }
  // The lever arm is doubled: at run time, the error is taken for a sphere around the parts.
  object.pose_error = kRounded * (error.shift + 2.0 * error.turn * radius);
  for (Part& part : object.parts) {
    ConvexBody& shape = part.shape;
    shape.position_error += object.pose_error;
    shape.error_bound_as_a += object.pose_error;
    shape.error_bound_as_b += object.pose_error;
    shape.inner_radius = std::max(0.0, shape.inner_radius - object.pose_error);
  }
}

}  // namespace clearance
