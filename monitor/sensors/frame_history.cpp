#include "monitor/sensors/frame_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {
namespace {

// Two publishers whose places differ by no more agree, m and rad.
constexpr double kSame = 1e-6;

}  // namespace

const FrameHistory::Frame* FrameHistory::undisputed(const std::string& child,
                                                    std::int64_t stamp_ns) const {
  const auto found = frames_.find(child);
  if (found == frames_.end() || found->second.poses.empty()) return nullptr;
  const Frame& frame = found->second;
  const bool is_disputed =
      frame.rival && (frame.rival_is_static || elapsed(frame.rival_ns, stamp_ns) <= kLostNs);
  return is_disputed ? nullptr : &frame;
}

// Whether the frame may have this pose at that time: after its last transform, within the speed of
// the last two.
bool FrameHistory::agrees(const Frame& frame, const Pose& pose, std::int64_t stamp_ns) {
  auto place = place_of(frame, stamp_ns, 0);
  const auto& last = frame.poses.last();
  if (!place && stamp_ns > last.stamp_ns) {
    place = {.parent = frame.parent, .parent_from_child = last.value};
    if (frame.poses.size() > 1) {
      const auto& earlier = frame.poses.at(frame.poses.size() - 2);
      const double ratio = static_cast<double>(elapsed(last.stamp_ns, stamp_ns)) /
                           static_cast<double>(elapsed(earlier.stamp_ns, last.stamp_ns));
      place->shift_error = ratio * way_between(earlier.value, last.value);
      place->turn_error = ratio * angle_between(earlier.value, last.value);
    }
  }
  return place && way_between(place->parent_from_child, pose) <= place->shift_error + kSame &&
         angle_between(place->parent_from_child, pose) <= place->turn_error + kSame;
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
    if (frame.parent != parent || !agrees(frame, pose, stamp_ns)) {
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
    frame.poses = PoseSeries(is_static ? 1 : kKept);
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

void FrameHistory::forget() {
  for (auto& [name, frame] : frames_) {
    if (frame.is_static) continue;
    frame.poses.clear();
    frame.rival.reset();
  }
}

void FrameHistory::append_stamps(const std::string& child, std::int64_t first_ns,
                                 std::int64_t last_ns, std::vector<std::int64_t>& stamps) const {
  const auto found = frames_.find(child);
  if (found == frames_.end() || found->second.is_static) return;
  const PoseSeries& poses = found->second.poses;
  std::size_t i = poses.first_from(first_ns);
  for (i = i > 0 ? i - 1 : i; i < poses.size(); ++i) {
    stamps.push_back(poses.at(i).stamp_ns);
    if (stamps.back() >= last_ns) break;
  }
}

std::optional<FrameHistory::Parent> FrameHistory::parent(const std::string& child,
                                                         std::int64_t stamp_ns) const {
  const Frame* const frame = undisputed(child, stamp_ns);
  if (frame == nullptr) return std::nullopt;
  return Parent{&frame->parent, frame->is_static ? std::numeric_limits<std::int64_t>::max()
                                                 : frame->poses.last().stamp_ns};
}

std::optional<FrameHistory::Step> FrameHistory::step(const std::string& child,
                                                     std::int64_t stamp_ns,
                                                     std::int64_t within_ns) const {
  const Frame* const frame = undisputed(child, stamp_ns);
  return frame == nullptr ? std::nullopt : place_of(*frame, stamp_ns, within_ns);
}

std::optional<FrameHistory::Step> FrameHistory::place_of(const Frame& frame, std::int64_t stamp_ns,
                                                         std::int64_t within_ns) {
  Step step{.parent = frame.parent, .parent_from_child = frame.poses.last().value};
  if (frame.is_static) return step;
  const std::int64_t first_ns = stamp_ns - within_ns, last_ns = stamp_ns + within_ns;
  if (first_ns < frame.poses.at(0).stamp_ns || last_ns > frame.poses.last().stamp_ns)
    return std::nullopt;
  step.parent_from_child = pose_at(frame.poses, stamp_ns);
  const PoseSpread error = spread(frame.poses, step.parent_from_child, first_ns, last_ns);
  if (error.longest_ns > kLostNs) return std::nullopt;
  step.shift_error = error.shift;
  step.turn_error = error.turn;
  step.longest_ns = error.longest_ns;
  return step;
}

}  // namespace clearance
