#include "monitor/sensors/frame_history.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

double angle_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up(a.orientation.angularDistance(b.orientation));
}
double way_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up((a.position - b.position).norm());
}

}  // namespace

void FrameHistory::add(const std::string& child, const std::string& parent,
                       const Pose& parent_from_child, std::int64_t stamp_ns, bool is_static) {
  const Eigen::Quaterniond& turn = parent_from_child.orientation;
  const bool is_pose = parent_from_child.position.allFinite() && turn.coeffs().allFinite() &&
                       std::abs(turn.norm() - 1.0) <= kSampleUnitTolerance;
  if (!is_pose || child.empty() || parent.empty() || child == parent) return;
  const auto known = frames_.find(child);
  if (known == frames_.end() && frames_.size() >= kMostFrames) return;
  Frame& frame = frames_[child];
  if (known == frames_.end() || frame.parent != parent || frame.is_static != is_static) {
    frame = {parent, is_static, StampedSeries<Pose>(is_static ? 1 : kKept)};
  }
  if (is_static) frame.poses.clear();
  frame.poses.add(is_static ? 1 : stamp_ns, {parent_from_child.position, turn.normalized()});
}

std::optional<FrameHistory::Step> FrameHistory::step(const std::string& child,
                                                     std::int64_t stamp_ns) const {
  const auto found = frames_.find(child);
  if (found == frames_.end() || found->second.poses.empty()) return std::nullopt;
  const Frame& frame = found->second;
  Step step{.parent = frame.parent, .parent_from_child = frame.poses.last().value};
  if (frame.is_static) return step;
  const auto [before, after] = frame.poses.around(stamp_ns);
  if (before == nullptr) return std::nullopt;
  step.parent_from_child = before->value;
  if (before == after) return step;
  const double since = static_cast<double>(elapsed(before->stamp_ns, stamp_ns));
  if (after != nullptr) {
    const double until = static_cast<double>(elapsed(stamp_ns, after->stamp_ns));
    const double share = since / (since + until);
    step.shift_error = 0.5 * way_between(before->value, after->value);
    step.turn_error = 0.5 * angle_between(before->value, after->value);
    if (!same_pose(before->value, after->value)) {
      step.parent_from_child = {
          (1.0 - share) * before->value.position + share * after->value.position,
          before->value.orientation.slerp(share, after->value.orientation).normalized()};
    }
    return step;
  }
  if (elapsed(before->stamp_ns, stamp_ns) > kLostNs) return std::nullopt;
  if (frame.poses.size() < 2) return step;
  const auto& earlier = frame.poses.at(frame.poses.size() - 2);
  const double ratio =
      since / std::max(1.0, static_cast<double>(elapsed(earlier.stamp_ns, before->stamp_ns)));
  step.shift_error = rounded_up(ratio * way_between(earlier.value, before->value));
  step.turn_error = rounded_up(ratio * angle_between(earlier.value, before->value));
  return step;
}

}  // namespace clearance
