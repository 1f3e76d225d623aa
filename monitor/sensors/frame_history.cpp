#include "monitor/sensors/frame_history.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// Two publishers whose places differ by no more agree, m and rad.
constexpr double kSame = 1e-6;

double angle_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up(a.orientation.angularDistance(b.orientation));
}
double way_between(const Pose& a, const Pose& b) noexcept {
  return rounded_up((a.position - b.position).norm());
}

}  // namespace

bool FrameHistory::is_disputed(const Frame& frame, std::int64_t stamp_ns) noexcept {
  return frame.rival && (frame.rival_is_static || elapsed(frame.rival_ns, stamp_ns) <= kLostNs);
}

void FrameHistory::add(const std::string& child, const std::string& parent,
                       const Pose& parent_from_child, std::int64_t stamp_ns, bool is_static,
                       std::uint64_t writer) {
  const Eigen::Quaterniond& turn = parent_from_child.orientation;
  const bool is_pose = parent_from_child.position.allFinite() && turn.coeffs().allFinite() &&
                       std::abs(turn.norm() - 1.0) <= kSampleUnitTolerance;
  if (!is_pose || child.empty() || parent.empty() || child == parent) return;
  const auto known = frames_.find(child);
  if (known == frames_.end() && frames_.size() >= kMostFrames) return;
  Frame& frame = frames_[child];
  const Pose pose{parent_from_child.position, turn.normalized()};
  const bool has_owner =
      frame.writer && !frame.poses.empty() &&
      (frame.is_static || elapsed(frame.poses.last().stamp_ns, stamp_ns) <= kLostNs);
  if (has_owner && *frame.writer != writer) {
    const auto place = place_of(frame, stamp_ns);
    const bool agrees = place && frame.parent == parent &&
                        way_between(place->parent_from_child, pose) <= place->shift_error + kSame &&
                        angle_between(place->parent_from_child, pose) <= place->turn_error + kSame;
    if (!agrees) {
      frame.rival = writer;
      frame.rival_ns = stamp_ns;
      frame.rival_is_static = is_static;
    } else if (frame.rival == writer) {
      frame.rival.reset();
    }
    return;
  }
  frame.writer = writer;
  if (known == frames_.end() || frame.parent != parent || frame.is_static != is_static) {
    frame.parent = parent;
    frame.is_static = is_static;
    frame.poses = StampedSeries<Pose>(is_static ? 1 : kKept);
  }
  if (is_static) frame.poses.clear();
  frame.poses.add(is_static ? 1 : stamp_ns, pose);
}

void FrameHistory::keep(std::span<const std::uint64_t> writers) {
  const auto drop = [&](std::optional<std::uint64_t>& writer) {
    if (writer && !std::ranges::binary_search(writers, *writer)) writer.reset();
  };
  for (auto& [name, frame] : frames_) {
    drop(frame.writer);
    drop(frame.rival);
  }
}

std::optional<FrameHistory::Step> FrameHistory::step(const std::string& child,
                                                     std::int64_t stamp_ns,
                                                     std::int64_t within_ns) const {
  const auto found = frames_.find(child);
  if (found == frames_.end() || found->second.poses.empty()) return std::nullopt;
  if (is_disputed(found->second, stamp_ns)) return std::nullopt;
  auto step = place_of(found->second, stamp_ns);
  if (!step || within_ns == 0 || found->second.is_static) return step;
  for (const std::int64_t end : {stamp_ns - within_ns, stamp_ns + within_ns}) {
    const auto other = place_of(found->second, end);
    if (!other) return std::nullopt;
    const Pose &a = step->parent_from_child, &b = other->parent_from_child;
    step->shift_error =
        std::max(step->shift_error, rounded_up(way_between(a, b) + other->shift_error));
    step->turn_error =
        std::max(step->turn_error, rounded_up(angle_between(a, b) + other->turn_error));
  }
  return step;
}

std::optional<FrameHistory::Step> FrameHistory::place_of(const Frame& frame,
                                                         std::int64_t stamp_ns) {
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
