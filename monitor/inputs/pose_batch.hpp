// What comes in: poses as one source sent them, in the order in which they were taken, with what it
// takes to find a batch again in a recording.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/pose.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

inline constexpr std::size_t kMaxSources = 16;       // as in idl/clearance.idl
inline constexpr std::size_t kMaxSourceLength = 32;  // characters
inline constexpr std::uint32_t kNoSource = kMaxSources;

struct PoseSample {
  std::uint32_t object = 0;   // index into Scene::objects
  std::uint32_t source = 0;   // who sent it: below kMaxSources, the same for all that one sends
  std::int64_t stamp_ns = 0;  // when the pose held, CLOCK_REALTIME of who sent it
  Pose world_from_object;     // as on the wire: neither finite nor of unit length until checked
  Twist twist;
  bool has_twist = false;
};

// What a sample may be off unit length, and the largest number in it, m, m/s or rad/s: squares and
// sums of these stay finite. What converts poses from elsewhere refuses the same.
inline constexpr double kSampleUnitTolerance = 1e-3;
inline constexpr double kLargestInSample = 1e9;

// Why a sample was not used. Counted per object, named in the health topic.
enum class Reject : std::uint8_t {
  kUnknownObject,  // no such id, or a fixed object
  kNonFinite,      // NaN, infinity or beyond 1e9 (m, m/s, rad/s) in position, orientation or twist
  kNotUnit,        // | |q| - 1 | > 1e-3
  kBackwards,      // stamp before the one in use
  kFuture,         // stamp farther ahead of now than Scene::future_limit_ns
  kWrongRevision,  // made for another scene
  kOtherSource,    // another source sends this object's poses
  kTooFast,        // farther from the pose in use, or with a faster twist, than the object moves
  kFrozen,         // the same pose again and again, with a twist that says that it moves
  kOtherWay,       // elsewhere than the twists lead
  kCount
};
inline constexpr auto kRejects = static_cast<std::size_t>(Reject::kCount);
[[nodiscard]] const char* name(Reject cause) noexcept;

// Who sent a batch. Fixed size: copied in the tick thread.
class SourceName {
 public:
  SourceName() = default;
  // Longer names are cut.
  explicit SourceName(std::string_view text) noexcept {
    text.substr(0, kMaxSourceLength).copy(text_.data(), kMaxSourceLength);
  }
  [[nodiscard]] const char* c_str() const noexcept { return text_.data(); }
  [[nodiscard]] std::string_view view() const noexcept { return text_.data(); }
  bool operator==(const SourceName&) const = default;

 private:
  std::array<char, kMaxSourceLength + 1> text_{};  // the rest is zeros
};

// One sample of the topic `poses`, or of `joint_states`: then it has joints instead of poses.
struct PoseBatch {
  SourceName source;
  std::uint64_t sequence_number = 0;
  std::uint64_t scene_revision = 0;  // of the catalogue its ids are from; 0: not said
  std::vector<PoseSample> samples;
  std::vector<JointSample> joints = {};

  // Keeps the memory.
  void clear() noexcept {
    scene_revision = 0;
    samples.clear();
    joints.clear();
  }
  [[nodiscard]] bool empty() const noexcept { return samples.empty() && joints.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return samples.size() + joints.size(); }
};

// Whether the ids of a batch are those of this scene; revision 0 says nothing and is taken.
[[nodiscard]] inline bool made_for(const PoseBatch& batch, std::uint64_t scene_revision) noexcept {
  return batch.scene_revision == 0 || batch.scene_revision == scene_revision;
}

// The last batch of a source that a tick took in.
struct SourceUse {
  SourceName source;
  std::uint64_t sequence_number = 0;
};

}  // namespace clearance
