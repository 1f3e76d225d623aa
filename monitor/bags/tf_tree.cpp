#include "monitor/bags/tf_tree.hpp"

#include <algorithm>

namespace clearance {

std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

void TfTree::set(const RosTransform& transform, bool is_static) {
  Link& link = links_[frame_name(transform.child)];
  link.parent = frame_name(transform.parent);
  link.parent_from_child = transform.parent_from_child;
  link.stamp_ns = is_static ? std::nullopt : std::optional(transform.stamp_ns);
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
