// Pose samples as one source sent them, in the order in which they were taken. Source and sequence
// number identify a batch in a recording.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "config/scene/source_name.hpp"
#include "core/pose.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

struct PoseSample {
  std::uint32_t object = 0;   // index into Scene::objects
  std::uint32_t source = 0;   // number of the sender, below kMaxSources
  std::int64_t stamp_ns = 0;  // when the pose held, CLOCK_REALTIME of the sender
  Pose world_from_object;     // as on the wire: may be non-finite or not unit until checked
  Twist twist;
  bool has_twist = false;
  std::uint32_t namesake = kNoSource;  // number of the sender whose name this one shares, if any
};

// True if two samples of an object agree.
[[nodiscard]] inline bool say_the_same(const PoseSample& a, const PoseSample& b) noexcept {
  const Pose &pose_a = a.world_from_object, &pose_b = b.world_from_object;
  const bool same_twist = a.twist.linear == b.twist.linear && a.twist.angular == b.twist.angular;
  return pose_a.position == pose_b.position &&
         pose_a.orientation.coeffs() == pose_b.orientation.coeffs() && a.has_twist == b.has_twist &&
         (!a.has_twist || same_twist);
}

// The largest error of the length of a sample's quaternion, and the largest number in a sample, m,
// m/s or rad/s. Squares and sums of such numbers stay finite. Decoders of other formats use the
// same limits.
inline constexpr double kSampleUnitTolerance = 1e-3;
inline constexpr double kLargestInSample = 1e9;

// Why a sample was not used. Refusals are counted per object and named in the health topic.
enum class Reject : std::uint8_t {
  kUnknownObject,   // no such id, or a fixed object
  kNonFinite,       // position, orientation or twist has NaN, infinity or a number above 1e9
  kNotUnit,         // | |q| - 1 | > 1e-3
  kBackwards,       // its stamp is before that of the pose in use
  kFuture,          // its stamp is more than Scene::future_limit_ns ahead of now
  kWrongRevision,   // made for another scene
  kOtherSource,     // another source sends this object's poses
  kTooFast,         // its distance from the pose in use, or its twist, exceeds the speed limit
  kFrozen,          // the same pose repeatedly, although its twist says that it moves
  kOtherDirection,  // not where the twists or velocities lead
  kDisputed,        // another source sends this input, and the two values exclude each other
  kOutsideLimits,   // a joint's position is outside its limits
  kCount
};
inline constexpr auto kRejects = static_cast<std::size_t>(Reject::kCount);
[[nodiscard]] const char* name(Reject cause) noexcept;

// The sender of a batch. Its size is fixed, so the tick thread can copy it without allocating.
class SourceName {
 public:
  SourceName() = default;
  // Longer names are cut at their beginning, because the end of a topic is more distinctive.
  explicit SourceName(std::string_view text) noexcept {
    if (text.size() > kMaxSourceLength) text.remove_prefix(text.size() - kMaxSourceLength);
    text.copy(text_.data(), kMaxSourceLength);
  }
  [[nodiscard]] const char* c_str() const noexcept { return text_.data(); }
  [[nodiscard]] std::string_view view() const noexcept { return text_.data(); }
  bool operator==(const SourceName&) const = default;
  [[nodiscard]] bool is_sound() const noexcept { return text_.back() == 0; }

 private:
  std::array<char, kMaxSourceLength + 1> text_{};  // the rest is zeros
};

// One sample of the topic `poses`, or of `joint_states`: the latter has joints instead of poses.
struct PoseBatch {
  SourceName source;
  std::uint64_t sequence_number = 0;
  std::uint64_t scene_revision = 0;  // of the catalogue that its ids are from; 0: not stated
  std::vector<PoseSample> samples;
  std::vector<JointSample> joints = {};
  std::int64_t came_ns = 0;   // when it was handed over, CLOCK_MONOTONIC; 0: not known
  std::uint64_t content = 0;  // content_of(*this) when it was handed over; 0: not known

  // Keeps the allocated memory, and all but the samples, the joints and their revision.
  void clear() noexcept {
    scene_revision = 0;
    samples.clear();
    joints.clear();
  }
  [[nodiscard]] bool empty() const noexcept { return samples.empty() && joints.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return samples.size() + joints.size(); }
};

// Returns true if the ids of the batch belong to this scene. Revision 0 states nothing and passes.
[[nodiscard]] inline bool made_for(const PoseBatch& batch, std::uint64_t scene_revision) noexcept {
  return batch.scene_revision == 0 || batch.scene_revision == scene_revision;
}

// The last batch of a source that a tick took into use.
struct SourceUse {
  SourceName source;
  std::uint64_t sequence_number = 0;
  std::uint64_t content = 0;  // PoseBatch::content
};

}  // namespace clearance
