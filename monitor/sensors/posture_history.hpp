// The places of a scene's bodies at the stamp of a frame.
//
// Joint positions and poses are kept for some time. Between two of them, a joint is where the
// straight line leads, to within what its largest speed allows; that deviation is part of the error
// of every link which the joint carries. After the last one, it is within its largest speed times
// the time since then. The speeds are those by which the tick bounds late inputs.
//
// Every sample is judged as the tick judges it, by the input's track. Around one that contradicts
// it, and until one is taken again, the input is unknown.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/tracked_object.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/inputs/track.hpp"
#include "monitor/intake/pose_series.hpp"
#include "monitor/sensors/past_pose.hpp"

namespace clearance {

// The places of a scene's joints and bodies at one time. The poses of all links follow from them.
struct PlacedPostures {
  struct Joint {
    bool known = false;
    double position = 0.0, may_have_moved = 0.0;  // rad or m
  };
  std::vector<Joint> joints;      // by variable
  std::vector<PastPose> objects;  // by object; those that are no links
};

class PostureHistory {
 public:
  // At 1 kHz, two seconds.
  static constexpr std::size_t kKept = 2048;

  // The scene must outlive this. `numbers` are those of the samples' sources. Allocates all memory
  // for joints.
  PostureHistory(const Scene& scene, SourceNumbers numbers);
  explicit PostureHistory(const Scene& scene) : PostureHistory(scene, SourceNumbers(scene)) {}

  // Samples in the order in which they came, and this machine's time then, by the same clock as
  // their stamps.
  void add(const JointSample& sample, std::int64_t came_ns);
  void add(const PoseSample& sample, std::int64_t came_ns);
  // This machine's clock was set back: what was heard says nothing about times that come again.
  void forget();

  // True if no joint or pose that was heard lacks a value at or after the stamp.
  [[nodiscard]] bool covers(std::int64_t stamp_ns) const noexcept;
  // True if no joint that is heard has its first value after the stamp.
  [[nodiscard]] bool began_by(std::int64_t stamp_ns) const noexcept;
  // Finds where everything was at this time, for the two functions below. The time is known to
  // `within_ns`, which the errors of all poses include.
  void place(std::int64_t stamp_ns, std::int64_t within_ns = 0);
  // The same for what another history of this scene found. False: it is of another scene.
  [[nodiscard]] bool place(const PlacedPostures& placed);
  // The result of the last place().
  [[nodiscard]] PlacedPostures placed() const;
  [[nodiscard]] PastPose link(std::uint32_t robot, std::uint32_t link) const noexcept;
  // The pose of an object that is no link: a fixed one, or one whose poses come.
  [[nodiscard]] PastPose object(std::uint32_t object) const noexcept;

 private:
  using JointTrack = Track<TrackedVariable, double>;
  using BodyTrack = Track<TrackedObject, Pose>;

  [[nodiscard]] TrackedVariable initial_joint(std::size_t variable) const;
  [[nodiscard]] TrackedObject initial_body(std::uint32_t object) const;
  void place_joint(std::size_t variable, std::int64_t stamp_ns, std::int64_t within_ns);
  void place_links();
  [[nodiscard]] PastPose pose_at(std::uint32_t object, std::int64_t stamp_ns,
                                 std::int64_t within_ns) const;

  const Scene& scene_;
  std::vector<std::uint32_t> joint_sources_, object_sources_;  // that the cell states
  std::vector<JointTrack> joints_;                             // by variable
  std::map<std::uint32_t, BodyTrack> bodies_;                  // by object
  std::vector<TrackedVariable> variables_;                     // at the last place()
  std::vector<LinkState> bases_;                               // by robot
  std::vector<PastPose> objects_;                              // at the last place()
  ForwardKinematics kinematics_;
};

}  // namespace clearance
