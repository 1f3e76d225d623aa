// The joints of a robot whose stops have to be known, and which numbers about them fit one another.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/robot.hpp"

namespace clearance {

// A joint whose position is one number of its own.
struct StoppedJoint {
  std::string name;            // without the prefix
  std::uint32_t variable = 0;  // index into Scene::variables
  bool turns = true;
  double full_speed = 0.0;                                  // per second; infinite: not stated
  double urdf_acceleration = 0.0, urdf_deceleration = 0.0;  // per s2; infinite: not stated
  std::optional<JointStop> stop = {};
  std::vector<JointStop> by_step = {};  // of a table; empty: `stop` counts for each of its steps
  std::optional<double> acceleration = {};  // per s2

  [[nodiscard]] const char* unit() const noexcept { return turns ? "rad" : "m"; }
};

// The list begins at the root. It has all joints that move and mimic no other one, without a base
// on tf. If a joint has several positions, the list is empty, and `refused` is that joint's name.
struct StoppedJoints {
  std::vector<StoppedJoint> all = {};
  std::string refused = {};

  // Tables have a joint's name, or its number in the list, from 1 on. Null: there is none.
  [[nodiscard]] StoppedJoint* named(const std::string& name_or_number) noexcept;
  [[nodiscard]] std::vector<std::string> names() const;
};
[[nodiscard]] StoppedJoints stopped_joints(const Robot& robot,
                                           std::span<const JointVariable> variables);

// Each returns what was found and expected, with the joint and the value, or an empty text: the
// numbers are plausible. A wrong unit is not.
[[nodiscard]] std::string doubt_of_point(const StoppedJoint& joint, const StopPoint& point);
[[nodiscard]] std::string doubt_of_deceleration(const StoppedJoint& joint, double deceleration);
[[nodiscard]] std::string doubt_of_acceleration(const StoppedJoint& joint, double acceleration);

}  // namespace clearance
