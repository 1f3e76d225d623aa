// The places of a scene's bodies at the stamp of a frame.
//
// Joint positions and poses are kept for some time. Between two of them, a joint is where the
// straight line leads, to within what its largest speed allows; that deviation is part of the error
// of every link which the joint carries. After the last one, it is within its largest speed times
// the time since then. The speeds are those by which the tick bounds late inputs.
//
// A value that the one before cannot have become is refused by the tick's rule
// (monitor/inputs/plausibility.hpp), and the input is unknown around it. So is a joint whose
// positions are frozen, are not where its velocities lead, or are outside of its limits.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/plausibility.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/kinematics/joint_metric.hpp"
#include "monitor/objects/tracked_object.hpp"
#include "monitor/sensors/pose_series.hpp"

namespace clearance {

// A body at a past time. No point within `radius` of its origin was farther from its place by
// `world_from_body` than error(radius), m.
struct PastPose {
  bool known = false;
  Pose world_from_body;
  double shift_error = 0.0, turn_error = 0.0;  // m; |R - R_exact|

  [[nodiscard]] double error(double radius) const noexcept;
};

// The place of what a body carries at this pose, which is off by the two errors (m, rad). Rounding
// is included.
[[nodiscard]] PastPose carried(const PastPose& parent, const Pose& parent_from_child,
                               double shift_error, double turn_error) noexcept;

// The places of a scene's joints and bodies at one time. The poses of all links follow from them.
struct PlacedPostures {
  struct Joint {
    bool known = false;
    double position = 0.0, may_have_moved = 0.0;  // rad or m
  };
  std::vector<Joint> joints;      // by variable
  std::vector<PastPose> objects;  // by object; those that are no links
};

// The distance of two poses of an object that carries sensors or robots, as the metric of the
// plausibility: the way of its origin, m. It may turn by `turn_per_way` at the same time, rad/m.
struct CarrierMetric {
  using Value = Pose;
  double turn_per_way = 0.0;

  [[nodiscard]] bool stay_within(double limit, const Pose& from, const Pose& to) const noexcept {
    return way_between(from, to) <= limit && angle_between(from, to) <= limit * turn_per_way;
  }
};

class PostureHistory {
 public:
  // At 1 kHz, two seconds.
  static constexpr std::size_t kKept = 2048;

  // The scene must outlive this. `numbers` are those of the samples' sources. Allocates all memory
  // for joints.
  PostureHistory(const Scene& scene, SourceNumbers numbers);
  explicit PostureHistory(const Scene& scene) : PostureHistory(scene, SourceNumbers(scene)) {}

  // Samples in the order in which they came. If the cell states the source of an input, those of
  // others are left out. Else those of a second source are left out while the first one sends. If
  // either sends what the input cannot have reached, the input has no value then. The same holds
  // for a second writer of the stated source (SourceNumbers::append).
  void add(const JointSample& sample);
  void add(const PoseSample& sample);
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
  // The last time in which samples contradicted those in use.
  struct Disputed {
    bool ever = false;
    std::int64_t from_ns = 0, until_ns = 0;
    void add(std::int64_t stamp_ns, std::int64_t hold_ns) noexcept;
    [[nodiscard]] bool at(std::int64_t time_ns) const noexcept;
  };
  template <class Metric>
  struct Input {
    StampedSeries<typename Metric::Value> values{kKept};
    std::uint32_t source = kNoSource;
    Disputed disputed;
    OtherPlace<Metric> elsewhere;

    // Every sample of joints and objects goes through this. `stated` is the source that the cell
    // names, or kNoSource.
    void take(const SampleOrigin& from, std::uint32_t stated, const typename Metric::Value& value,
              const MotionLimits& limits, const Metric& metric);
  };
  using Joint = Input<JointMetric>;
  using Body = Input<CarrierMetric>;

  void judge(const JointSample& sample);
  void judge(const PoseSample& sample);
  void place_joint(std::size_t variable, std::int64_t stamp_ns, std::int64_t within_ns);
  void place_links();
  [[nodiscard]] PastPose pose_at(std::uint32_t object, std::int64_t stamp_ns,
                                 std::int64_t within_ns) const;

  const Scene& scene_;
  std::vector<std::uint32_t> joint_sources_, object_sources_;  // that the cell states
  std::vector<Joint> joints_;                                  // by variable
  std::vector<TrackedVariable> judged_;                        // as the tick judges their positions
  std::map<std::uint32_t, Body> bodies_;                       // by object
  std::map<std::uint32_t, TrackedObject> judged_bodies_;       // likewise
  std::vector<TrackedVariable> variables_;
  std::vector<LinkState> bases_;   // by robot
  std::vector<PastPose> objects_;  // at the last place()
  ForwardKinematics kinematics_;
};

// Bounds the distance of a value from the straight line between two others, one of them `before_s`
// earlier and the other `after_s` later, if its speed is at most `speed` and that of the line is
// `mean`. A line that is faster shows that stamps are wrong: then the excess is added.
[[nodiscard]] double deviation(double before_s, double after_s, double speed, double mean) noexcept;
// The same of a position in space; and of a rotation, in rad.
[[nodiscard]] double deviation_in_space(double before_s, double after_s, double speed,
                                        double mean) noexcept;
[[nodiscard]] double deviation_of_turn(double before_s, double after_s, double speed,
                                       double mean) noexcept;

}  // namespace clearance
