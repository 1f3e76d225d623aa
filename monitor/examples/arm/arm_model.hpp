// The controller's own model of its arm: the origin of a link, and its Jacobian.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/joint_screw.hpp"

namespace clearance::avoid {

class ArmModel {
 public:
  // The end point is the origin of the link `hand`. The scene must have one robot and must outlive
  // this. Throws std::invalid_argument if there is no such link.
  explicit ArmModel(const Scene& scene);

  // The positions that move the end point: indices into Scene::variables, from the base outwards.
  [[nodiscard]] const std::vector<std::uint32_t>& variables() const noexcept { return variables_; }

  // True if this object is one of the arm's links.
  [[nodiscard]] bool has(std::uint32_t object) const;

  // `positions` has the order of Scene::variables.
  void place(const std::vector<double>& positions);
  // The end point at the last place(), m in the world, and its derivatives, m for each rad or m of
  // variables().
  [[nodiscard]] Vec3 end_point() const;
  [[nodiscard]] Eigen::Matrix3Xd jacobian() const;

 private:
  const Robot& robot_;
  std::uint32_t end_ = 0;              // index into Robot::links
  std::vector<std::uint32_t> joints_;  // from the base to the end link, with one position each
  std::vector<std::uint32_t> variables_;
  std::vector<TrackedVariable> states_;
  ForwardKinematics kinematics_;
};

}  // namespace clearance::avoid
