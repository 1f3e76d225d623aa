#include "monitor/intake/pose_series.hpp"

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {

double distance_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up((a.position - b.position).norm());
}

double angle_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up(a.orientation.angularDistance(b.orientation));
}

Pose pose_between(const Pose& a, const Pose& b, double share) noexcept {
  if (same_pose(a, b)) return a;
  return {(1.0 - share) * a.position + share * b.position,
          a.orientation.slerp(share, b.orientation).normalized()};
}

Pose pose_at(const PoseSeries& series, std::int64_t stamp_ns) noexcept {
  const auto [before, after] = series.around(stamp_ns);
  const auto since = static_cast<double>(elapsed(before->stamp_ns, stamp_ns));
  const auto until = static_cast<double>(elapsed(stamp_ns, after->stamp_ns));
  return before == after ? before->value
                         : pose_between(before->value, after->value, since / (since + until));
}

PoseSpread spread(const PoseSeries& series, const Pose& pose, std::int64_t first_ns,
                  std::int64_t last_ns) noexcept {
  PoseSpread found;
  const auto enclose = [&](const Pose& centre, double shift, double turn) {
    found.shift = std::max(found.shift, rounded_up(distance_between(pose, centre) + shift));
    found.turn = std::max(found.turn, rounded_up(angle_between(pose, centre) + turn));
  };
  for (std::size_t i = series.first_from(first_ns); i < series.size(); ++i) {
    const auto& after = series.at(i);
    if (after.stamp_ns <= last_ns) enclose(after.value, 0.0, 0.0);
    if (i > 0 && after.stamp_ns > first_ns && series.at(i - 1).stamp_ns < last_ns) {
      const auto& before = series.at(i - 1);
      const Pose &a = before.value, &b = after.value;
      found.longest_ns = std::max(found.longest_ns, elapsed(before.stamp_ns, after.stamp_ns));
      enclose(pose_between(a, b, 0.5), 0.5 * distance_between(a, b), 0.5 * angle_between(a, b));
    }
    if (after.stamp_ns >= last_ns) break;
  }
  return found;
}

}  // namespace clearance
