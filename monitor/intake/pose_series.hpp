// The last poses of a frame or an object, and how far it may have been from a place between them.
#pragma once

#include <cstdint>

#include "core/pose.hpp"
#include "monitor/inputs/stamped_series.hpp"

namespace clearance {

using PoseSeries = StampedSeries<Pose>;

// A body may move out and back between two poses that are farther apart in time than this, ns. Ten
// poses a second are usual for mobile bases, and late now and then.
inline constexpr std::int64_t kLongGapNs = 150'000'000;

// Rounded up, m and rad.
[[nodiscard]] double distance_between(const Pose& a, const Pose& b) noexcept;
[[nodiscard]] double angle_between(const Pose& a, const Pose& b) noexcept;

// On the straight line from a to b.
[[nodiscard]] Pose pose_between(const Pose& a, const Pose& b, double share) noexcept;

// On that line at this time, which is within the series.
[[nodiscard]] Pose pose_at(const PoseSeries& series, std::int64_t stamp_ns) noexcept;

struct PoseSpread {
  double shift = 0.0, turn = 0.0;  // m, rad
  std::int64_t longest_ns = 0;     // the longest time between two poses
};

// Bounds the differences of all poses from the first time to the last one to this pose. Between two
// poses, anything is taken to be within the ball whose diameter is the straight line between them:
// it may begin to move, or stop, at any time in between. Both times are within the series.
[[nodiscard]] PoseSpread spread(const PoseSeries& series, const Pose& pose, std::int64_t first_ns,
                                std::int64_t last_ns) noexcept;

}  // namespace clearance
