// Checks whether an object can be at a pose, given its earlier poses and the speed that the cell
// states for it.
//
// No point of an object with max_speed v moves farther than v (t + age limit) in the time t between
// two stamps. The age limit is the largest timing error that the cell accepts for a pose. The bound
// is checked against the pose in use and against an older pose, so that a series of steps cannot
// exceed it either.
//
// If two poses exclude each other, they do not tell which one is wrong. The later pose is not used.
// The object is unknown until a pose agrees again and an age limit has passed since the last
// contradiction. Poses that stay at the other place are taken as soon as the object can have got
// there, or after ten seconds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// The speed limit of an object that states no max_speed, m/s.
inline constexpr double kFastestUnstated = 1000.0;
// Measured speeds are noisy: a twist may exceed the stated speed by this factor.
inline constexpr double kTwistTolerance = 1.5;

// Up to four points of an object's bodies, far from each other. Their displacement stands for that
// of the object.
class Landmarks {
 public:
  Landmarks() = default;
  explicit Landmarks(const Object& object);

  // Returns true if no landmark moves farther than `limit`, m, from one pose to the other. The
  // displacement a of the origin and a bound b of the rotational part usually decide without the
  // points themselves. For b, |R2 - R1| <= 2 |q2 - q1|. Then (a + b)^2 <= 2 a^2 + 2 b^2.
  [[nodiscard]] bool stay_within(double limit, const Pose& from, const Pose& to) const noexcept {
    const auto &p = from.orientation.coeffs(), &q = to.orientation.coeffs();
    const double turn = 4.0 * std::min((q - p).squaredNorm(), (q + p).squaredNorm());
    const double shift = (to.position - from.position).squaredNorm();
    return 2.0 * (shift + turn * (reach_ * reach_)) <= limit * limit ||
           each_stays_within(limit, from, to);
  }
  // Returns true if no landmark is faster than `limit`, m/s.
  [[nodiscard]] bool are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept;
  // Approximate path length of the landmarks, m, for a translation in m and a rotation in rad. With
  // a twist in m/s and rad/s it is their speed, m/s.
  [[nodiscard]] double length(const Twist& way) const noexcept {
    return std::sqrt(way.linear.squaredNorm() + way.angular.squaredNorm() * (reach_ * reach_));
  }

 private:
  [[nodiscard]] bool each_stays_within(double limit, const Pose& from,
                                       const Pose& to) const noexcept;

  std::array<Vec3, 4> points_;  // in the object's frame, m
  std::size_t count_ = 0;
  double reach_ = 0.0;  // bounding radius of the landmarks around the frame's origin, m
};

// `from` is the pose in use, and `elapsed_ns` the time between its stamp and that of `to`.
[[nodiscard]] bool can_reach(const Object& object, const Landmarks& landmarks, const Pose& from,
                             const Pose& to, std::int64_t elapsed_ns) noexcept;
// Always true for a sample without a twist.
[[nodiscard]] bool can_have_twist(const Object& object, const Landmarks& landmarks,
                                  const PoseSample& sample) noexcept;

// Detects a pose that is sent repeatedly, bit for bit.
class Repetition {
 public:
  // `same` means that the sample has the pose in use. `stamp_ns` is in the tick's time.
  void add(bool same, std::int64_t stamp_ns) noexcept;
  // True when the pose has repeated for longer than the cell permits for this object.
  [[nodiscard]] bool frozen(const Object& object) const noexcept;

 private:
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

// Dead reckoning: integrates the twists from an older pose. A pose that is not where they lead
// contradicts them.
//
// A twist may have a timing error of the age limit and a relative error of one sixth. Over the
// whole integration time, noise of up to a thirtieth of the object's speed accumulates to little.
// The same holds for an offset of up to a fiftieth. Samples without a twist are left out. Nothing
// is checked if twists come less often than every two age limits.
class Reckoning {
 public:
  // Adds the sample's twist, if it has one. Returns false if the pose is not where the twists lead.
  // `stamp_ns` is in the tick's time. `same` is that of Repetition::add().
  [[nodiscard]] bool follows(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
                             bool same, const Object& object, const Landmarks& landmarks) noexcept;

  // True if the last sample was not where the twists lead.
  [[nodiscard]] bool leads_elsewhere() const noexcept { return leads_elsewhere_; }

  // The integration time, in age limits. Over a longer time, noise would accumulate too much.
  static constexpr std::int64_t kAgeLimits = 50;
  // Later samples must agree for this time after a contradiction, in age limits. In a shorter time
  // a slow deviation would not be detected again. An object whose pose always lags behind would
  // then be known in between.
  static constexpr std::int64_t kAgreesAfterAgeLimits = kAgeLimits + 1;

 private:
  void start(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
             const Landmarks& landmarks) noexcept;
  void add(const Twist& twist, std::int64_t stamp_ns, const Landmarks& landmarks) noexcept;

  bool any_ = false, leads_elsewhere_ = false;
  Pose pose_;             // the integrated pose
  double path_ = 0.0;     // length of the integrated path, m
  double fastest_ = 0.0;  // the fastest speed since since_ns_, m/s
  Twist last_;
  double last_speed_ = 0.0;  // landmark speed by `last_`, at most, m/s
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

// An older pose of the stream in use. The object must be able to get from it to each new pose.
class Anchor {
 public:
  // Starts from the first pose of a stream.
  void set(const Pose& pose, std::int64_t stamp_ns) noexcept;
  [[nodiscard]] bool allows(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                            const Landmarks& landmarks) const noexcept;
  // Call this with every later pose that is taken.
  void follow(const Pose& pose, std::int64_t stamp_ns, const Object& object) noexcept;

 private:
  Pose pose_;
  std::int64_t stamp_ns_ = 0;
};

// Detects poses that stay at a place where the object cannot be.
class OtherPlace {
 public:
  // Poses that stay there for this time are taken.
  static constexpr std::int64_t kTakenAfterNs = 10'000'000'000;
  // The largest time between two consecutive poses that still counts as staying; two age limits if
  // that is longer.
  static constexpr std::int64_t kGapNs = 1'000'000'000;

  // Returns true if the poses have stayed long enough. Stamps are in the tick's time.
  [[nodiscard]] bool add(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                         const Landmarks& landmarks) noexcept;
  void clear() noexcept { any_ = false; }

 private:
  bool any_ = false;
  Pose pose_;
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

}  // namespace clearance
