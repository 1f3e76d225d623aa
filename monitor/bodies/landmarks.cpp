#include "monitor/bodies/landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/model/curved_extent.hpp"

namespace clearance {
namespace {

// The number of points that represent each circle of a curved part.
constexpr int kRound = 8;

// Normalises to first order if the error of that is negligible.
void normalize_almost_unit(Eigen::Quaterniond& q) noexcept {
  const double off = q.squaredNorm() - 1.0;
  if (std::abs(off) < 1e-3) {
    q.coeffs() *= 1.0 - 0.5 * off;
  } else {
    q.normalize();
  }
}

std::vector<Vec3> corners_of(const Object& object) {
  std::vector<Vec3> corners;
  for (const Part& part : object.parts) {
    for (const Vertex& vertex : part.shape.vertices) {
      corners.push_back(transform(part.object_from_part, vertex.position));
    }
    for (const Vec3& point : surface_points(part.shape.curved, kRound)) {
      corners.push_back(transform(part.object_from_part, point));
    }
  }
  return corners;
}

}  // namespace

// Farthest-point sampling: each landmark is the vertex with the largest distance from those before
// it.
Landmarks::Landmarks(const Object& object, double arm) {
  std::vector<Vec3> corners = corners_of(object);
  for (int i = 0; i < 6 && arm > 0.0; ++i)
    corners.push_back((i < 3 ? arm : -arm) * Vec3::Unit(i % 3));
  if (corners.empty()) corners.push_back(Vec3::Zero());  // a half-space has none
  points_[count_++] = corners.front();
  while (count_ < points_.size()) {
    const auto apart = [&](const Vec3& corner) {
      double nearest = kInfinity;
      for (std::size_t i = 0; i < count_; ++i)
        nearest = std::min(nearest, (corner - points_[i]).norm());
      return nearest;
    };
    const Vec3& farthest = *std::ranges::max_element(corners, {}, apart);
    if (apart(farthest) == 0.0) break;
    points_[count_++] = farthest;
  }
  for (std::size_t i = 0; i < count_; ++i) radius_ = std::max(radius_, points_[i].norm());
}

bool Landmarks::each_stays_within(double limit, const Pose& from, const Pose& to) const noexcept {
  return std::all_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Vec3& point) {
                       return (transform(to, point) - transform(from, point)).norm() <= limit;
                     });
}

bool Landmarks::are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept {
  const double turn = twist.angular.squaredNorm() * (radius_ * radius_);
  if (2.0 * (twist.linear.squaredNorm() + turn) <= limit * limit) return true;
  return std::all_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Vec3& point) {
                       const Vec3 arm = transform(pose, point) - pose.position;
                       return (twist.linear + twist.angular.cross(arm)).norm() <= limit;
                     });
}

Pose Landmarks::moved(const Pose& pose, const Twist& step) noexcept {
  Pose moved = pose;
  moved.position += step.linear;
  const Eigen::Quaterniond half_turn(0.0, 0.5 * step.angular.x(), 0.5 * step.angular.y(),
                                     0.5 * step.angular.z());
  moved.orientation.coeffs() += (half_turn * moved.orientation).coeffs();
  normalize_almost_unit(moved.orientation);
  return moved;
}

MotionLimits motion_limits(const Object& object) noexcept {
  return {.fastest = object.plausible_speed(),
          .usual = object.max_speed < kInfinity ? object.max_speed : kUsualSpeed,
          .age_limit_ns = object.age_limit_ns,
          .frozen_limit_ns = object.frozen_limit_ns};
}

bool can_have_twist(const Object& object, const Landmarks& landmarks,
                    const PoseSample& sample) noexcept {
  return !sample.has_twist || landmarks.are_slower(kTwistTolerance * object.plausible_speed(),
                                                   sample.world_from_object, sample.twist);
}

}  // namespace clearance
