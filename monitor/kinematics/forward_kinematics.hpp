// Where the links of all robots are, from the positions of their joints.
//
// What a pose is true of: the chain as the URDF writes it, origins as real numbers and each
// position as the double that was sent. How far the doubles computed here can be from that is part
// of the result. The same bits on every machine: sums, products, quotients and square roots only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/robot.hpp"
#include "monitor/kinematics/tracked_variable.hpp"

namespace clearance {

struct LinkState {
  bool known = false;           // all joints from the world to here have been seen
  bool velocity_known = false;  // and how all of them move
  bool late = false;            // one of them is
  bool contradicted = false;    // late since one of them is
  // The oldest of the positions that it hangs on, in the tick's time; the largest number when it
  // hangs on none.
  std::int64_t stamp_ns = 0;
  Pose pose;    // world_from_link; of unit length to 2^-50 for each joint
  Twist twist;  // zero unless velocity_known

  // Since the stamps no point within r of its origin has moved farther than unseen_shift +
  // unseen_turn r, m: 0 unless late, infinite when a late joint has neither a speed nor limits.
  double unseen_shift = 0.0, unseen_turn = 0.0;
  // No point within r of its origin is farther than shift_error + turn_error r from where the chain
  // has it, m.
  double shift_error = 0.0, turn_error = 0.0;

  [[nodiscard]] double may_have_moved(double reach) const noexcept;
  [[nodiscard]] double error(double reach) const noexcept;
};

class ForwardKinematics {
 public:
  // Allocates all it will ever need. The robots must outlive it.
  explicit ForwardKinematics(std::span<const Robot> robots);

  // Places all links. `variables` as Scene::variables. `bases`: by robot, what those that stand on
  // an object stand on; of the others nothing is read. Nobody knows how far what stands on a late
  // object may have moved: the object's speed is that of its own points. Allocates, throws and
  // locks nothing.
  void place(std::span<const TrackedVariable> variables, std::span<const LinkState> bases) noexcept;

  // As of the last place(): as Robot::links.
  [[nodiscard]] std::span<const LinkState> links(std::uint32_t robot) const noexcept {
    return std::span(links_).subspan(first_link_[robot], robots_[robot].links.size());
  }

 private:
  // What of a joint does not change, in the frame of the link before it.
  struct JointFrame {
    Eigen::Quaterniond turn;       // parent_from_joint
    Eigen::Quaterniond turn_axis;  // that times the axis, as a quaternion without a real part
    Vec3 step;                     // parent_from_joint
    Vec3 axis, plane_x, plane_y;   // as of RobotJoint
  };
  struct Placement;
  struct Position;

  void place_root(std::uint32_t robot, std::span<const LinkState> bases) noexcept;
  static void carry(const LinkState& parent, const Placement& placed, LinkState& link) noexcept;
  [[nodiscard]] static Placement placement(const RobotJoint& joint, const JointFrame& frame,
                                           std::span<const TrackedVariable> variables) noexcept;
  [[nodiscard]] static Position read(const RobotJoint& joint, std::uint32_t which,
                                     std::span<const TrackedVariable> variables,
                                     Placement& placed) noexcept;
  static void turn(const Position& angle, const JointFrame& frame, Placement& placed) noexcept;
  static void slide(const Position& way, const Vec3& along, Placement& placed) noexcept;
  static void turn_freely(const RobotJoint& joint, const JointFrame& frame,
                          std::span<const TrackedVariable> variables, Placement& placed) noexcept;

  std::span<const Robot> robots_;
  std::vector<std::uint32_t> first_link_;  // by robot
  std::vector<JointFrame> frames_;         // of the joint that carries a link; roots have none
  std::vector<LinkState> links_;           // of all robots
};

}  // namespace clearance
