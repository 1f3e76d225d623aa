// The controller's own model of its arm: where a link's origin is, and how joints move it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/kinematics/joint_screw.hpp"

namespace clearance::avoid {

class ArmModel {
 public:
  // The end point: the origin of this link, of the only robot of the scene, which must outlive
  // this. Throws std::invalid_argument when there is no such link.
  ArmModel(const Scene& scene, const std::string& end_link);

  // The positions that move the end point: indices into Scene::variables, from the base outwards.
  [[nodiscard]] const std::vector<std::uint32_t>& variables() const noexcept { return variables_; }

  // True if this object is one of the arm's links.
  [[nodiscard]] bool has(std::uint32_t object) const;

  // `positions` as Scene::variables.
  void place(const std::vector<double>& positions);
  // After the last place(): m in the world, and m for each rad or m of variables().
  [[nodiscard]] Vec3 end_point() const;
  [[nodiscard]] Eigen::Matrix3Xd jacobian() const;

 private:
  const Robot& robot_;
  std::uint32_t end_ = 0;              // index into Robot::links
  std::vector<std::uint32_t> joints_;  // from the base to it, of one position each
  std::vector<std::uint32_t> variables_;
  std::vector<TrackedVariable> states_;
  ForwardKinematics kinematics_;
};

}  // namespace clearance::avoid
