#include "posed_parts.hpp"

#include <algorithm>
#include <cstddef>

namespace clearance_moveit {

Pose pose_of(const Eigen::Isometry3d& place) {
  Pose pose;
  pose.position = place.translation();
  pose.orientation = Eigen::Quaterniond(place.linear()).normalized();
  return pose;
}

void PosedParts::add(const std::shared_ptr<const ShapeParts>& shape,
                     const Eigen::Isometry3d& place) {
  const Pose pose = pose_of(place);
  const auto owner = static_cast<std::uint32_t>(owners.size() - 1);
  if (shape->octree != nullptr || !shape->fault.empty()) {
    parts.push_back({shape, nullptr, pose, owner});
    boxes.emplace_back();
    return;
  }
  for (std::size_t i = 0; i < shape->bodies.size(); ++i) {
    parts.push_back({shape, &shape->bodies[i], pose, owner});
    boxes.push_back(placed(shape->boxes[i], pose));
  }
}

void PosedParts::remove(const std::string& owner) {
  const auto at = std::ranges::find(owners, owner, &Owner::name);
  if (at == owners.end()) return;
  const auto index = static_cast<std::uint32_t>(at - owners.begin());
  owners.erase(at);
  std::size_t left = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].owner == index) continue;
    parts[left] = parts[i];
    boxes[left] = boxes[i];
    if (parts[left].owner > index) --parts[left].owner;
    ++left;
  }
  parts.resize(left);
  boxes.resize(left);
}

}  // namespace clearance_moveit
