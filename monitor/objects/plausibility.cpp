#include "monitor/objects/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/model/curved_extent.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// The speed that is assumed for timing errors when twists are compared with poses, if the object
// states no max_speed, m/s.
constexpr double kUsualSpeed = 1.0;

// The time for which an anchor stays, in age limits. It reveals an object whose speed always
// exceeds its max_speed by more than a sixth.
constexpr std::int64_t kAnchorAgeLimits = 6;

// Over a longer gap, in age limits, the mean of two twists says nothing about the motion in
// between.
constexpr std::int64_t kGapAgeLimits = 2;
// The relative error of a twist.
constexpr double kTwistError = 1.0 / 6.0;

// The number of points that represent each circle of a curved part.
constexpr int kRound = 8;

double fastest_of(const Object& object) noexcept {
  return object.max_speed < kInfinity ? object.max_speed : kFastestUnstated;
}

double usual_speed_of(const Object& object) noexcept {
  return object.max_speed < kInfinity ? object.max_speed : kUsualSpeed;
}

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
Landmarks::Landmarks(const Object& object) {
  std::vector<Vec3> corners = corners_of(object);
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
  for (std::size_t i = 0; i < count_; ++i) reach_ = std::max(reach_, points_[i].norm());
}

bool Landmarks::each_stays_within(double limit, const Pose& from, const Pose& to) const noexcept {
  return std::all_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Vec3& point) {
                       return (transform(to, point) - transform(from, point)).norm() <= limit;
                     });
}

bool Landmarks::are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept {
  const double turn = twist.angular.squaredNorm() * (reach_ * reach_);
  if (2.0 * (twist.linear.squaredNorm() + turn) <= limit * limit) return true;
  return std::all_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Vec3& point) {
                       const Vec3 arm = transform(pose, point) - pose.position;
                       return (twist.linear + twist.angular.cross(arm)).norm() <= limit;
                     });
}

bool can_reach(const Object& object, const Landmarks& landmarks, const Pose& from, const Pose& to,
               std::int64_t elapsed_ns) noexcept {
  const double time = seconds(elapsed_ns) + seconds(object.age_limit_ns);
  return landmarks.stay_within(fastest_of(object) * time, from, to);
}

bool can_have_twist(const Object& object, const Landmarks& landmarks,
                    const PoseSample& sample) noexcept {
  return !sample.has_twist || landmarks.are_slower(kTwistTolerance * fastest_of(object),
                                                   sample.world_from_object, sample.twist);
}

void Repetition::add(bool same, std::int64_t stamp_ns) noexcept {
  last_ns_ = stamp_ns;
  if (!same) since_ns_ = stamp_ns;
}

bool Repetition::frozen(const Object& object) const noexcept {
  return object.frozen_limit_ns > 0 && elapsed(since_ns_, last_ns_) > object.frozen_limit_ns;
}

bool Reckoning::follows(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
                        bool same, const Object& object, const Landmarks& landmarks) noexcept {
  leads_elsewhere_ = false;
  if (!sample.has_twist) return true;
  const bool goes_on = any_ && elapsed(since_ns_, stamp_ns) <= kAgeLimits * object.age_limit_ns &&
                       elapsed(last_ns_, stamp_ns) <= kGapAgeLimits * object.age_limit_ns;
  if (!goes_on) {
    start(sample, pose, stamp_ns, landmarks);
    return true;
  }
  add(sample.twist, stamp_ns, landmarks);
  // Twists that are an age limit late do not contain the last part of the motion yet. Instead they
  // contain what preceded the first of them.
  const double missed = std::max(usual_speed_of(object), fastest_) + fastest_;
  const double limit = missed * seconds(object.age_limit_ns) + kTwistError * path_;
  leads_elsewhere_ = !landmarks.stay_within(limit, pose_, pose);
  if (!leads_elsewhere_) return true;
  if (!same) start(sample, pose, stamp_ns, landmarks);
  return false;
}

void Reckoning::start(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
                      const Landmarks& landmarks) noexcept {
  any_ = true;
  pose_ = pose;
  path_ = 0.0;
  last_ = sample.twist;
  last_speed_ = fastest_ = landmarks.length(last_);
  since_ns_ = last_ns_ = stamp_ns;
}

// Trapezoidal rule: integrates the mean of the last twist and this one.
void Reckoning::add(const Twist& twist, std::int64_t stamp_ns,
                    const Landmarks& landmarks) noexcept {
  const double half = 0.5 * seconds(elapsed(last_ns_, stamp_ns));
  const Twist step{.linear = half * (last_.linear + twist.linear),
                   .angular = half * (last_.angular + twist.angular)};
  const double speed = landmarks.length(twist);
  path_ += half * (last_speed_ + speed);
  fastest_ = std::max(fastest_, speed);
  last_ = twist;
  last_speed_ = speed;
  last_ns_ = stamp_ns;
  pose_.position += step.linear;
  const Eigen::Quaterniond half_turn(0.0, 0.5 * step.angular.x(), 0.5 * step.angular.y(),
                                     0.5 * step.angular.z());
  pose_.orientation.coeffs() += (half_turn * pose_.orientation).coeffs();
  normalize_almost_unit(pose_.orientation);
}

void Anchor::set(const Pose& pose, std::int64_t stamp_ns) noexcept {
  pose_ = pose;
  stamp_ns_ = stamp_ns;
}

bool Anchor::allows(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                    const Landmarks& landmarks) const noexcept {
  return can_reach(object, landmarks, pose_, pose, elapsed(stamp_ns_, stamp_ns));
}

void Anchor::follow(const Pose& pose, std::int64_t stamp_ns, const Object& object) noexcept {
  if (elapsed(stamp_ns_, stamp_ns) > kAnchorAgeLimits * object.age_limit_ns) set(pose, stamp_ns);
}

bool OtherPlace::add(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                     const Landmarks& landmarks) noexcept {
  const std::int64_t passed_ns = elapsed(last_ns_, stamp_ns);
  const bool stays = any_ && passed_ns <= std::max(kGapNs, 2 * object.age_limit_ns) &&
                     can_reach(object, landmarks, pose_, pose, passed_ns);
  if (!stays) since_ns_ = stamp_ns;
  any_ = true;
  pose_ = pose;
  last_ns_ = stamp_ns;
  return elapsed(since_ns_, stamp_ns) >= kTakenAfterNs;
}

}  // namespace clearance
