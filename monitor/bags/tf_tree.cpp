#include "monitor/bags/tf_tree.hpp"

#include <algorithm>

namespace clearance {

std::int64_t stamp_ns(const std_msgs_msg_dds__Header_& header) noexcept {
  return std::int64_t{header.stamp.sec} * 1'000'000'000 + std::int64_t{header.stamp.nanosec};
}

std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

void TfTree::set(const geometry_msgs_msg_dds__TransformStamped_& transform, bool is_static) {
  Link& link = links_[frame_name(transform.child_frame_id)];
  link.parent = frame_name(transform.header.frame_id);
  const auto& [translation, rotation] = transform.transform;
  link.parent_from_child.position = Vec3(translation.x, translation.y, translation.z);
  link.parent_from_child.orientation =
      Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z);
  link.stamp_ns = is_static ? std::nullopt : std::optional(stamp_ns(transform.header));
}

// A way that is longer than there are frames goes round in a circle.
std::optional<TfTree::Place> TfTree::find(const std::string& frame) const {
  auto link = links_.find(frame);
  if (link == links_.end()) return std::nullopt;
  Place place;
  for (std::size_t steps = 0; link != links_.end(); ++steps) {
    if (steps > links_.size()) return std::nullopt;
    const Link& step = link->second;
    place.root_from_frame = compose(step.parent_from_child, place.root_from_frame);
    if (step.stamp_ns) {
      place.stamp_ns = std::min(place.stamp_ns.value_or(*step.stamp_ns), *step.stamp_ns);
    }
    place.root = step.parent;
    link = links_.find(step.parent);
  }
  return place;
}

}  // namespace clearance
