#include "monitor/objects/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/model/curved_extent.hpp"
#include "monitor/objects/elapsed.hpp"

namespace clearance {
namespace {

// Twists that claim no more than this share of the largest speed are noise of an object at rest.
constexpr double kAtRest = 0.01;
// By which the repetitions of an object that states no max_speed are judged, m/s.
constexpr double kUsualSpeed = 1.0;

// How long an anchor holds, in age limits: an object that is never slower than its speed and a
// sixth is found out.
constexpr std::int64_t kAnchorAgeLimits = 6;

// Over how long twists are summed up, in age limits: over more, noise comes to something.
constexpr std::int64_t kWayAgeLimits = 50;

// So many points of a curved part's circles stand for its corners.
constexpr int kRound = 8;

double seconds(std::int64_t ns) noexcept { return static_cast<double>(ns) * 1e-9; }

double fastest_of(const Object& object) noexcept {
  return object.max_speed < kInfinity ? object.max_speed : kFastestUnstated;
}

double usual_speed_of(const Object& object) noexcept {
  return object.max_speed < kInfinity ? object.max_speed : kUsualSpeed;
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

// Each is the corner farthest from those before it.
Landmarks::Landmarks(const Object& object) {
  const std::vector<Vec3> corners = corners_of(object);
  if (corners.empty()) return;
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

// The origin's way and the turn, |R2 - R1| <= 2 |q2 - q1|, mostly tell at once.
bool Landmarks::stay_within(double limit, const Pose& from, const Pose& to) const noexcept {
  const auto &p = from.orientation.coeffs(), &q = to.orientation.coeffs();
  const double turn = 2.0 * std::sqrt(std::min((q - p).squaredNorm(), (q + p).squaredNorm()));
  if ((to.position - from.position).norm() + turn * reach_ <= limit) return true;
  return std::all_of(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const Vec3& point) {
                       return (transform(to, point) - transform(from, point)).norm() <= limit;
                     });
}

bool Landmarks::are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept {
  if (twist.linear.norm() + twist.angular.norm() * reach_ <= limit) return true;
  return fastest(pose, twist) <= limit;
}

double Landmarks::fastest(const Pose& pose, const Twist& twist) const noexcept {
  double fastest = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3 arm = transform(pose, points_[i]) - pose.position;
    fastest = std::max(fastest, (twist.linear + twist.angular.cross(arm)).norm());
  }
  return fastest;
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

void Repetition::add(bool same, std::int64_t stamp_ns, const PoseSample& sample,
                     const Object& object, const Landmarks& landmarks) noexcept {
  const double passed = seconds(elapsed(last_ns_, stamp_ns));
  last_ns_ = stamp_ns;
  if (!same) since_ns_ = stamp_ns;
  if (!same || elapsed(way_since_ns_, stamp_ns) > kWayAgeLimits * object.age_limit_ns) {
    way_ = {};
    way_since_ns_ = stamp_ns;
  }
  const bool moves = same && sample.has_twist &&
                     !landmarks.are_slower(kAtRest * usual_speed_of(object),
                                           sample.world_from_object, sample.twist);
  if (moves) {
    way_.linear += passed * sample.twist.linear;
    way_.angular += passed * sample.twist.angular;
  } else {
    way_ = {};
  }
}

bool Repetition::frozen(const Pose& pose, const Object& object,
                        const Landmarks& landmarks) const noexcept {
  const double farthest = usual_speed_of(object) * seconds(object.age_limit_ns);
  if (!landmarks.are_slower(farthest, pose, way_)) return true;
  return object.frozen_limit_ns > 0 && elapsed(since_ns_, last_ns_) > object.frozen_limit_ns;
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
  const bool stays = any_ && can_reach(object, landmarks, pose_, pose, elapsed(last_ns_, stamp_ns));
  if (!stays) since_ns_ = stamp_ns;
  any_ = true;
  pose_ = pose;
  last_ns_ = stamp_ns;
  return elapsed(since_ns_, stamp_ns) >= kTakenAfterNs;
}

}  // namespace clearance
