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

#include <array>
#include <cstddef>
#include <cstdint>

#include "config/scene.hpp"
#include "monitor/pose_batch.hpp"

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

  // Whether none of them goes farther than `limit`, m, from one pose to the other.
  [[nodiscard]] bool stay_within(double limit, const Pose& from, const Pose& to) const noexcept;
  // Whether none of them is faster than `limit`, m/s.
  [[nodiscard]] bool are_slower(double limit, const Pose& pose, const Twist& twist) const noexcept;
  // The speed of the fastest, m/s.
  [[nodiscard]] double fastest(const Pose& pose, const Twist& twist) const noexcept;

 private:
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
  void add(bool same, std::int64_t stamp_ns, const PoseSample& sample, const Object& object,
           const Landmarks& landmarks) noexcept;
  // The twists lead farther than the object goes in an age limit, or the pose has come for longer
  // than the cell says that one of this object may.
  [[nodiscard]] bool frozen(const Pose& pose, const Object& object,
                            const Landmarks& landmarks) const noexcept;

 private:
  std::int64_t since_ns_ = 0, last_ns_ = 0;
  // Where the twists lead, m and rad, in sum, so that noise is none; zero from when one says that
  // the object is as good as at rest.
  Twist way_;
  std::int64_t way_since_ns_ = 0;
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
