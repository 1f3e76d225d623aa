// Forward kinematics: the poses and twists of all robots' links from the positions of their joints.
//
// The exact pose of a link is that of the chain as the URDF writes it. The origins are real
// numbers, and the positions are the doubles that were sent. The result contains a bound of the
// rounding errors against this exact pose. It has the same bits on every machine, because it uses
// only sums, products, quotients and square roots.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/robot.hpp"
#include "monitor/bodies/tracked_variable.hpp"

namespace clearance {

struct LinkState {
  bool known = false;           // all joints from the world to this link have a position
  bool velocity_known = false;  // and all these joints have a velocity
  bool late = false;            // one of these joints is late
  bool contradicted = false;    // one of these joints is contradicted, and therefore late
  // The oldest stamp of the positions that place the link, in the tick's time. It is the largest
  // number if no position does.
  std::int64_t stamp_ns = 0;
  Pose pose;    // world_from_link; of unit length to 2^-50 for each joint
  Twist twist;  // zero unless velocity_known

  // Since the stamps, no point within r of the link's origin has moved farther than
  // unobserved_shift + unobserved_turn r, m. The bound is 0 unless the link is late. It is infinite
  // if a late joint has neither a speed nor limits.
  double unobserved_shift = 0.0, unobserved_turn = 0.0;
  // Rounding displaces no point within r of the link's origin farther than shift_error + turn_error
  // r from its exact place, m.
  double shift_error = 0.0, turn_error = 0.0;

  [[nodiscard]] double may_have_moved(double radius) const noexcept;
  [[nodiscard]] double error(double radius) const noexcept;
};

class ForwardKinematics {
 public:
  // Allocates all memory that it ever needs. The robots must outlive it.
  explicit ForwardKinematics(std::span<const Robot> robots);

  // Places all links. `variables` has the order of Scene::variables. `bases`, by robot, has the
  // states of the objects on which robots stand. Entries of robots that stand on no object are not
  // read. The unobserved motion of a robot on a late object has no bound, because the object's
  // speed limit holds only for the object's own points. Robots that are 0 in `which` stay as they
  // are; empty: none does. Does not allocate, throw or lock.
  void place(std::span<const TrackedVariable> variables, std::span<const LinkState> bases,
             std::span<const std::uint8_t> which = {}) noexcept;

  // The states of the links at the last place(), in the order of Robot::links.
  [[nodiscard]] std::span<const LinkState> links(std::uint32_t robot) const noexcept {
    return std::span(links_).subspan(first_link_[robot], robots_[robot].links.size());
  }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("first links of robots", first_link_);
    visit("frames of joints", frames_);
  }

 private:
  // The constant part of a joint, in the frame of its parent link.
  struct JointFrame {
    Eigen::Quaterniond turn;       // parent_from_joint
    Eigen::Quaterniond turn_axis;  // turn times the axis, as a quaternion with real part 0
    Vec3 step;                     // parent_from_joint
    Vec3 axis, plane_x, plane_y;   // those of RobotJoint, rotated into the parent's frame
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
  static void slide(const Position& path, const Vec3& along, Placement& placed) noexcept;
  static void turn_freely(const RobotJoint& joint, const JointFrame& frame,
                          std::span<const TrackedVariable> variables, Placement& placed) noexcept;

  std::span<const Robot> robots_;
  std::vector<std::uint32_t> first_link_;  // by robot
  std::vector<JointFrame> frames_;  // by link, of the joint that carries it; unused for roots
  std::vector<LinkState> links_;    // of all robots
};

}  // namespace clearance
