// Where a body was at a past time, and by how much its place may be wrong.
#pragma once

#include <cstdint>

#include "core/pose.hpp"

namespace clearance {

// A body at a past time. No point within `radius` of its origin was farther from its place by
// `world_from_body` than error(radius), m.
struct PastPose {
  bool known = false;
  Pose world_from_body;
  double shift_error = 0.0, turn_error = 0.0;  // m; |R - R_exact|

  [[nodiscard]] double error(double radius) const noexcept;
  // True if it is not known, or if its pose is usable and no error is negative or NaN.
  [[nodiscard]] bool is_sound() const noexcept;
};

// The place of what a body carries at this pose, which is off by the two errors (m, rad). Rounding
// is included.
[[nodiscard]] PastPose carried(const PastPose& parent, const Pose& parent_from_child,
                               double shift_error, double turn_error) noexcept;

// Bounds the distance of a value from the straight line between two others, one of them `before_s`
// earlier and the other `after_s` later, if its speed is at most `speed` and that of the line is
// `mean`. A line that is faster shows that stamps are wrong: then the excess is added.
[[nodiscard]] double deviation(double before_s, double after_s, double speed, double mean) noexcept;
// The same of a position in space; and of a rotation, in rad.
[[nodiscard]] double deviation_in_space(double before_s, double after_s, double speed,
                                        double mean) noexcept;
[[nodiscard]] double deviation_of_turn(double before_s, double after_s, double speed,
                                       double mean) noexcept;

// The largest distance of a value with this largest speed within this time.
[[nodiscard]] double path_within(double speed, std::int64_t within_ns) noexcept;
// The part of a line's length that this speed does not explain, and the rounding.
[[nodiscard]] double excess(double time_s, double speed, double mean) noexcept;

}  // namespace clearance
