// Whether a pose can be true of an object that was where its last poses say, as far as the cell
// states how fast the object moves.
//
// No point of an object with max_speed v goes farther than v (t + age limit) while t passes between
// two stamps: the age limit is how far off in time the cell lets a pose be. That is held against
// the pose in use, and against an older one, so that no row of steps comes to more. Which of two
// poses that exclude each other is wrong, they do not tell: the later one is not used, and the
// object is unknown until one agrees again and an age limit has passed since the last
// contradiction. Where the poses stay at the other place, they are taken when the object can have
// got there, or after ten seconds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// An object that states no max_speed is taken to be slower than that, m/s.
inline constexpr double kFastestUnstated = 1000.0;
// Measured speeds are noisy: a twist may exceed the stated speed by this factor.
inline constexpr double kTwistTolerance = 1.5;

// Up to four points of an object's bodies, far from each other: where they have come, so has the
// object.
class Landmarks {
 public:
  Landmarks() = default;
  explicit Landmarks(const Object& object);

  // Whether none of them goes farther than `limit`, m, from one pose to the other. The origin's
  // way and the turn, |R2 - R1| <= 2 |q2 - q1|, mostly tell at once: (a + b)^2 <= 2 a^2 + 2 b^2.
  [[nodiscard]] bool stay_within(double limit, const Pose& from, const Pose& to) const noexcept {
    const auto &p = from.orientation.coeffs(), &q = to.orientation.coeffs();
    const double turn = 4.0 * std::min((q - p).squaredNorm(), (q + p).squaredNorm());
    const double shift = (to.position - from.position).squaredNorm();
    return 2.0 * (shift + turn * (reach_ * reach_)) <= limit * limit ||
           each_stays_within(limit, from, to);
  }
  // Whether none of them is faster than `limit`, m/s.
  [[nodiscard]] bool are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept;
  // How far they go, about, m, on a way of so many m and rad.
  [[nodiscard]] double length(const Twist& way) const noexcept {
    return std::sqrt(way.linear.squaredNorm() + way.angular.squaredNorm() * (reach_ * reach_));
  }

 private:
  [[nodiscard]] bool each_stays_within(double limit, const Pose& from,
                                       const Pose& to) const noexcept;

  std::array<Vec3, 4> points_;  // in the object's frame, m
  std::size_t count_ = 0;
  double reach_ = 0.0;  // none is farther from the frame's origin, m
};

// `from` is the pose in use, `elapsed_ns` what has passed between its stamp and that of `to`.
[[nodiscard]] bool can_reach(const Object& object, const Landmarks& landmarks, const Pose& from,
                             const Pose& to, std::int64_t elapsed_ns) noexcept;
// A sample without a twist claims nothing.
[[nodiscard]] bool can_have_twist(const Object& object, const Landmarks& landmarks,
                                  const PoseSample& sample) noexcept;

// A pose that comes again and again, bit for bit.
class Repetition {
 public:
  // `same`: the sample has the pose that is in use. `stamp_ns`: in the tick's time.
  void add(bool same, std::int64_t stamp_ns) noexcept;
  // It has come for longer than the cell says that one of this object may.
  [[nodiscard]] bool frozen(const Object& object) const noexcept;

 private:
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

// Where the twists lead from an older pose: poses that are elsewhere contradict them. A twist may
// be off in time by the age limit, and by a sixth of itself; over the whole time that is summed up,
// noise of up to a thirtieth of the object's speed comes to little, and an offset to no more than a
// fiftieth of that. Samples without a twist are left out; where twists come less often than every
// two age limits, nothing is told.
class Reckoning {
 public:
  // Adds the sample's twist, if it has one. False: it leads elsewhere. `stamp_ns` is in the tick's
  // time, `same` as of a repetition.
  [[nodiscard]] bool follows(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
                             bool same, const Object& object, const Landmarks& landmarks) noexcept;

  // Whether the last sample was elsewhere.
  [[nodiscard]] bool leads_elsewhere() const noexcept { return leads_elsewhere_; }

  // Over how long twists are summed up, in age limits: over more, noise comes to something.
  static constexpr std::int64_t kAgeLimits = 50;
  // How long what follows must agree: over less, what is slow would not be found out again, and a
  // pose that stays behind for good be known in between.
  static constexpr std::int64_t kAgreesAfterAgeLimits = kAgeLimits + 1;

 private:
  void start(const PoseSample& sample, const Pose& pose, std::int64_t stamp_ns,
             const Landmarks& landmarks) noexcept;
  void add(const Twist& twist, std::int64_t stamp_ns, const Landmarks& landmarks) noexcept;

  bool any_ = false, leads_elsewhere_ = false;
  Pose pose_;             // where they lead
  double path_ = 0.0;     // how far it is to there, m
  double fastest_ = 0.0;  // of the twists since then, m/s
  Twist last_;
  double last_speed_ = 0.0;  // of the fastest point by that, at most, m/s
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

// An older pose of the stream in use, from which the object cannot have gone too far either.
class Anchor {
 public:
  // To the first pose of a stream.
  void set(const Pose& pose, std::int64_t stamp_ns) noexcept;
  [[nodiscard]] bool allows(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                            const Landmarks& landmarks) const noexcept;
  // Of every other one that is taken.
  void follow(const Pose& pose, std::int64_t stamp_ns, const Object& object) noexcept;

 private:
  Pose pose_;
  std::int64_t stamp_ns_ = 0;
};

// Poses that stay at a place where the object cannot be.
class OtherPlace {
 public:
  // Until when they have to stay there to be taken.
  static constexpr std::int64_t kTakenAfterNs = 10'000'000'000;
  // Two that are farther apart than this, and than two age limits, are not said to stay.
  static constexpr std::int64_t kGapNs = 1'000'000'000;

  // True: they have stayed long enough. Stamps are in the tick's time.
  [[nodiscard]] bool add(const Pose& pose, std::int64_t stamp_ns, const Object& object,
                         const Landmarks& landmarks) noexcept;
  void clear() noexcept { any_ = false; }

 private:
  bool any_ = false;
  Pose pose_;
  std::int64_t since_ns_ = 0, last_ns_ = 0;
};

}  // namespace clearance
