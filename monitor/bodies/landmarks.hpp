// Landmarks: the points of an object by which its poses are compared, and the limits of its motion.
// The rule that uses them is monitor/inputs/plausibility.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "config/scene/scene.hpp"
#include "monitor/inputs/plausibility.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// Measured speeds are noisy: a twist may exceed the stated speed by this factor.
inline constexpr double kTwistTolerance = 1.5;

// Up to four points of an object's bodies, far from each other. Their displacement stands for that
// of the object. As a metric of Plausibility (see there), its distances are in m.
class Landmarks {
 public:
  using Value = Pose;
  using Rate = Twist;

  Landmarks() = default;
  // Points at the distance `arm` from the origin of its frame stand for what the object carries, m.
  explicit Landmarks(const Object& object, double arm = 0.0);

  // Returns true if no landmark moves farther than `limit`, m, from one pose to the other. The
  // displacement a of the origin and a bound b of the rotational part usually decide without the
  // points themselves. For b, |R2 - R1| <= 2 |q2 - q1|. Then (a + b)^2 <= 2 a^2 + 2 b^2.
  [[nodiscard]] bool stay_within(double limit, const Pose& from, const Pose& to) const noexcept {
    const auto &p = from.orientation.coeffs(), &q = to.orientation.coeffs();
    const double turn = 4.0 * std::min((q - p).squaredNorm(), (q + p).squaredNorm());
    const double shift = (to.position - from.position).squaredNorm();
    return 2.0 * (shift + turn * (radius_ * radius_)) <= limit * limit ||
           each_stays_within(limit, from, to);
  }
  // Returns true if no landmark is faster than `limit`, m/s.
  [[nodiscard]] bool are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept;
  // Approximate path length of the landmarks, m, for a translation in m and a rotation in rad. With
  // a twist in m/s and rad/s it is their speed, m/s.
  [[nodiscard]] double length(const Twist& motion) const noexcept {
    return std::sqrt(motion.linear.squaredNorm() +
                     motion.angular.squaredNorm() * (radius_ * radius_));
  }
  [[nodiscard]] static Twist scaled_sum(double factor, const Twist& a, const Twist& b) noexcept {
    return {.linear = factor * (a.linear + b.linear), .angular = factor * (a.angular + b.angular)};
  }
  // The pose after a small translation, m, and rotation, rad; to first order.
  [[nodiscard]] static Pose moved(const Pose& pose, const Twist& step) noexcept;
  // A pose that is not where its twists lead does not tell which of the two is wrong.
  static constexpr bool kRatesMayBeWrong = false;

 private:
  [[nodiscard]] bool each_stays_within(double limit, const Pose& from,
                                       const Pose& to) const noexcept;

  std::array<Vec3, 4> points_;  // in the object's frame, m
  std::size_t count_ = 0;
  double radius_ = 0.0;  // bounding radius of the landmarks around the frame's origin, m
};

[[nodiscard]] MotionLimits motion_limits(const Object& object) noexcept;

// Always true for a sample without a twist.
[[nodiscard]] bool can_have_twist(const Object& object, const Landmarks& landmarks,
                                  const PoseSample& sample) noexcept;

}  // namespace clearance
