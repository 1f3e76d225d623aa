#include "monitor/intake/tf_tree.hpp"

#include <algorithm>

namespace clearance {

std::int64_t stamp_ns(const std_msgs_msg_dds__Header_& header) noexcept {
  return std::int64_t{header.stamp.sec} * 1'000'000'000 + std::int64_t{header.stamp.nanosec};
}

Pose pose_of(const geometry_msgs_msg_dds__Transform_& transform) noexcept {
  const auto& [p, q] = transform;
  return {Vec3(p.x, p.y, p.z), Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

void TfTree::set(const geometry_msgs_msg_dds__TransformStamped_& transform, bool is_static) {
  set(frame_name(transform.child_frame_id),
      {.parent = frame_name(transform.header.frame_id),
       .parent_from_child = pose_of(transform.transform),
       .stamp_ns = is_static ? std::nullopt : std::optional(stamp_ns(transform.header))});
}

const TfTree::Link* TfTree::link(const std::string& child) const {
  const auto found = links_.find(child);
  return found == links_.end() ? nullptr : &found->second;
}

namespace {

// The velocity of a frame in the parent of the link. `in_child` is its velocity, and `point` its
// position, in the link's child.
Twist carried(const TfTree::Link& link, const Vec3& point, const Twist& in_child) {
  const Mat3 turn = link.parent_from_child.orientation.toRotationMatrix();
  const Twist own = link.twist.value_or(Twist{});
  return {.linear = own.linear + own.angular.cross(turn * point) + turn * in_child.linear,
          .angular = own.angular + turn * in_child.angular};
}

}  // namespace

// A path that is longer than the number of frames contains a cycle.
std::optional<TfTree::Place> TfTree::find(const std::string& frame, const std::string& world,
                                          const Instead* instead, const Earlier& earlier) const {
  const auto step_from = [&](const std::string& child) {
    return instead != nullptr && instead->child == child ? &instead->link : link(child);
  };
  const Link* step = step_from(frame);
  if (step == nullptr) return std::nullopt;
  Place place;
  for (std::size_t steps = 0; step != nullptr; ++steps) {
    if (steps > links_.size()) return std::nullopt;
    const bool is_known = place.twist && (step->twist || !step->stamp_ns);
    place.twist = is_known
                      ? std::optional(carried(*step, place.root_from_frame.position, *place.twist))
                      : std::nullopt;
    place.interval_ns = std::max(place.interval_ns, step->interval_ns);
    place.root_from_frame = compose(step->parent_from_child, place.root_from_frame);
    if (step->stamp_ns) {
      place.stamp_ns = std::min(place.stamp_ns.value_or(*step->stamp_ns), *step->stamp_ns);
    }
    place.root = step->parent;
    step = place.root == world ? nullptr : step_from(place.root);
  }
  if (!earlier || !place.stamp_ns) return place;
  place.root_from_frame = {};
  const std::string* child = &frame;
  for (step = step_from(frame); step != nullptr;
       step = *child == world ? nullptr : step_from(*child)) {
    Pose pose = step->parent_from_child;
    if (step->stamp_ns && *step->stamp_ns > *place.stamp_ns) {
      const auto then = earlier(*child, *step, *place.stamp_ns);
      place.is_of_one_time = place.is_of_one_time && then;
      if (then) pose = *then;
    }
    place.root_from_frame = compose(pose, place.root_from_frame);
    child = &step->parent;
  }
  return place;
}

}  // namespace clearance
