#include "monitor/intake/tracked_frames.hpp"

#include <array>
#include <set>

namespace clearance {

TrackedFrames::TrackedFrames(const Cell& cell, ByName by_name)
    : scene_(&cell.scene), world_frame_(&cell.ros.world_frame) {
  const Scene& scene = cell.scene;
  std::set<std::uint32_t> links;
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links) links.insert(link.object);
  }
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.fixed || !object.is_read || object.is_seen() || links.contains(i)) continue;
    const bool by_its_name = object.frame.empty() && by_name == ByName::kYes;
    const std::string& frame = by_its_name ? object.name : object.frame;
    if (frame.empty()) continue;
    followers_.push_back({frame, object.name, i, false, object.age_limit_ns});
  }
  for (std::uint32_t i = 0; i < scene.robots.size(); ++i) {
    const Robot& robot = scene.robots[i];
    if (!robot.base.frame.empty()) {
      if (!scene.variables[robot.joints.front().variable].is_read) continue;
      followers_.push_back({robot.base.frame, robot.name, i, true,
                            scene.variables[robot.joints.front().variable].age_limit_ns});
    } else if (robot.base.kind == RobotBase::Kind::kWorld) {
      world_from_root_link_[robot.links.front().name] = robot.base.base_from_root;
    }
  }
  last_.resize(followers_.size(), Eigen::Quaterniond::Identity());
}

std::optional<TfTree::Place> TrackedFrames::find(const TfTree& tree, const std::string& frame,
                                                 std::string* root, const TfTree::Instead* instead,
                                                 const TfTree::Earlier& earlier) const {
  auto place = tree.find(frame, *world_frame_, instead, earlier);
  if (!place) return std::nullopt;
  if (root != nullptr) *root = place->root;
  if (const auto robot = world_from_root_link_.find(place->root);
      robot != world_from_root_link_.end()) {
    place->root_from_frame = compose(robot->second, place->root_from_frame);
    if (place->twist) {
      const Eigen::Quaterniond& turn = robot->second.orientation;
      place->twist =
          Twist{.linear = turn * place->twist->linear, .angular = turn * place->twist->angular};
    }
    return place;
  }
  const bool is_world = world_frame_->empty() || place->root == *world_frame_;
  return is_world ? place : std::nullopt;
}

// Both q and -q represent the orientation. The one nearer to the last is used, because velocities
// come from differences of the variables.
void TrackedFrames::add(std::size_t follower, const TfTree::Place& place, std::int64_t stamp_ns,
                        PoseBatch& batch) {
  const Follower& of = followers_[follower];
  const bool has_twist = place.stamp_ns && place.twist && place.interval_ns / 2 <= of.age_limit_ns;
  if (!of.is_base) {
    PoseSample& sample = batch.samples.emplace_back();
    sample.object = of.index;
    sample.stamp_ns = stamp_ns;
    sample.world_from_object = place.root_from_frame;
    sample.has_twist = has_twist;
    if (has_twist) sample.twist = *place.twist;
    return;
  }
  const Robot& robot = scene_->robots[of.index];
  const Pose root = compose(place.root_from_frame, robot.base.frame_from_root);
  Eigen::Quaterniond turn = root.orientation;
  if (turn.dot(last_[follower]) < 0.0) turn.coeffs() = -turn.coeffs();
  last_[follower] = turn;
  const Twist twist = has_twist ? *place.twist : Twist{};
  const Vec3 velocity =
      twist.linear + twist.angular.cross(root.position - place.root_from_frame.position);
  // dq/dt = omega q / 2
  const Eigen::Quaterniond rate(
      Eigen::Quaterniond(0.0, twist.angular.x(), twist.angular.y(), twist.angular.z()) * turn);
  const std::array<double, variables_of(JointType::kFloating)> values = {
      root.position.x(), root.position.y(), root.position.z(), turn.x(),
      turn.y(),          turn.z(),          turn.w()};
  const std::array<double, variables_of(JointType::kFloating)> rates = {
      velocity.x(),   velocity.y(),   velocity.z(),  0.5 * rate.x(),
      0.5 * rate.y(), 0.5 * rate.z(), 0.5 * rate.w()};
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    JointSample& sample = batch.joints.emplace_back();
    sample.variable = robot.joints.front().variable + i;
    sample.position = values[i];
    sample.velocity = rates[i];
    sample.has_velocity = has_twist;
    sample.stamp_ns = stamp_ns;
  }
}

}  // namespace clearance
