// What a tracker of ROS4HRI makes of a person's joints: the pose of the body and the angles of its
// skeleton. Only directions of limbs are used: the lengths are those of the skeleton.
#pragma once

#include "core/pose.hpp"
#include "monitor/examples/arm/bvh.hpp"
#include "tools/robot/ros_tracker.hpp"

namespace clearance::people {

// Follows one person: of several equal angles, those next to the last ones.
class PersonFit {
 public:
  [[nodiscard]] Skeleton fit(const Keypoints& person);

 private:
  struct Arm {
    double yaw = 0.0, pitch = 0.0, roll = 0.0;
    Vec3 forward = Vec3::UnitX();  // of the upper arm, in the body: where the elbow bends to
  };
  void fit_arm(std::size_t side, const Keypoints& person, const Mat3& world_from_body,
               Skeleton& skeleton);
  std::array<Arm, 2> arms_;
  Eigen::Quaterniond last_turn_ = Eigen::Quaterniond::Identity();
};

}  // namespace clearance::people
